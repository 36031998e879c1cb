// The wide pair loops against plain numbers, against all pairs, and against themselves with other thread
// counts.
#include "solver/loop/interactions.hpp"

#include "tests/solver/loop/all_pairs.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace slurry::testing {
namespace {

constexpr unsigned compositions = 512;
constexpr std::array both_extrapolations{WallExtrapolation::mean, WallExtrapolation::fit};

// One bit a choice; 11 x 11 particles, so that the last block of any width is not full.
Scene composed(unsigned bits, bool walls) {
    Scene scene = walls ? flat_channel(11, 1.5) : doubly_periodic(11);
    jitter(scene, 0.25);
    const auto bit = [bits](unsigned k) { return (bits >> k & 1U) != 0; };
    scene.numerics.gradient_correction = bit(0);
    scene.numerics.density_diffusion = bit(1) ? 0.1 : 0;
    scene.numerics.fourth_order_diffusion_share = bit(3) ? 0.8 : 0;
    scene.fluid.body_force = bit(2) ? Vector(0.7, -9.81) : Vector(0, 0);
    scene.fluid.dynamic_viscosity = bit(3) ? 2 : 0;
    scene.numerics.background_pressure_ratio = bit(4) ? 0.8 : 0;
    scene.numerics.advection_tensor = bit(5);
    scene.numerics.particle_volume = bit(6)   ? ParticleVolume::number_density
                                     : bit(3) ? ParticleVolume::constant
                                              : ParticleVolume::mass_over_density;
    scene.numerics.compressibility = bit(5) ? Compressibility::acoustic : Compressibility::steady_frame;
    scene.numerics.wall_continuity = bit(7)   ? WallContinuity::extrapolated
                                     : bit(8) ? WallContinuity::solenoidal
                                              : WallContinuity::wall_velocity;
    scene.numerics.wall_extrapolation = bit(8) ? WallExtrapolation::fit : WallExtrapolation::mean;
    return scene;
}

Particles disordered(const Scene& scene) {
    Particles particles = arrange(scene);
    disorder(particles, scene);
    return particles;
}

// Particle by particle, relative to the largest value: what a sum of cancelling terms can promise.
void expect_close(const std::vector<double>& values, const std::vector<double>& expected, double tolerance,
                  const char* name) {
    ASSERT_EQ(values.size(), expected.size()) << name;
    const double scale = largest(expected);
    double error = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double difference = std::abs(values[k] - expected[k]);
        error = difference <= error ? error : difference; // keeps NaN
    }
    EXPECT_TRUE(std::isfinite(scale)) << name;
    EXPECT_LE(error, tolerance * scale) << name;
}

void expect_same_results(const Particles& particles, const Particles& expected, double tolerance) {
    const FluidParticles& fluid = particles.fluid;
    ASSERT_EQ(fluid.identity, expected.fluid.identity);
    if (!fluid.number_density_volume.empty()) {
        expect_close(fluid.number_density_volume, expected.fluid.number_density_volume, tolerance, "volume");
    }
    expect_close(fluid.density_rate, expected.fluid.density_rate, tolerance, "density rate");
    expect_close(fluid.acceleration_x, expected.fluid.acceleration_x, tolerance, "acceleration x");
    expect_close(fluid.acceleration_y, expected.fluid.acceleration_y, tolerance, "acceleration y");
    expect_close(fluid.background_x, expected.fluid.background_x, tolerance, "background x");
    expect_close(fluid.background_y, expected.fluid.background_y, tolerance, "background y");
    expect_close(particles.dummies.velocity_x, expected.dummies.velocity_x, tolerance, "dummy velocity x");
    expect_close(particles.dummies.velocity_y, expected.dummies.velocity_y, tolerance, "dummy velocity y");
    expect_close(particles.dummies.pressure, expected.dummies.pressure, tolerance, "dummy pressure");
    expect_close(particles.dummies.fluid_share, expected.dummies.fluid_share, tolerance, "fluid share");
}

