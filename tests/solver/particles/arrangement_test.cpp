// The start of a scene: positions, masses, dummies and velocities.
#include "solver/particles/arrangement.hpp"

#include "solver/terms/equation_of_state.hpp"
#include "tests/solver/geometry/scenes.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace slurry::testing {
namespace {

Scene channel_to_fill(double spacing) {
    Scene scene = rough_channel(spacing);
    scene.fluid = {1000, 1e-3, Vector::Zero()};
    scene.numerics.sound_speed = 10;
    return scene;
}

TEST(Arrangement, MassOfAllParticlesIsDensityTimesArea) {
    for (const auto arrangement : {Arrangement::lattice, Arrangement::jittered, Arrangement::relaxed}) {
        Scene scene = channel_to_fill(1e-6);
        scene.start.arrangement = arrangement;
        const FluidParticles fluid = arrange(scene).fluid;
        // Sec. 4.1.1: the fluid's area is L H0 = 3e-10 m2
        EXPECT_NEAR(fluid.mass * static_cast<double>(fluid.size()), 1000 * 3e-10, 1e-8 * 1000 * 3e-10);
        EXPECT_NEAR(static_cast<double>(fluid.size()), 300, 6);
        EXPECT_EQ(fluid.density, std::vector<double>(fluid.size(), 1000));
    }
}

TEST(Arrangement, JitterMovesEveryParticleWithinItsBound) {
    Scene scene = doubly_periodic(20);
    const FluidParticles lattice = arrange(scene).fluid;
    jitter(scene, 0.2);
    const FluidParticles moved = arrange(scene).fluid;
    const double bound = 0.2 * scene.numerics.particle_spacing;
    double farthest = 0;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
        EXPECT_NE(moved.x[i], lattice.x[i]);
        farthest =
            std::max({farthest, std::abs(moved.x[i] - lattice.x[i]), std::abs(moved.y[i] - lattice.y[i])});
    }
    EXPECT_LE(farthest, bound * (1 + 1e-12));
    EXPECT_GT(farthest, 0.95 * bound);
}

TEST(Arrangement, SeedDecidesTheStart) {
    Scene scene = flat_channel(12);
    jitter(scene, 0.2, 5);
    const FluidParticles first = arrange(scene).fluid;
    EXPECT_EQ(arrange(scene).fluid.x, first.x);
    EXPECT_EQ(arrange(scene).fluid.y, first.y);
    scene.start.seed = 6;
    EXPECT_NE(arrange(scene).fluid.x, first.x);
}

// Largest acceleration by the background pressure: 0 when the spacing is even.
double unevenness(const Scene& scene) {
    Particles particles = arrange(scene);
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    interactions->compute_forces(particles);
    return std::max(largest(particles.fluid.background_x), largest(particles.fluid.background_y));
}

TEST(Arrangement, RelaxedStartEvensOutTheSpacing) {
    for (Scene scene : {doubly_periodic(16), channel_to_fill(1e-6)}) {
        jitter(scene, 0.3);
        const double before = unevenness(scene);
        scene.start.arrangement = Arrangement::relaxed;
        EXPECT_LT(unevenness(scene), 0.1 * before);
    }
}

TEST(Arrangement, RelaxedStartDoesNotDependOnTheBackgroundPressureOfTheRun) {
    Scene scene = doubly_periodic(12);
    scene.start.arrangement = Arrangement::relaxed;
    const FluidParticles with = arrange(scene).fluid;
    scene.numerics.background_pressure_ratio = 0;
    EXPECT_EQ(arrange(scene).fluid.x, with.x);
}

TEST(Arrangement, ParticlesStartInTheFluidAndDummiesBehindTheWalls) {
    for (const auto arrangement : {Arrangement::lattice, Arrangement::jittered, Arrangement::relaxed}) {
        Scene scene = channel_to_fill(0.5e-6);
        jitter(scene, 0.5);
        scene.start.arrangement = arrangement;
        const Region region(scene);
        const Particles particles = arrange_particles(scene, region);
        for (std::size_t i = 0; i < particles.fluid.size(); ++i) {
            EXPECT_GT(region.distance({particles.fluid.x[i], particles.fluid.y[i]}), 0);
        }
        for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
            EXPECT_LT(region.distance({particles.dummies.x[d], particles.dummies.y[d]}), 0);
        }
    }
}

TEST(Arrangement, DummyLayersCoverTheSupport) {
    Numerics numerics;
    for (const auto& [ratio, layers] : {std::pair{1.0, 3}, {1.2, 4}, {1.4, 5}, {4.0 / 3, 4}, {2.0, 6}}) {
        numerics.smoothing_ratio = ratio;
        EXPECT_EQ(dummy_layers(numerics), layers) << ratio;
    }
    EXPECT_EQ(arrange(flat_channel(12)).dummies.size(), 2U * 3 * 12);
}

TEST(Arrangement, ShearGrowsFromTheFloorToTheTop) {
    Scene scene = flat_channel(12);
    jitter(scene, 0.2);
    scene.start.velocity = InitialVelocity::shear;
    scene.start.speed = 2;
    const FluidParticles fluid = arrange(scene).fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        EXPECT_NEAR(fluid.velocity_x[i], 2 * (fluid.y[i] - 0.2), 1e-14);
        EXPECT_EQ(fluid.velocity_y[i], 0);
    }
}

TEST(Arrangement, TaylorGreenHasItsPeakSpeedAndPressureNoDivergenceAndNoMeanVelocity) {
    Scene scene = doubly_periodic(24);
    scene.start.velocity = InitialVelocity::taylor_green;
    scene.start.speed = 1.5;
    const FluidParticles fluid = arrange(scene).fluid;
    const EquationOfState equation_of_state{scene.fluid.density, scene.numerics.sound_speed};
    double energy = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double x = 2 * std::numbers::pi * (fluid.x[i] + 0.3);
        const double y = 2 * std::numbers::pi * (fluid.y[i] - 0.2);
        EXPECT_NEAR(fluid.velocity_x[i], -1.5 * std::cos(x) * std::sin(y), 1e-12);
        EXPECT_NEAR(fluid.velocity_y[i], 1.5 * std::sin(x) * std::cos(y), 1e-12);
        EXPECT_NEAR(equation_of_state.pressure(fluid.density[i]),
                    -1000 * 1.5 * 1.5 / 4 * (std::cos(2 * x) + std::cos(2 * y)), 1e-6);
        energy += 0.5 * fluid.mass * (std::pow(fluid.velocity_x[i], 2) + std::pow(fluid.velocity_y[i], 2));
    }
    EXPECT_NEAR(energy, 1000 * 1.5 * 1.5 / 4, 1e-9); // mean of cos^2 sin^2 is 1/4, twice, halved
    EXPECT_NEAR(sum_of(fluid.velocity_x), 0, 1e-10);
    EXPECT_NEAR(sum_of(fluid.velocity_y), 0, 1e-10);
}

} // namespace
} // namespace slurry::testing
