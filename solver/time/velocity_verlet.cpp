#include "solver/time/velocity_verlet.hpp"

#include "solver/discs/motion.hpp"
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

// Eqs. 2.31 and 2.33.
void drift(FluidParticles& fluid, std::size_t i, double time) {
    fluid.x[i] += time * (fluid.velocity_x[i] + fluid.shift_x(i));
    fluid.y[i] += time * (fluid.velocity_y[i] + fluid.shift_y(i));
}

// Eq. 2.32
void update_density(FluidParticles& fluid, std::size_t i, double time, double mean_rate) {
    fluid.density[i] += time * (fluid.density_rate[i] - mean_rate);
}

// The fluid's mass and the room that walls and discs leave it stay the same, and so does its mean density.
// The sums over pairs miss that by a little, which adds up over ten thousands of steps. One thread: the order
// of the sum must not depend on how many there are.
double mean_density_rate(const FluidParticles& fluid) {
    const std::size_t count = fluid.size();
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < count; ++i) {
        sum += fluid.density_rate[i];
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Walls and discs keep pace with the fluid.
void move_solids(Particles& particles, double time) {
    particles.time += time;
    particles.dummies.move_walls_to(particles.time);
    drift_discs(particles, time);
}

void compute_accelerations(Particles& particles, Forces& forces, PhaseClock& clock) {
    Interactions& interactions = forces.interactions;
    FluidParticles& fluid = particles.fluid;
    {
        const PhaseClock::Scope scope(clock, "volumes");
        interactions.compute_volumes(particles);
        const EquationOfState equation_of_state{forces.fluid.density, forces.sound_speed};
        for_each(fluid,
                 [&](std::size_t i) { fluid.pressure[i] = equation_of_state.pressure(fluid.density[i]); });
    }
    {
        const PhaseClock::Scope scope(clock, "walls");
        interactions.extrapolate_to_walls(particles);
    }
    const PhaseClock::Scope scope(clock, "forces");
    interactions.compute_forces(particles);
    const Vector body_force = forces.fluid.acceleration();
    if (body_force.squaredNorm() > 0) {
        for_each(fluid, [&](std::size_t i) {
            fluid.acceleration_x[i] += body_force.x();
            fluid.acceleration_y[i] += body_force.y();
        });
    }
}

void compute_disc_forces(Particles& particles, Forces& forces) {
    sum_disc_forces(particles, forces.fluid);
    forces.contacts.compute(particles);
}

} // namespace

void prepare_first_step(Particles& particles, Forces& forces, double time_step, PhaseClock& clock) {
    particles.fluid.shift_time = time_step / 2; // limits the background pressure of the first shifts, too
    forces.interactions.refresh_neighbours(particles);
    compute_accelerations(particles, forces, clock);
    compute_disc_forces(particles, forces);
}

void advance(Particles& particles, Forces& forces, double time_step, PhaseClock& clock) {
    const auto refresh_neighbours = [&] {
        const PhaseClock::Scope scope(clock, "neighbours");
        forces.interactions.refresh_neighbours(particles);
    };
    FluidParticles& fluid = particles.fluid;
    const double half = time_step / 2;
    fluid.shift_time = half;
    kick_discs(particles, half);
    for_each(fluid, [&](std::size_t i) {
        kick(fluid, i, half);
        drift(fluid, i, half);
    });
    move_solids(particles, half);

    refresh_neighbours();
    double lost_rate = 0;
    {
        const PhaseClock::Scope scope(clock, "density rate");
        forces.interactions.compute_density_rate(
            particles); // at the half step, so that density is second order in time
        lost_rate = forces.keep_mean_density ? mean_density_rate(fluid) : 0;
    }
    for_each(fluid, [&](std::size_t i) {
        update_density(fluid, i, time_step, lost_rate);
        drift(fluid, i, half); // with the velocity of the half step
    });
    move_solids(particles, half);

    refresh_neighbours();
    compute_accelerations(particles, forces, clock); // with the new density and positions
    compute_disc_forces(particles, forces);
    kick_discs(particles, half);
    for_each(fluid, [&](std::size_t i) { kick(fluid, i, half); });
}

} // namespace slurry
