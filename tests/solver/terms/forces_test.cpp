// Pressure, viscous and background force and the advection tensor (2.15, 2.19, 2.20).
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

void compute(const Scene& scene, Particles& particles) {
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    interactions->compute_forces(particles);
}

// A doubly periodic box of disordered particles of equal mass.
struct Box {
    Scene scene = doubly_periodic(13);
    Particles particles;

    explicit Box(double jitter_amplitude = 0.3) {
        jitter(scene, jitter_amplitude);
        scene.fluid.dynamic_viscosity = 0;
        particles = arrange(scene);
        disorder(particles, scene);
    }
    void drop_pressure() { std::fill(particles.fluid.pressure.begin(), particles.fluid.pressure.end(), 0.0); }
};

void expect_no_resultant(const std::vector<double>& x, const std::vector<double>& y) {
    const double magnitude = sum_of_magnitudes(x) + sum_of_magnitudes(y);
    EXPECT_GT(magnitude, 0);
    EXPECT_LE(std::abs(sum_of(x)), 1e-12 * magnitude);
    EXPECT_LE(std::abs(sum_of(y)), 1e-12 * magnitude);
}

TEST(Forces, PressureConservesMomentum) {
    for (const auto volume : {ParticleVolume::mass_over_density, ParticleVolume::number_density}) {
        Box box;
        box.scene.numerics.advection_tensor = false;
        box.scene.numerics.particle_volume = volume;
        compute(box.scene, box.particles);
        expect_no_resultant(box.particles.fluid.acceleration_x, box.particles.fluid.acceleration_y);
    }
}

TEST(Forces, ViscosityConservesMomentumAndTakesEnergy) {
    Box box;
    box.scene.numerics.advection_tensor = false;
    box.scene.fluid.dynamic_viscosity = 2;
    box.drop_pressure();
    compute(box.scene, box.particles);
    const FluidParticles& fluid = box.particles.fluid;
    expect_no_resultant(fluid.acceleration_x, fluid.acceleration_y);
    double power = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        power +=
            fluid.velocity_x[i] * fluid.acceleration_x[i] + fluid.velocity_y[i] * fluid.acceleration_y[i];
    }
    EXPECT_LT(power, 0);
}

TEST(Forces, AdvectionTensorConservesMomentum) {
    Box box;
    box.drop_pressure();
    compute(box.scene, box.particles);
    expect_no_resultant(box.particles.fluid.acceleration_x, box.particles.fluid.acceleration_y);
}

TEST(Forces, BackgroundPressureHasNoResultantAndSpreadsAPair) {
    Box box;
    compute(box.scene, box.particles);
    expect_no_resultant(box.particles.fluid.background_x, box.particles.fluid.background_y);
    Box lattice(0);
    const std::size_t pushed = 70;
    lattice.particles.fluid.x[pushed] += 0.3 * lattice.scene.numerics.particle_spacing;
    const std::uint32_t identity = lattice.particles.fluid.identity[pushed];
    compute(lattice.scene, lattice.particles);
    const FluidParticles& fluid = lattice.particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        if (fluid.identity[i] == identity) {
            EXPECT_LT(fluid.background_x[i], 0); // back to its place
        }
    }
}

// Half the square of a time step times the acceleration must not carry particles past even spacing.
TEST(Forces, BackgroundPressureIsLimitedForLongTimeSteps) {
    Box box;
    const double unit = box.scene.numerics.smoothing_length() / box.scene.numerics.sound_speed;
    const auto push = [&](double time_step) {
        Particles particles = box.particles;
        particles.fluid.shift_time = time_step / 2;
        compute(box.scene, particles);
        return largest(particles.fluid.background_x);
    };
    const double free = push(0);
    EXPECT_EQ(push(0.75 * unit), free); // the default
    EXPECT_NEAR(push(2 * unit), 0.85 / 4 * free / box.scene.numerics.background_pressure_ratio, 1e-5 * free);
    EXPECT_NEAR(push(3 * unit) * 9, push(2 * unit) * 4, 1e-5 * free);
}

// Particles of a lattice with full support, away from the sides of a box without walls.
template <class Check> void for_interior(const Scene& scene, const Particles& particles, Check&& check) {
    const FluidParticles& fluid = particles.fluid;
    const double reach = 3 * scene.numerics.smoothing_length();
    std::size_t interior = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector position(fluid.x[i], fluid.y[i]);
        if ((position - scene.domain.lower).minCoeff() > reach &&
            (scene.domain.upper - position).minCoeff() > reach) {
            check(i);
            ++interior;
        }
    }
    EXPECT_GT(interior, 30U);
}

Scene open_lattice() {
    Scene scene = doubly_periodic(16);
    scene.numerics.background_pressure_ratio = 0;
    return scene;
}

TEST(Forces, ViscosityOfALinearShearOnALatticeIsZeroAndOfAParabolaTheLaplacian) {
    Scene scene = open_lattice();
    Particles particles = arrange(scene);
    scene.domain.periodic = {false, false};
    FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.velocity_x[i] = 5 * fluid.y[i];
        fluid.velocity_y[i] = std::pow(fluid.x[i], 2) + 2 * std::pow(fluid.y[i], 2);
    }
    compute(scene, particles);
    const double acceleration = scene.fluid.kinematic_viscosity() * 6;
    for_interior(scene, particles, [&](std::size_t i) {
        EXPECT_NEAR(fluid.acceleration_x[i], 0, 1e-13);
        EXPECT_NEAR(fluid.acceleration_y[i], acceleration, 0.01 * acceleration);
    });
}

TEST(Forces, PressureOfALinearFieldOnALatticeIsMinusItsGradient) {
    Scene scene = open_lattice();
    Particles particles = arrange(scene);
    scene.domain.periodic = {false, false};
    FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.pressure[i] = 300 + 40 * fluid.x[i] - 70 * fluid.y[i];
    }
    compute(scene, particles);
    for_interior(scene, particles, [&](std::size_t i) {
        EXPECT_NEAR(fluid.acceleration_x[i], -0.040, 0.01 * 0.07);
        EXPECT_NEAR(fluid.acceleration_y[i], 0.070, 0.01 * 0.07);
    });
}

TEST(Forces, UniformPressureOnALatticeMovesNothing) {
    Scene scene = doubly_periodic(12);
    Particles particles = arrange(scene);
    std::fill(particles.fluid.pressure.begin(), particles.fluid.pressure.end(), 1000.0);
    compute(scene, particles);
    const double one_sided = 1000 / (scene.fluid.density * scene.numerics.particle_spacing);
    EXPECT_LT(largest(particles.fluid.acceleration_x), 1e-13 * one_sided);
    EXPECT_LT(largest(particles.fluid.acceleration_y), 1e-13 * one_sided);
}

TEST(Forces, TermsThatASceneDoesNotNeedLeaveNoTrace) {
    Box box;
    box.scene.numerics.background_pressure_ratio = 0; // and with it the advection tensor
    box.drop_pressure();
    compute(box.scene, box.particles);
    EXPECT_EQ(largest(box.particles.fluid.acceleration_x), 0);
    EXPECT_EQ(largest(box.particles.fluid.background_x), 0);
}

} // namespace
} // namespace slurry::testing
