#pragma once
// Small flows that the tests of the solver's core share. Lengths of order one, water's density, c = 10 m/s.
#include "solver/loop/interactions.hpp"
#include "solver/particles/arrangement.hpp"
#include "solver/terms/equation_of_state.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

namespace slurry::testing {

inline Scene core_scene(const Vector& lower, const Vector& size, std::array<bool, 2> periodic,
                        double spacing) {
    Scene scene;
    scene.domain = {lower, lower + size, periodic};
    scene.fluid = {1000, 2, Vector::Zero()};
    scene.numerics.particle_spacing = spacing;
    scene.numerics.sound_speed = 10;
    scene.numerics.kernel = KernelShape::quintic;
    scene.numerics.pair_arithmetic = PairArithmetic::double_precision; // equations hold to rounding
    return scene;
}

// n x n particles, periodic on all sides; the corner is off the origin so that a lost offset shows.
inline Scene doubly_periodic(int n) {
    return core_scene({-0.3, 0.2}, {1, 1}, {true, true}, 1.0 / n);
}

// A channel, n x n particles, periodic in x, between a floor and a lid that slides at `lid_speed`.
inline Scene flat_channel(int n, double lid_speed = 0) {
    Scene scene = core_scene({-0.3, 0.2}, {1, 1}, {true, false}, 1.0 / n);
    scene.walls = {{"floor", LineShape{{-0.3, 0.2}, {0.7, 0.2}}, FluidSide::above, Vector::Zero()},
                   {"lid", LineShape{{-0.3, 1.2}, {0.7, 1.2}}, FluidSide::below, {lid_speed, 0}}};
    return scene;
}

// A disc in the middle of the box of doubly_periodic(n), a third as wide.
inline DiscScene middle_disc(double density = 1000) {
    DiscScene disc;
    disc.name = "disc";
    disc.placement = SingleDisc{1.0 / 6, {0.2, 0.7}};
    disc.density = density;
    return disc;
}

inline void jitter(Scene& scene, double amplitude, std::uint64_t seed = 7) {
    scene.start.arrangement = Arrangement::jittered;
    scene.start.jitter = amplitude;
    scene.start.seed = seed;
}

inline Particles arrange(const Scene& scene) {
    return arrange_particles(scene, Region(scene));
}

// Random velocities and shifts, densities off by up to 2 % with the pressures that belong to them.
inline void disorder(Particles& particles, const Scene& scene, unsigned seed = 3) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const EquationOfState equation_of_state{scene.fluid.density, scene.numerics.sound_speed};
    FluidParticles& fluid = particles.fluid;
    fluid.shift_time = 0.25 * scene.numerics.smoothing_length() / scene.numerics.sound_speed;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.velocity_x[i] = uniform(generator);
        fluid.velocity_y[i] = uniform(generator);
        fluid.background_x[i] = 0.1 * uniform(generator) / fluid.shift_time;
        fluid.background_y[i] = 0.1 * uniform(generator) / fluid.shift_time;
        fluid.density[i] = scene.fluid.density * (1 + 0.02 * uniform(generator));
        fluid.pressure[i] = equation_of_state.pressure(fluid.density[i]);
    }
}

// Every pass of a time step once, on the state as it is.
inline void evaluate(Interactions& interactions, Particles& particles) {
    interactions.refresh_neighbours(particles);
    interactions.compute_volumes(particles);
    interactions.extrapolate_to_walls(particles);
    interactions.compute_density_rate(particles);
    interactions.compute_forces(particles);
}

inline double largest(std::span<const double> values) {
    double result = 0;
    for (const double value : values) {
        result = std::isnan(value) ? value : std::max(result, std::abs(value));
        if (std::isnan(result)) {
            break;
        }
    }
    return result;
}

inline double sum_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    return sum;
}

inline double sum_of_magnitudes(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) {
        sum += std::abs(value);
    }
    return sum;
}

} // namespace slurry::testing
