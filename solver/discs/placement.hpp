#pragma once
// Where the discs of a scene are at the start.
#include "solver/geometry/region.hpp"
#include "solver/scene/scene.hpp"

#include <string>
#include <vector>

namespace slurry {

struct PlacedDisc {
    std::string name;
    Vector centre;  // m
    double radius;  // m
    double density; // kg/m3
    DiscMotion motion;
    Vector velocity; // m/s
    double spin;     // rad/s, anticlockwise

    [[nodiscard]] double mass() const;              // kg/m
    [[nodiscard]] double moment_of_inertia() const; // kg m2/m, about the centre
};

// The scene's discs in its order, those at random places by Poisson-disc sampling with their seed. Throws
// GeometryError, naming the disc: overlaps, a rim behind a wall or outside the domain, discs that cannot be
// placed.
std::vector<PlacedDisc> place_discs(const Scene& scene, const Region& region);

} // namespace slurry
