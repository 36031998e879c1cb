#pragma once
// Time step of the fluid alone, Eq. 2.35 [wang2014], with the scene's three factors in place of 0.25.
#include "solver/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace slurry {

// The largest time step, s, and what keeps it from being larger, for people.
struct TimeStepBound {
    double step;
    const char* cause;
};

inline TimeStepBound time_step_bound(const Scene& scene) {
    const Numerics& numerics = scene.numerics;
    const double h = numerics.smoothing_length();
    const double viscosity = scene.fluid.kinematic_viscosity();
    const double force = scene.fluid.acceleration().norm();
    const double unlimited = std::numeric_limits<double>::infinity();
    const std::array bounds{
        TimeStepBound{numerics.acoustic_cfl * h / numerics.sound_speed,
                      "sound: numerics.acoustic_cfl * smoothing length / sound speed"},
        TimeStepBound{viscosity > 0 ? numerics.viscous_cfl * h * h / viscosity : unlimited,
                      "viscosity: numerics.viscous_cfl * smoothing length^2 / kinematic viscosity"},
        TimeStepBound{force > 0 ? numerics.force_cfl * std::sqrt(h / force) : unlimited,
                      "the force on the fluid: numerics.force_cfl * sqrt(smoothing length / acceleration)"}};
    return *std::ranges::min_element(bounds, {}, &TimeStepBound::step);
}

inline double largest_time_step(const Scene& scene) {
    return time_step_bound(scene).step;
}

} // namespace slurry
