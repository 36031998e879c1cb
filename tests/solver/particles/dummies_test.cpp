// How walls carry their dummies.
#include "tests/solver/geometry/scenes.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

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
    particles.dummies.move_to(7);
    EXPECT_EQ(particles.dummies.x, x);
    EXPECT_EQ(particles.dummies.y, y);
    EXPECT_EQ(particles.dummies.wall_velocity[2], Vector(3, 0));
    EXPECT_EQ(particles.dummies.wall_drift[2], Vector(0, 0));

    const auto interactions = make_interactions(scene);
    evaluate(*interactions, particles); // fluid at rest: Eq. 2.16 gives 2 V_wall
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        EXPECT_EQ(particles.dummies.velocity_x[d], particles.dummies.wall[d] == 2 ? 6 : 0);
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
    particles.dummies.move_to(2e-6);
    for (std::size_t d = 0; d < start.size(); ++d) {
        EXPECT_NEAR(particles.dummies.x[d] - start.x[d], start.wall[d] == 1 ? -2e-6 : 0, 1e-18);
        EXPECT_EQ(particles.dummies.y[d], start.y[d]);
    }
}

} // namespace
} // namespace slurry::testing
