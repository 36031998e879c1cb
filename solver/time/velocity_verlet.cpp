#include "solver/time/velocity_verlet.hpp"

#include "solver/terms/equation_of_state.hpp"

namespace slurry {

namespace {

// Calls stages(i) for every fluid particle: consecutive stages in one loop read and write the state once.
template <class Stages> void for_each(const FluidParticles& fluid, Stages&& stages) {
    const auto count = static_cast<std::ptrdiff_t>(fluid.size());
#pragma omp parallel for simd schedule(static)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        stages(static_cast<std::size_t>(i));
    }
}

// Eqs. 2.29 and 2.34.
void kick(FluidParticles& fluid, std::size_t i, double time) {
    fluid.velocity_x[i] += time * fluid.acceleration_x[i];
    fluid.velocity_y[i] += time * fluid.acceleration_y[i];
}

// Eq. 2.30: how much faster than the fluid the particles move.
void shift(FluidParticles& fluid, std::size_t i, double time) {
    fluid.shift_x[i] = time * fluid.background_x[i];
    fluid.shift_y[i] = time * fluid.background_y[i];
}

// Eqs. 2.31 and 2.33.
void drift(FluidParticles& fluid, std::size_t i, double time) {
    fluid.x[i] += time * (fluid.velocity_x[i] + fluid.shift_x[i]);
    fluid.y[i] += time * (fluid.velocity_y[i] + fluid.shift_y[i]);
}

// Eq. 2.32
void update_density(FluidParticles& fluid, std::size_t i, double time) {
    fluid.density[i] += time * fluid.density_rate[i];
}

// The walls keep pace with the fluid.
void move_walls(Particles& particles, double time) {
    particles.time += time;
    particles.dummies.move_to(particles.time);
}

void compute_accelerations(Particles& particles, Interactions& interactions, const Fluid& properties,
                           double sound_speed, PhaseClock& clock) {
    FluidParticles& fluid = particles.fluid;
    {
        const PhaseClock::Scope scope(clock, "volumes");
        interactions.compute_volumes(particles);
        const EquationOfState equation_of_state{properties.density, sound_speed};
        for_each(fluid,
                 [&](std::size_t i) { fluid.pressure[i] = equation_of_state.pressure(fluid.density[i]); });
    }
    {
        const PhaseClock::Scope scope(clock, "walls");
        interactions.extrapolate_to_walls(particles);
    }
    const PhaseClock::Scope scope(clock, "forces");
    interactions.compute_forces(particles);
    if (properties.body_force.squaredNorm() > 0) {
        for_each(fluid, [&](std::size_t i) {
            fluid.acceleration_x[i] += properties.body_force.x();
            fluid.acceleration_y[i] += properties.body_force.y();
        });
    }
}

} // namespace

void prepare_first_step(Particles& particles, Interactions& interactions, const Fluid& fluid,
                        double sound_speed, PhaseClock& clock) {
    interactions.refresh_neighbours(particles);
    compute_accelerations(particles, interactions, fluid, sound_speed, clock);
}

void advance(Particles& particles, Interactions& interactions, const Fluid& fluid, double sound_speed,
             double time_step, PhaseClock& clock) {
    const auto refresh_neighbours = [&] {
        const PhaseClock::Scope scope(clock, "neighbours");
        interactions.refresh_neighbours(particles);
    };
    FluidParticles& fluid_particles = particles.fluid;
    const double half = time_step / 2;
    for_each(fluid_particles, [&](std::size_t i) {
        kick(fluid_particles, i, half);
        shift(fluid_particles, i, half);
        drift(fluid_particles, i, half);
    });
    move_walls(particles, half);

    refresh_neighbours();
    {
        const PhaseClock::Scope scope(clock, "density rate");
        interactions.compute_density_rate(
            particles); // at the half step, so that density is second order in time
    }
    for_each(fluid_particles, [&](std::size_t i) {
        update_density(fluid_particles, i, time_step);
        drift(fluid_particles, i, half); // with the velocity of the half step
    });
    move_walls(particles, half);

    refresh_neighbours();
    compute_accelerations(particles, interactions, fluid, sound_speed,
                          clock); // with the new density and positions
    for_each(fluid_particles, [&](std::size_t i) { kick(fluid_particles, i, half); });
}

} // namespace slurry
