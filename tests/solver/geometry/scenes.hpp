#pragma once
// Walls and scenes that the tests of the geometry share.
#include "solver/scene/scene.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace slurry::testing {

inline Domain make_domain(const Vector& lower, const Vector& upper, bool periodic_x) {
    return {lower, upper, {periodic_x, false}};
}

inline WallScene make_wall(const std::string& name, const Shape& shape, FluidSide side,
                           const Vector& velocity = Vector::Zero()) {
    return {name, shape, side, velocity};
}

inline Scene make_scene(const Domain& domain, const std::vector<WallScene>& walls, double spacing) {
    Scene scene;
    scene.numerics.kernel = KernelShape::quintic; // which every build has
    scene.domain = domain;
    scene.walls = walls;
    scene.numerics.particle_spacing = spacing;
    return scene;
}

// The paper's rough channel (Sec. 4.1.1).
inline Scene rough_channel(double spacing) {
    return make_scene(make_domain({0, 0}, {3e-5, 1.5e-5}, true),
                      {make_wall("wafer", LineShape{{0, 1.5e-5}, {3e-5, 1.5e-5}}, FluidSide::below, {1, 0}),
                       make_wall("pad", CosineShape{5e-6, -5e-6, 3e-5, 0}, FluidSide::above)},
                      spacing);
}

inline Scene closed_box(double width, double height, double spacing) {
    return make_scene(make_domain({0, 0}, {width, height}, false),
                      {make_wall("bottom", LineShape{{0, 0}, {width, 0}}, FluidSide::above),
                       make_wall("right", LineShape{{width, 0}, {width, height}}, FluidSide::left),
                       make_wall("top", LineShape{{width, height}, {0, height}}, FluidSide::below),
                       make_wall("left", LineShape{{0, height}, {0, 0}}, FluidSide::right)},
                      spacing);
}

inline ProfileShape measured_profile() {
    ProfileShape profile{"", 0.1, {}};
    for (int i = 0; i <= 20; ++i) {
        const double x = 0.1 * i;
        profile.points.emplace_back(x, 0.06 * std::sin(std::numbers::pi * x) +
                                           0.02 * std::cos(4 * std::numbers::pi * x));
    }
    return profile;
}

// One wall of every shape, in a domain [0, 2] x [0, 1].
inline std::vector<WallScene> every_shape() {
    return {
        make_wall("line", LineShape{{0, 0.2}, {2, 0.2}}, FluidSide::above),
        make_wall("cosine", CosineShape{0.4, -0.3, 1, 0.13}, FluidSide::above),
        make_wall("ceiling", CosineShape{0.5, 0.2, 2, 0}, FluidSide::below),
        make_wall("gaussian", GaussianShape{0.1, 0.7, 1.7, 0.15}, FluidSide::above),
        make_wall("bulge", ArcShape{0.3, 0.25, 0.2, 2 * std::numbers::pi / 3, true}, FluidSide::above),
        make_wall("cavity", ArcShape{0.6, 1, 0.2, 2 * std::numbers::pi / 3, true}, FluidSide::below),
        make_wall("half circle", ArcShape{0.5, 1, 0.3, std::numbers::pi, false}, FluidSide::above),
        make_wall("sine", SineShape{0.5, 0.15, 1.2, 0.8}, FluidSide::below),
        make_wall("profile", measured_profile(), FluidSide::above),
        make_wall("random", RandomShape{0.4, 0.06, 0.3, 5}, FluidSide::above),
    };
}

} // namespace slurry::testing
