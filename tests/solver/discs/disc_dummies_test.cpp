// The particles of a disc: where they lie, and how they move with it.
#include "solver/discs/disc_dummies.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace slurry::testing {
namespace {

TEST(DiscPoints, RingsFillTheDiscWithParticlesOfNearlyASquareSpacing) {
    for (const double radius : {1.5, 2.3, 4.0, 10.0, 12.5}) {
        double volume = 0;
        Vector centre = Vector::Zero();
        for (const DiscPoint& point : disc_points(radius, DiscDummies::rings, 1, 100)) {
            EXPECT_LE(point.position.norm(), radius - 0.4);
            EXPECT_NEAR(point.volume, 1, 0.75) << radius; // the one at the centre may be larger
            volume += point.volume;
            centre += point.volume * point.position;
        }
        EXPECT_NEAR(volume, std::numbers::pi * radius * radius, 1e-12 * volume);
        EXPECT_LT(centre.norm(), 1e-12 * volume);
    }
}

TEST(DiscPoints, OnlyThoseThatTheFluidCanReachAreKept) {
    for (const DiscDummies arrangement : {DiscDummies::rings, DiscDummies::lattice}) {
        const auto points = disc_points(10, arrangement, 1, 3);
        EXPECT_NEAR(static_cast<double>(points.size()), std::numbers::pi * (100 - 49), 12);
        for (const DiscPoint& point : points) {
            EXPECT_GT(point.position.norm(), 6.9);
            EXPECT_LT(point.position.norm(), 10);
        }
    }
}

TEST(DiscPoints, ThePapersLatticeHasThePapersCount) { // 484 in a disc of 25 spacings (Sec. 4.1.2)
    EXPECT_NEAR(static_cast<double>(disc_points(12.5, DiscDummies::lattice, 1, 100).size()), 484, 8);
}

TEST(DiscPoints, AreOnRingsWhereTheLatticeMissesTheDiscsArea) {
    const auto same = [](double radius, DiscDummies expected) {
        const auto adapted = disc_points(radius, DiscDummies::adapted, 0.5, 3);
        const auto points = disc_points(radius, expected, 0.5, 3);
        return std::ranges::equal(adapted, points, [](const DiscPoint& one, const DiscPoint& other) {
            return one.position == other.position && one.volume == other.volume;
        });
    };
    for (const double spacings : {2.4, 2.5, 3.0}) { // 0.88, 0.81 and 1.13 of the area
        EXPECT_TRUE(same(0.5 * spacings, DiscDummies::rings)) << spacings;
        EXPECT_FALSE(same(0.5 * spacings, DiscDummies::lattice)) << spacings;
    }
    for (const double spacings : {2.0, 5.0, 12.5}) { // 0.95, 1.02 and 0.99
        EXPECT_TRUE(same(0.5 * spacings, DiscDummies::lattice)) << spacings;
    }
}

Scene scene_with_turning_disc() {
    Scene scene = doubly_periodic(18);
    scene.discs = {middle_disc()};
    scene.discs[0].velocity = {0.3, -0.2};
    scene.discs[0].spin = 4;
    return scene;
}

TEST(DiscDummies, TranslateAndTurnWithTheirDisc) {
    Particles particles = arrange(scene_with_turning_disc());
    const DummyParticles start = particles.dummies;
    Disc& disc = particles.discs[0];
    const Vector moved(0.05, -0.02);
    disc.position += moved;
    disc.angle = std::numbers::pi / 2;
    move_disc_dummies(particles);
    const DummyParticles& dummies = particles.dummies;
    ASSERT_GT(dummies.size(), 25U);
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        const Vector arm = Vector(start.x[d], start.y[d]) - (disc.position - moved);
        const Vector place = disc.position + left_of(arm);
        EXPECT_NEAR(dummies.x[d], place.x(), 1e-14);
        EXPECT_NEAR(dummies.y[d], place.y(), 1e-14);
        const Vector velocity = disc.velocity + disc.spin * left_of(left_of(arm));
        EXPECT_NEAR(dummies.solid_velocity_x[d], velocity.x(), 1e-13);
        EXPECT_NEAR(dummies.solid_velocity_y[d], velocity.y(), 1e-13);
        EXPECT_NEAR(dummies.normal_x[d], left_of(arm.normalized()).x(), 1e-14);
    }
}

// A fluid in rigid rotation with the disc is continued into it as that rotation, wherever the particles are.
TEST(DiscDummies, ContinueARigidMotionExactly) {
    Scene scene = scene_with_turning_disc();
    jitter(scene, 0.3);
    Particles particles = arrange(scene);
    const Disc& disc = particles.discs[0];
    FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector velocity =
            disc.velocity + disc.spin * left_of(Vector(fluid.x[i], fluid.y[i]) - disc.position);
        fluid.velocity_x[i] = velocity.x();
        fluid.velocity_y[i] = velocity.y();
        fluid.pressure[i] = 30 + 7 * fluid.x[i] - 5 * fluid.y[i];
    }
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    interactions->extrapolate_to_walls(particles);
    const DummyParticles& dummies = particles.dummies;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        EXPECT_NEAR(dummies.velocity_x[d], dummies.solid_velocity_x[d], 1e-9);
        EXPECT_NEAR(dummies.velocity_y[d], dummies.solid_velocity_y[d], 1e-9);
    }
    interactions->compute_density_rate(particles);
    for (std::size_t i = 0; i < fluid.size(); ++i) { // nothing is compressed, but where the box repeats
        if ((Vector(fluid.x[i], fluid.y[i]) - disc.position).norm() < 0.32) {
            EXPECT_NEAR(fluid.density_rate[i], 0, 1e-8);
        }
    }
}

TEST(DiscDummies, CrossAPeriodicSideWithTheirDisc) {
    Scene scene = doubly_periodic(18);
    scene.numerics.disc_dummies = DiscDummies::lattice; // none is beyond the side since the last rebuild
    scene.discs = {middle_disc()};
    Particles particles = arrange(scene);
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    for (int step = 0; step < 45; ++step) {
        particles.discs[0].position += Vector(0.01, 0.01);
        move_disc_dummies(particles);
        interactions->refresh_neighbours(particles);
    }
    for (int again = 0; again < 2; ++again) { // wrapping is not undone
        for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
            EXPECT_TRUE(particles.dummies.x[d] >= scene.domain.lower.x() - 1e-9);
            EXPECT_TRUE(particles.dummies.x[d] <= scene.domain.upper.x() + 1e-9);
        }
        move_disc_dummies(particles);
    }
}

} // namespace
} // namespace slurry::testing
