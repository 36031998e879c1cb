#pragma once
// Pairs are computed in units of the scene: lengths in smoothing lengths, speeds in speeds of sound,
// densities in reference densities. Numbers near one keep float far from the ends of its range, whatever the
// scene's size, and the kernel's scale drops out of the pair loop.
#include "solver/scene/scene.hpp"

namespace slurry {

struct Units {
    double length;   // smoothing length, m
    double velocity; // sound speed, m/s
    double density;  // reference density, kg/m3
    Vector origin;   // of the rows' positions, m: float resolves them best around 0

    explicit Units(const Scene& scene)
        : length(scene.numerics.smoothing_length()), velocity(scene.numerics.sound_speed),
          density(scene.fluid.density), origin((scene.domain.lower + scene.domain.upper) / 2) {}

    [[nodiscard]] double volume() const { return length * length; }
    [[nodiscard]] double mass() const { return density * length * length; } // kg/m
    [[nodiscard]] double pressure() const { return density * velocity * velocity; }
    [[nodiscard]] double acceleration() const { return velocity * velocity / length; }
    [[nodiscard]] double density_rate() const { return density * velocity / length; }
    [[nodiscard]] double dynamic_viscosity() const { return density * velocity * length; }
};

} // namespace slurry
