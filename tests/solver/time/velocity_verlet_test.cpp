// The time step: free flight, still fluid, conservation and its order.
#include "solver/time/velocity_verlet.hpp"

#include "solver/time/time_step.hpp"
#include "tests/solver/flow_for_tests.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace slurry::testing {
namespace {

TEST(VelocityVerlet, UniformBoxInFreeFlightMovesExactlyAndStaysUniform) {
    for (const Vector& force : {Vector(0, 0), Vector(0.4, -1)}) {
        Scene scene = doubly_periodic(12);
        scene.fluid.body_force = force;
        scene.numerics.density_diffusion = 0; // what it does to a falling box: see HydrostaticDiffusion
        const Vector velocity(0.9, -0.7);
        Particles start = arrange(scene);
        const FluidParticles first = start.fluid;
        std::fill(start.fluid.velocity_x.begin(), start.fluid.velocity_x.end(), velocity.x());
        std::fill(start.fluid.velocity_y.begin(), start.fluid.velocity_y.end(), velocity.y());
        Flow flow(scene, start);
        flow.run(500, 0.002); // t = 1
        const FluidParticles& fluid = flow.particles.fluid;
        EXPECT_NEAR(flow.particles.time, 1, 1e-12);
        const auto off_period = [](double distance) { return std::abs(distance - std::round(distance)); };
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            const std::uint32_t k = fluid.identity[i];
            EXPECT_LT(off_period(fluid.x[i] - first.x[k] - velocity.x() - 0.5 * force.x()), 1e-12);
            EXPECT_LT(off_period(fluid.y[i] - first.y[k] - velocity.y() - 0.5 * force.y()), 1e-12);
            EXPECT_NEAR(fluid.velocity_x[i], velocity.x() + force.x(), 1e-12);
            EXPECT_NEAR(fluid.velocity_y[i], velocity.y() + force.y(), 1e-12);
            EXPECT_NEAR(fluid.density[i], 1000, 1e-9);
        }
    }
}

TEST(VelocityVerlet, StillFluidBetweenWallsStaysStill) {
    Scene scene = flat_channel(12);
    scene.numerics.density_diffusion = 0.1;
    Flow flow(scene);
    flow.run(200, largest_time_step(scene));
    EXPECT_LT(largest(flow.particles.fluid.velocity_x), 1e-10 * scene.numerics.sound_speed);
    EXPECT_LT(largest(flow.particles.fluid.velocity_y), 1e-10 * scene.numerics.sound_speed);
}

TEST(VelocityVerlet, DisorderedBoxKeepsItsMomentum) {
    Scene scene = doubly_periodic(14);
    jitter(scene, 0.2);
    Particles start = arrange(scene);
    disorder(start, scene);
    std::fill(start.fluid.density.begin(), start.fluid.density.end(), 1000.0);
    const double momentum_x = sum_of(start.fluid.velocity_x);
    const double momentum_y = sum_of(start.fluid.velocity_y);
    const double magnitude =
        sum_of_magnitudes(start.fluid.velocity_x) + sum_of_magnitudes(start.fluid.velocity_y);
    Flow flow(scene, start);
    flow.run(100, largest_time_step(scene));
    EXPECT_NEAR(sum_of(flow.particles.fluid.velocity_x), momentum_x, 1e-12 * magnitude);
    EXPECT_NEAR(sum_of(flow.particles.fluid.velocity_y), momentum_y, 1e-12 * magnitude);
}

double kinetic_energy(const FluidParticles& fluid) {
    double energy = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        energy += 0.5 * fluid.mass * (std::pow(fluid.velocity_x[i], 2) + std::pow(fluid.velocity_y[i], 2));
    }
    return energy;
}

TEST(VelocityVerlet, TaylorGreenVortexLosesItsEnergyAtTheViscousRate) {
    Scene scene = doubly_periodic(30);
    scene.fluid.dynamic_viscosity = 50; // Re = 20
    scene.numerics.density_diffusion = 0.1;
    scene.start.arrangement = Arrangement::relaxed;
    scene.start.velocity = InitialVelocity::taylor_green;
    scene.start.speed = 1;
    Flow flow(scene);
    const double start = kinetic_energy(flow.particles.fluid);
    flow.run(120, 0.0005);
    const double rate = 16 * std::numbers::pi * std::numbers::pi * scene.fluid.kinematic_viscosity();
    // exp(-rate t) is the exact decay; 30 particles a period at Mach 0.1 come within 2 %.
    EXPECT_NEAR(kinetic_energy(flow.particles.fluid) / start, std::exp(-rate * 0.06), 0.02);
}

TEST(VelocityVerlet, LimitsTheBackgroundPressureOfTheFirstShiftsToo) {
    const auto background = [](double ratio) {
        Scene scene = doubly_periodic(12);
        jitter(scene, 0.3);
        scene.numerics.background_pressure_ratio = ratio;
        return Flow(scene).particles.fluid.background_x;
    };
    EXPECT_GT(largest(background(5)), 0);
    EXPECT_EQ(background(5), background(10));
}

// How far the mean density of disordered particles in a box gets from its start in ten steps, relative.
double drift_of_mean_density(bool kept) {
    Scene scene = doubly_periodic(12);
    jitter(scene, 0.3);
    Flow flow(scene);
    disorder(flow.particles, scene);
    Forces forces = flow.forces();
    forces.keep_mean_density = kept;
    PhaseClock clock;
    const double start = sum_of(flow.particles.fluid.density);
    prepare_first_step(flow.particles, forces, 1e-5, clock);
    for (int step = 0; step < 10; ++step) {
        advance(flow.particles, forces, 1e-5, clock);
    }
    return std::abs(sum_of(flow.particles.fluid.density) / start - 1);
}

TEST(VelocityVerlet, KeepsTheMeanDensityWhereAsked) {
    EXPECT_LT(drift_of_mean_density(true), 1e-13);
    EXPECT_GT(drift_of_mean_density(false), 1e-8);
}

// Velocities of the vortex in the order of the start, after the same time in `steps` steps.
std::vector<double> velocity_after(int steps) {
    Scene scene = doubly_periodic(12);
    // First order by design: the shift is proportional to the step, friction sees the velocity of the half
    // step, and the pressure that is advected is that of the step's start.
    scene.numerics.background_pressure_ratio = 0;
    scene.fluid.dynamic_viscosity = 0;
    scene.numerics.compressibility = Compressibility::acoustic;
    scene.start.velocity = InitialVelocity::taylor_green;
    scene.start.speed = 1;
    Flow flow(scene);
    flow.run(steps, 0.016 / steps);
    std::vector<double> ordered(flow.particles.fluid.size());
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        ordered[flow.particles.fluid.identity[i]] = flow.particles.fluid.velocity_x[i];
    }
    return ordered;
}

TEST(VelocityVerlet, ErrorFallsAtLeastWithTheSquareOfTheStepWithoutViscosityAndTransportVelocity) {
    const auto exact = velocity_after(512);
    const auto error = [&](int steps) {
        std::vector<double> difference = velocity_after(steps);
        for (std::size_t i = 0; i < exact.size(); ++i) {
            difference[i] -= exact[i];
        }
        return largest(difference);
    };
    const double order = std::log2(error(16) / error(32));
    EXPECT_GT(order, 1.7);
    EXPECT_LT(order, 2.3);
}

} // namespace
} // namespace slurry::testing
