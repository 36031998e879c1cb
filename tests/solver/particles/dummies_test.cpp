// How walls carry their dummies.
#include "tests/solver/geometry/scenes.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slurry::testing {
namespace {

TEST(Dummies, OfASlidingLidStayButHaveTheWallsVelocity) {
    Scene scene = closed_box(1, 1, 0.1);
    scene.fluid = {1000, 2, Vector::Zero()};
    scene.numerics.sound_speed = 10;
    scene.walls[2].velocity = {3, 0}; // the top: a line between two ends that slides along itself
    Particles particles = arrange(scene);
    const std::vector<double> x = particles.dummies.x;
    const std::vector<double> y = particles.dummies.y;
    particles.dummies.move_walls_to(7);
    EXPECT_EQ(particles.dummies.x, x);
    EXPECT_EQ(particles.dummies.y, y);
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        EXPECT_EQ(particles.dummies.solid_velocity_x[d], particles.dummies.wall[d] == 2 ? 3 : 0);
    }
    EXPECT_EQ(particles.dummies.wall_drift[2], Vector(0, 0));

    scene.numerics.wall_extrapolation = WallExtrapolation::mean;
    evaluate(*make_interactions(scene), particles); // fluid at rest: Eq. 2.16 gives 2 V_wall
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        EXPECT_EQ(particles.dummies.velocity_x[d], particles.dummies.wall[d] == 2 ? 6 : 0);
    }
    std::fill(particles.fluid.velocity_x.begin(), particles.fluid.velocity_x.end(), 3);
    scene.numerics.wall_extrapolation = WallExtrapolation::fit;
    evaluate(*make_interactions(scene), particles); // fluid that moves with the lid
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        if (particles.dummies.wall[d] == 2) {
            EXPECT_FLOAT_EQ(static_cast<float>(particles.dummies.velocity_x[d]), 3);
        } else {
            EXPECT_LE(particles.dummies.velocity_x[d], 0); // 0 out of reach, beyond the corners
        }
    }
}

TEST(Dummies, OfAMovingRoughPadMoveWithIt) {
    Scene scene = rough_channel(1e-6);
    scene.fluid = {1000, 1e-3, Vector::Zero()};
    scene.numerics.sound_speed = 10;
    scene.walls[0].velocity = {0, 0};
    scene.walls[1].velocity = {-1, 0};
    Particles particles = arrange(scene);
    const DummyParticles start = particles.dummies;
    particles.dummies.move_walls_to(2e-6);
    for (std::size_t d = 0; d < start.size(); ++d) {
        EXPECT_NEAR(particles.dummies.x[d] - start.x[d], start.wall[d] == 1 ? -2e-6 : 0, 1e-18);
        EXPECT_EQ(particles.dummies.y[d], start.y[d]);
    }
}

TEST(Dummies, MoveAsFarAsTheirOwnWallInTheTime) {
    DummyParticles dummies;
    dummies.resize(3);
    dummies.wall_drift = {{2, -5}, {0, 0}};
    dummies.first_of_discs = 2; // what belongs to a disc moves with that
    dummies.start_x = {1, 1, 1};
    dummies.start_y = {4, 4, 4};
    dummies.x = dummies.y = {7, 7, 7};
    dummies.wall = {0, 1, 2};
    dummies.move_walls_to(3);
    EXPECT_EQ(dummies.x, std::vector<double>({1 + 6, 1, 7}));
    EXPECT_EQ(dummies.y, std::vector<double>({4 - 15, 4, 7}));
}

TEST(Dummies, KnowTheNearestPointOfTheirWallAndItsFrameWhileItMoves) {
    Scene scene = rough_channel(1e-6);
    scene.fluid = {1000, 1e-3, Vector::Zero()};
    scene.numerics.sound_speed = 10;
    scene.walls[1].velocity = {-1, 0};
    Particles particles = arrange(scene);
    const double moved = -1.7e-5;
    particles.dummies.move_walls_to(-moved);
    make_interactions(scene)->refresh_neighbours(particles); // wraps and sorts
    const DummyParticles& dummies = particles.dummies;
    const double k = 2 * std::numbers::pi / 3e-5;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        const Vector normal(dummies.normal_x[d], dummies.normal_y[d]);
        const Vector wall_point = Vector(dummies.x[d], dummies.y[d]) + dummies.depth[d] * normal;
        EXPECT_GT(dummies.depth[d], 0);
        if (dummies.wall[d] == 0) {
            EXPECT_EQ(normal, Vector(0, -1));
            EXPECT_NEAR(wall_point.y(), 1.5e-5, 1e-18);
            EXPECT_EQ(dummies.curvature[d], 0);
            continue;
        }
        const double phase = k * (wall_point.x() - moved);
        const double slope = 5e-6 * k * std::sin(phase);
        const double bend = 5e-6 * k * k * std::cos(phase);
        EXPECT_NEAR(wall_point.y(), 5e-6 - 5e-6 * std::cos(phase), 1e-13);
        EXPECT_LT((normal - Vector(-slope, 1).normalized()).norm(), 1e-6);
        EXPECT_NEAR(dummies.curvature[d], bend / std::pow(1 + slope * slope, 1.5), 1e-6 * 5e-6 * k * k);
    }
}

} // namespace
} // namespace slurry::testing
