#pragma once
// Discs and boxes that the tests of the placement share.
#include "solver/discs/placement.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "tests/solver/geometry/scenes.hpp"

#include <fmt/core.h>
#include <numbers>
#include <string>
#include <vector>

namespace slurry::testing {

inline DiscScene single(const std::string& name, double radius, const Vector& position) {
    DiscScene disc;
    disc.name = name;
    disc.placement = SingleDisc{radius, position};
    disc.density = 2000;
    return disc;
}

inline DiscScene random_discs(const std::string& name, const RandomDiscs& random) {
    DiscScene disc;
    disc.name = name;
    disc.placement = random;
    disc.density = 2000;
    return disc;
}

// A number of discs of one size.
inline RandomDiscs counted(int count, double radius) {
    RandomDiscs random;
    random.count = count;
    random.radius = radius;
    return random;
}

// Water in [0, 1] x [0, 1]; of the four sides those that are not periodic are closed.
inline Scene box(std::array<bool, 2> periodic) {
    Scene scene;
    scene.fluid.density = 1000;
    scene.numerics.particle_spacing = 0.001;
    scene.domain = {{0, 0}, {1, 1}, periodic};
    if (!periodic[1]) {
        scene.walls.push_back(make_wall("bottom", LineShape{{0, 0}, {1, 0}}, FluidSide::above));
        scene.walls.push_back(make_wall("top", LineShape{{0, 1}, {1, 1}}, FluidSide::below));
    }
    if (!periodic[0]) {
        scene.walls.push_back(make_wall("left", LineShape{{0, 0}, {0, 1}}, FluidSide::right));
        scene.walls.push_back(make_wall("right", LineShape{{1, 0}, {1, 1}}, FluidSide::left));
    }
    return scene;
}

inline std::vector<PlacedDisc> place(const Scene& scene) {
    return place_discs(scene, Region(scene));
}

inline std::string refusal(const Scene& scene) {
    try {
        return fmt::format("PLACED {}", place(scene).size());
    } catch (const std::runtime_error& error) { // GeometryError, or SceneError beyond the limits
        return error.what();
    }
}

inline double area_of(const std::vector<PlacedDisc>& discs) {
    double area = 0;
    for (const PlacedDisc& disc : discs)
        area += std::numbers::pi * disc.radius * disc.radius;
    return area;
}

} // namespace slurry::testing
