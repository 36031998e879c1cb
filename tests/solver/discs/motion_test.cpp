// Motion of discs: Newton's law, gravity, and what the fluid and a disc do to each other.
#include "solver/discs/motion.hpp"

#include "solver/discs/placement.hpp"
#include "solver/time/time_step.hpp"
#include "tests/solver/flow_for_tests.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace slurry::testing {
namespace {

TEST(Discs, WeighWhatGravityLeavesOfThem) {
    Scene scene = flat_channel(18);
    scene.discs = {middle_disc(1500)};
    scene.fluid.gravity = {0, -10};
    const double area = std::numbers::pi / 36;
    EXPECT_NEAR(arrange(scene).discs[0].weight.y(), -10 * 500 * area, 1e-9);
    EXPECT_EQ(scene.fluid.acceleration().y(), 0);
    scene.fluid.hydrostatics = Hydrostatics::full;
    EXPECT_NEAR(arrange(scene).discs[0].weight.y(), -10 * 1500 * area, 1e-9);
    EXPECT_EQ(scene.fluid.acceleration().y(), -10);
}

TEST(Discs, FlyAndTurnExactlyInADryBox) {
    Scene scene = doubly_periodic(18);
    scene.start.arrangement = Arrangement::empty;
    scene.discs = {middle_disc(3)};
    scene.discs[0].velocity = {0.9, -2.3};
    scene.discs[0].spin = -7;
    Flow flow(scene);
    flow.run(1000, 0.004);
    const Disc& disc = flow.particles.discs[0];
    EXPECT_LT((disc.position - Vector(0.2 + 3.6, 0.7 - 9.2)).norm(), 1e-12 * 9);
    EXPECT_NEAR(disc.angle, -28, 28e-12);
}

TEST(Discs, AndFluidKeepTheirMomentum) {
    Scene scene = doubly_periodic(24);
    jitter(scene, 0.2);
    scene.discs = {middle_disc(1700)};
    scene.discs[0].velocity = {0.4, 0.3};
    scene.discs[0].spin = 3;
    for (const DiscMotion motion : {DiscMotion::free, DiscMotion::fixed}) {
        scene.discs[0].motion = motion;
        Particles start = arrange(scene);
        disorder(start, scene);
        std::fill(start.fluid.density.begin(), start.fluid.density.end(), 1000.0);
        Flow flow(scene, start);
        const auto momentum = [&] {
            const FluidParticles& fluid = flow.particles.fluid;
            const Disc& disc = flow.particles.discs[0];
            return Vector(fluid.mass * Vector(sum_of(fluid.velocity_x), sum_of(fluid.velocity_y)) +
                          disc.mass * disc.velocity);
        };
        const double magnitude = start.fluid.mass * sum_of_magnitudes(start.fluid.velocity_x);
        const Vector before = momentum();
        flow.run(100, largest_time_step(scene));
        const double change = (momentum() - before).norm() / magnitude;
        if (motion == DiscMotion::free) {
            EXPECT_LT(change, 1e-12);
        } else {
            EXPECT_GT(change, 1e-6); // one that is held is not part of the sum
        }
    }
}

TEST(Discs, OfTheFluidsDensityRestInIt) {
    Scene scene = flat_channel(18);
    scene.discs = {middle_disc()};
    scene.numerics.pair_arithmetic = PairArithmetic::single_precision;
    Flow flow(scene);
    flow.run(500, largest_time_step(scene));
    EXPECT_LT(flow.particles.discs[0].velocity.norm(), 1e-6 * scene.numerics.sound_speed);
    EXPECT_LT(largest(flow.particles.fluid.velocity_x), 1e-6 * scene.numerics.sound_speed);
}

TEST(Discs, GainMomentumByForceAndTimeUnlessHeld) {
    Scene scene = doubly_periodic(18);
    scene.discs = {middle_disc(3)};
    for (const DiscMotion motion : {DiscMotion::free, DiscMotion::fixed}) {
        scene.discs[0].motion = motion;
        Particles particles = arrange(scene);
        Disc& disc = particles.discs[0];
        disc.force = {1, 2};
        disc.contact_force = {3, -1};
        disc.weight = {0, -8};
        disc.torque = 5;
        kick_discs(particles, 0.25);
        const bool free = motion == DiscMotion::free;
        EXPECT_LT((disc.mass * disc.velocity - (free ? Vector(1, -1.75) : Vector(0, 0))).norm(), 1e-14);
        EXPECT_NEAR(disc.moment_of_inertia * disc.spin, free ? 1.25 : 0, 1e-14);
        EXPECT_NEAR(disc.moment_of_inertia, disc.mass * disc.radius * disc.radius / 2, 1e-15);
    }
}

TEST(Discs, TurnByTheMomentOfTheForcesOnTheirParticles) {
    Scene scene = doubly_periodic(24);
    scene.discs = {middle_disc()};
    Particles particles = arrange(scene);
    DummyParticles& dummies = particles.dummies;
    const std::size_t count = dummies.size(); // there are no walls
    const Vector centre = particles.discs[0].position;
    dummies.force_x.assign(count, 0);
    dummies.force_y.assign(count, 0);
    dummies.twist.assign(count, 0.25);
    Vector force = Vector::Zero();
    double torque = 0.25 * static_cast<double>(count);
    for (std::size_t d = 0; d < count; ++d) {
        const Vector part(0.3 + dummies.y[d], -0.2 + dummies.x[d] * dummies.x[d]);
        const Vector arm = Vector(dummies.x[d], dummies.y[d]) - centre;
        dummies.force_x[d] = part.x();
        dummies.force_y[d] = part.y();
        force += part;
        torque += left_of(arm).dot(part);
    }
    sum_disc_forces(particles, scene.fluid);
    EXPECT_LT((particles.discs[0].force - force).norm(), 1e-12 * force.norm());
    EXPECT_NEAR(particles.discs[0].torque, torque, 1e-12 * std::abs(torque));
}

// A disc that turns with all the fluid around it feels no torque. Eq. 2.15 alone would give it one.
TEST(Discs, FeelNoTorqueInARigidRotation) {
    Scene scene = doubly_periodic(36);
    scene.discs = {middle_disc()};
    scene.discs[0].spin = 2;
    Particles particles = arrange(scene);
    const Disc& disc = particles.discs[0];
    FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector velocity = disc.spin * left_of(Vector(fluid.x[i], fluid.y[i]) - disc.position);
        fluid.velocity_x[i] = velocity.x();
        fluid.velocity_y[i] = velocity.y();
    }
    const auto interactions = make_interactions(scene);
    evaluate(*interactions, particles);
    sum_disc_forces(particles, scene.fluid);
    const double part = 2 * scene.fluid.dynamic_viscosity * disc.area() * disc.spin;
    EXPECT_LT(std::abs(disc.torque), 0.05 * part);
}

} // namespace
} // namespace slurry::testing
