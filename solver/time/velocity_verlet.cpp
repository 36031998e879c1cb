#include "solver/time/velocity_verlet.hpp"

#include "solver/terms/equation_of_state.hpp"

namespace slurry {

namespace {

// Calls stage(i) for every fluid particle.
template <class Stage> void for_each(const FluidParticles& fluid, Stage&& stage) {
    const auto count = static_cast<std::ptrdiff_t>(fluid.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        stage(static_cast<std::size_t>(i));
    }
}

// Eqs. 2.29 and 2.34.
void kick(FluidParticles& fluid, double time) {
    for_each(fluid, [&](std::size_t i) {
        fluid.velocity_x[i] += time * fluid.acceleration_x[i];
        fluid.velocity_y[i] += time * fluid.acceleration_y[i];
    });
}

// Eq. 2.30: how much faster than the fluid the particles move.
void shift(FluidParticles& fluid, double time) {
    for_each(fluid, [&](std::size_t i) {
        fluid.shift_x[i] = time * fluid.background_x[i];
        fluid.shift_y[i] = time * fluid.background_y[i];
    });
}

// Eqs. 2.31 and 2.33; walls keep pace.
void drift(Particles& particles, double time) {
    FluidParticles& fluid = particles.fluid;
    for_each(fluid, [&](std::size_t i) {
        fluid.x[i] += time * (fluid.velocity_x[i] + fluid.shift_x[i]);
        fluid.y[i] += time * (fluid.velocity_y[i] + fluid.shift_y[i]);
    });
    particles.time += time;
    particles.dummies.move_to(particles.time);
}

// Eq. 2.32
void update_density(FluidParticles& fluid, double time) {
    for_each(fluid, [&](std::size_t i) { fluid.density[i] += time * fluid.density_rate[i]; });
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
    for_each(fluid, [&](std::size_t i) {
        fluid.acceleration_x[i] += properties.body_force.x();
        fluid.acceleration_y[i] += properties.body_force.y();
    });
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
    kick(particles.fluid, time_step / 2);
    shift(particles.fluid, time_step / 2);
    drift(particles, time_step / 2);

    refresh_neighbours();
    {
        const PhaseClock::Scope scope(clock, "density rate");
        interactions.compute_density_rate(
            particles); // at the half step, so that density is second order in time
    }
    update_density(particles.fluid, time_step);
    drift(particles, time_step / 2); // with the velocity of the half step

    refresh_neighbours();
    compute_accelerations(particles, interactions, fluid, sound_speed,
                          clock); // with the new density and positions
    kick(particles.fluid, time_step / 2);
}

} // namespace slurry