Particles evaluated(const Scene& scene, LoopWidth width) {
    Particles particles = disordered(scene);
    const auto interactions = make_interactions(scene, width);
    evaluate(*interactions, particles);
    return particles;
}

TEST(Interactions, NativeWidthAgreesWithPlainNumbersInEveryComposition) {
    for (unsigned bits = 0; bits < compositions; ++bits) {
        for (const bool walls : {false, true}) {
            SCOPED_TRACE("composition " + std::to_string(bits) + (walls ? " with walls" : " without walls"));
            const Scene scene = composed(bits, walls);
            expect_same_results(evaluated(scene, LoopWidth::native), evaluated(scene, LoopWidth::plain),
                                1e-12);
        }
    }
}

// What float keeps of numbers near one, in sums of some thirty terms that cancel.
TEST(Interactions, FloatAgreesWithPlainNumbersInEveryComposition) {
    for (unsigned bits = 0; bits < compositions; ++bits) {
        for (const bool walls : {false, true}) {
            SCOPED_TRACE("composition " + std::to_string(bits) + (walls ? " with walls" : " without walls"));
            Scene scene = composed(bits, walls);
            scene.numerics.pair_arithmetic = PairArithmetic::single_precision;
            expect_same_results(evaluated(scene, LoopWidth::native), evaluated(scene, LoopWidth::plain),
                                2e-5);
        }
    }
}

// Where a scene lies is no physics: float sees places from the middle of the domain.
TEST(Interactions, FloatAgreesWithPlainNumbersFarFromTheOrigin) {
    Scene scene = composed(compositions - 1, false);
    const Vector far(1e4, -3e4);
    scene.domain.lower += far;
    scene.domain.upper += far;
    const Particles plain = evaluated(scene, LoopWidth::plain);
    scene.numerics.pair_arithmetic = PairArithmetic::single_precision;
    expect_same_results(evaluated(scene, LoopWidth::native), plain, 2e-5);
}

TEST(Interactions, EveryKernelAgreesWithPlainNumbers) {
    for (const KernelShape kernel : {KernelShape::quintic, KernelShape::wendland_c2, KernelShape::wendland_c4,
                                     KernelShape::fitted_quintic}) {
        if (!is_built(kernel)) {
            continue;
        }
        for (const unsigned bits : {0U, compositions - 1, compositions - 1 - 64U}) {
            Scene scene = composed(bits, true);
            scene.numerics.kernel = kernel;
            scene.numerics.pressure_mean = bits == 0 ? PressureMean::plain : PressureMean::density_weighted;
            const Particles plain = evaluated(scene, LoopWidth::plain);
            expect_same_results(evaluated(scene, LoopWidth::native), plain, 1e-12);
            scene.numerics.pair_arithmetic = PairArithmetic::single_precision;
            expect_same_results(evaluated(scene, LoopWidth::native), plain, 2e-5);
        }
    }
}

// The softening of 1e-12 h^2 under the root of the distance, which the equations do not have, sets the
// tolerance.
void expect_all_pairs(const Scene& scene) {
    const Particles particles = evaluated(scene, LoopWidth::native);
    Particles expected = disordered(scene);
    make_interactions(scene)->refresh_neighbours(expected); // the same order
    AllPairs(scene, expected).evaluate();
    expect_same_results(particles, expected, 1e-9);
}

TEST(Interactions, AgreeWithTheEquationsOverAllPairsInEveryComposition) {
    for (unsigned bits = 0; bits < compositions; ++bits) {
        SCOPED_TRACE("composition " + std::to_string(bits));
        expect_all_pairs(composed(bits, bits % 5 != 0));
    }
}

TEST(Interactions, AgreeWithTheEquationsAtALargerSmoothingLength) {
    for (const WallExtrapolation extrapolation : both_extrapolations) {
        Scene scene = composed(compositions - 1, true);
        scene.numerics.wall_extrapolation = extrapolation;
        scene.numerics.smoothing_ratio = 1.3;
        expect_all_pairs(scene);
    }
}

