#pragma once
// How many discs each entry of a scene stands for, and how large they are.
#include "solver/scene/scene.hpp"

#include <gsl/gsl_rng.h>

#include <memory>
#include <vector>

namespace slurry {

// The discs of one entry of [[discs]], before they have places.
struct DiscGroup {
    const DiscScene* scene;
    double least_distance;     // m, from the rims of these to those of others and to walls
    std::vector<double> radii; // m, in the order of their names
    // Has drawn the radii and goes on with the places; null for a single disc.
    std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> generator;
};

// One group for each entry of [[discs]] of the scene, which has to outlive them. A wanted fraction of the
// area between the walls (m2), or of weight, is reached to within half of the last disc drawn. Throws
// GeometryError, naming the discs: a fraction that is less than half a disc, drawn discs that are too small;
// and SceneError: more discs than scene.limits.
std::vector<DiscGroup> draw_groups(const Scene& scene, double area);

} // namespace slurry
