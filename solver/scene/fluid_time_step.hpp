#pragma once
// Time step of the fluid alone, Eq. 2.35 [wang2014], with the scene's three factors in place of 0.25.
#include "solver/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slurry {

inline double largest_time_step(const Scene& scene) {
    const Numerics& numerics = scene.numerics;
    const double h = numerics.smoothing_length();
    const double viscosity = scene.fluid.kinematic_viscosity();
    const double force = scene.fluid.acceleration().norm();
    const double unlimited = std::numeric_limits<double>::infinity();
    return std::min({numerics.acoustic_cfl * h / numerics.sound_speed,
                     viscosity > 0 ? numerics.viscous_cfl * h * h / viscosity : unlimited,
                     force > 0 ? numerics.force_cfl * std::sqrt(h / force) : unlimited});
}

} // namespace slurry