// Where the wall is steep at a periodic side, the nearest points of deep dummies lie beyond that side.
TEST(Interactions, AgreeWithTheEquationsBesideASteepWallThatCrossesAPeriodicSide) {
    for (const double crest : {-0.3, -0.05, 0.45}) {
        SCOPED_TRACE("crest at " + std::to_string(crest));
        Scene scene = composed(compositions - 1, true);
        scene.walls[0].shape = CosineShape{0.35, 0.1, 1, crest};
        scene.walls[0].velocity = {-0.5, 0};
        for (const WallExtrapolation extrapolation : both_extrapolations) {
            scene.numerics.wall_extrapolation = extrapolation;
            expect_all_pairs(scene);
        }
    }
}

TEST(Interactions, AgreeWithTheEquationsAroundADiscThatSpins) {
    for (const unsigned bits : {0U, 255U, 256U, 264U, compositions - 1}) { // means and fits
        SCOPED_TRACE("composition " + std::to_string(bits));
        Scene scene = composed(bits, true);
        scene.discs = {middle_disc()};
        scene.discs[0].velocity = {0.7, -0.4};
        scene.discs[0].spin = 3;
        expect_all_pairs(scene);
        expect_same_results(evaluated(scene, LoopWidth::native), evaluated(scene, LoopWidth::plain), 1e-12);
    }
}

TEST(Interactions, DoNotDependOnTheNumberOfThreads) {
    const int threads_before = omp_get_max_threads();
    const Scene scene = composed(compositions - 1, true);
    omp_set_num_threads(1);
    const Particles one = evaluated(scene, LoopWidth::native);
    for (const int threads : {2, 3}) {
        omp_set_num_threads(threads);
        expect_same_results(evaluated(scene, LoopWidth::native), one, 0);
    }
    omp_set_num_threads(threads_before);
}

TEST(Interactions, StayRightBetweenTwoRebuilds) {
    for (const WallExtrapolation extrapolation : both_extrapolations) {
        Scene scene = composed(compositions - 1, true);
        scene.numerics.wall_extrapolation = extrapolation;
        Particles particles = disordered(scene);
        const auto kept = make_interactions(scene);
        kept->refresh_neighbours(particles);
        for (std::size_t i = 0; i < particles.fluid.size(); ++i) { // less than the skin, against one another
            particles.fluid.x[i] += 0.08 * scene.numerics.particle_spacing * particles.fluid.velocity_x[i];
            particles.fluid.y[i] += 0.08 * scene.numerics.particle_spacing * particles.fluid.velocity_y[i];
        }
        Particles expected = particles;
        evaluate(*kept, particles);
        EXPECT_EQ(kept->list_statistics(particles).rebuilds, 1);
        AllPairs(scene, expected).evaluate();
        expect_same_results(particles, expected, 1e-9);
    }
}

// The watchdog looks only now and then; until then such a particle must do no harm.
TEST(Interactions, CarryPositionsThatAreNotFiniteThroughARebuild) {
    for (const double lost : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        for (const Scene& scene : {doubly_periodic(11), flat_channel(11)}) {
            for (const std::size_t culprit : {0U, 60U, 120U}) {
                Particles particles = arrange(scene);
                particles.fluid.x[culprit] = lost;
                particles.fluid.y[culprit] = -lost;
                const auto interactions = make_interactions(scene);
                interactions->refresh_neighbours(particles);
                EXPECT_EQ(particles.fluid.size(), 121U);
            }
        }
    }
}

TEST(Interactions, RebuildForRelativeMotionOnly) {
    const Scene scene = doubly_periodic(11);
    Particles particles = arrange(scene);
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    for (double& x : particles.fluid.x) {
        x += 0.6;
    }
    interactions->refresh_neighbours(particles);
    EXPECT_EQ(interactions->list_statistics(particles).rebuilds, 1);
    particles.fluid.x[40] += scene.numerics.particle_spacing;
    interactions->refresh_neighbours(particles);
    EXPECT_EQ(interactions->list_statistics(particles).rebuilds, 2);
}

} // namespace
} // namespace slurry::testing
