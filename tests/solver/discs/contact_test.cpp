// Repulsion between discs and with walls, Eqs. 2.27 and 2.28.
#include "solver/discs/contact.hpp"

#include "solver/particles/run_error.hpp"
#include "tests/solver/flow_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

constexpr double radius = 0.1;
constexpr double distance = 0.02;

Scene dry(Scene scene, std::initializer_list<Vector> centres) {
    scene.start.arrangement = Arrangement::empty;
    scene.contact = {distance, 3, 1.5}; // touch: 2 N/m
    for (const Vector& centre : centres) {
        DiscScene disc = middle_disc(2000);
        disc.name += std::to_string(scene.discs.size());
        disc.placement = SingleDisc{radius, centre};
        scene.discs.push_back(disc);
    }
    return scene;
}

std::vector<Disc> discs_with_forces(const Scene& scene) {
    Particles particles = arrange(scene);
    const Region region(scene);
    DiscContacts(scene, region).compute(particles);
    return particles.discs;
}

TEST(DiscContacts, FollowEquation227) {
    const Vector direction = Vector(3, 4) / 5;
    for (const double gap : {0.0, 0.005, 0.015, 0.019, 0.021}) {
        const auto discs = discs_with_forces(
            dry(doubly_periodic(20), {{0.2, 0.7}, Vector(0.2, 0.7) + (2 * radius + gap) * direction}));
        const double depth = gap < distance ? (gap - distance) / distance : 0;
        EXPECT_LT((discs[1].contact_force - 2 * depth * depth * direction).norm(), 1e-12) << gap;
        EXPECT_LT((discs[0].contact_force + discs[1].contact_force).norm(), 1e-14);
    }
}

TEST(DiscContacts, ActAcrossPeriodicSidesAndOncePerPair) {
    for (const Vector& across : {Vector(1, 0), Vector(0, 1)}) {
        const Vector corner(-0.3, 0.2);
        const auto discs =
            discs_with_forces(dry(doubly_periodic(20), {corner + Vector(0.3, 0.3) - 0.25 * across,
                                                        corner + Vector(0.3, 0.3) + 0.54 * across}));
        EXPECT_NEAR(discs[0].contact_force.dot(across), 0.5, 1e-9); // a gap of half the distance
        EXPECT_NEAR(discs[1].contact_force.dot(across), -0.5, 1e-9);
    }
}

TEST(DiscContacts, DoNotDependOnThePlaceInAPeriodicDomain) {
    const Scene scene = dry(doubly_periodic(20), {{0.2, 0.4}, {0.2, 0.9}});
    const Region region(scene);
    Particles particles = arrange(scene);
    std::vector<Disc>& discs = particles.discs;
    const Vector offset = (2 * radius + distance / 2) * Vector(3, 4) / 5;
    for (double moved = -2; moved < 2; moved += 0.0625) { // through the domain of width 1 and beyond
        discs[0].position = Vector(0.2 + moved, 0.7 - 2 * moved);
        discs[1].position = discs[0].position + offset;
        DiscContacts(scene, region).compute(particles);
        EXPECT_LT((discs[1].contact_force - 0.5 * offset.normalized()).norm(), 1e-9) << moved;
        EXPECT_LT((discs[0].contact_force + discs[1].contact_force).norm(), 1e-14) << moved;
    }
}

TEST(DiscContacts, WallsRepelAsMirrorDiscsDo) {
    for (const double gap : {0.0, 0.004, 0.009, 0.011}) {
        const auto discs = discs_with_forces(dry(flat_channel(20), {{0.2, 0.2 + radius + gap}}));
        const double depth = 2 * gap < distance ? (2 * gap - distance) / distance : 0;
        EXPECT_LT((discs[0].contact_force - Vector(0, 2 * depth * depth)).norm(), 1e-12) << gap;
    }
}

// A force f (1 - gap / distance)^2 does the work f distance / 3 on the way to touch.
TEST(DiscContacts, ByDefaultStopAFifthOfTheSoundSpeed) {
    Scene scene = dry(flat_channel(20), {{0.1, 0.7}, {0.1 + 2 * radius, 0.7}, {0.5, 0.2 + radius}});
    scene.contact = {};
    scene.discs[1].density = 700;
    const double reach = 2 * scene.numerics.particle_spacing;
    const double stopped = scene.numerics.sound_speed / 5;
    const auto work_of = [&](std::size_t disc, double way) {
        return discs_with_forces(scene)[disc].contact_force.norm() * way / 3;
    };
    const std::vector<Disc> discs = arrange(scene).discs;
    const double reduced_mass = 1 / (1 / discs[0].mass + 1 / discs[1].mass);
    EXPECT_NEAR(work_of(0, reach), 0.5 * reduced_mass * stopped * stopped, 1e-6);
    EXPECT_NEAR(work_of(1, reach), 0.5 * reduced_mass * stopped * stopped, 1e-6);
    EXPECT_NEAR(work_of(2, reach / 2), 0.5 * discs[2].mass * stopped * stopped, 1e-6); // by the floor
    scene.discs[0].motion = DiscMotion::fixed;
    EXPECT_NEAR(work_of(1, reach), 0.5 * discs[1].mass * stopped * stopped, 1e-6);
    scene.discs[1].motion = DiscMotion::fixed;
    EXPECT_EQ(work_of(1, reach), 0);
}

// At touch the force grows by 2 f / distance per length; by the floor, whose mirror disc moves, by twice
// that.
TEST(DiscContacts, HighestFrequencyIsThatOfASpringAtTouch) {
    Scene scene = dry(flat_channel(20), {{0.1, 0.7}, {0.5, 0.7}});
    scene.discs[1].density = 700;
    const Particles particles = arrange(scene);
    const Region region(scene);
    const DiscContacts contacts(scene, region);
    const double spring = 2 * 2 / distance; // the scene's f is 2 N/m
    const double lightest = particles.discs[1].mass;
    EXPECT_NEAR(contacts.highest_frequency(particles.discs), std::sqrt(2 * spring / lightest), 1e-9);
    scene.contact = {distance, 0, 1}; // by default the floor's force is 3 / 0.75 times as large as a pair's
    const DiscContacts by_default(scene, region);
    const double stopped = scene.numerics.sound_speed / 5;
    EXPECT_NEAR(by_default.highest_frequency(particles.discs), std::sqrt(12.0) * stopped / distance, 1e-9);
}

TEST(DiscContacts, CurvedWallsRepelFromTheirNearestPointWhereTheyHaveMoved) {
    Scene scene = dry(flat_channel(20), {{0.2, 0.7}});
    scene.walls[0] = {"floor", CosineShape{0.3, 0.1, 1, 0}, FluidSide::above, {0.5, 0}};
    Region region(scene);
    Particles particles = arrange(scene);
    particles.time = 0.4;
    const NearestPoint nearest = region.walls()[0].nearest({0.1, 0.5});
    const Vector centre = nearest.position + (radius + 0.005) * nearest.normal;
    particles.discs[0].position = centre + Vector(0.2, 0);
    DiscContacts(scene, region).compute(particles);
    EXPECT_LT((particles.discs[0].contact_force - 0.5 * nearest.normal).norm(), 1e-3);
}

TEST(DiscContacts, ACollisionTurnsDiscsBackWithTheirEnergyAndMomentum) {
    Scene scene = dry(doubly_periodic(20), {{0.0, 0.7}, {0.45, 0.72}});
    scene.contact = {distance, 0, 1};
    scene.discs[0].velocity = {1, 0};
    Flow flow(scene);
    const double step = 0.04 * 2 * std::numbers::pi / flow.contacts.highest_frequency(flow.particles.discs);
    const auto energy = [&] {
        return flow.particles.discs[0].velocity.squaredNorm() +
               flow.particles.discs[1].velocity.squaredNorm();
    };
    flow.run(static_cast<int>(0.6 / step), step);
    EXPECT_LT(flow.particles.discs[0].velocity.x(), 0.1);
    EXPECT_GT(flow.particles.discs[1].velocity.x(), 0.9);
    EXPECT_NEAR(energy(), 1, 2e-3);
    const Vector momentum = flow.particles.discs[0].velocity + flow.particles.discs[1].velocity;
    EXPECT_LT((momentum - Vector(1, 0)).norm(), 1e-13);
    EXPECT_GT(flow.contacts.least_gap(), 0);
    EXPECT_GT(flow.contacts.first_contact_time(), 0.2);
}

TEST(DiscContacts, TooDeepAnOverlapStopsTheRunAndSaysWhere) {
    Scene scene = dry(doubly_periodic(20), {{0.0, 0.7}, {0.4, 0.7}});
    scene.contact = {distance, 1e-3, 1}; // far too soft
    scene.discs[0].velocity = {1, 0};
    Flow flow(scene);
    try {
        flow.run(400, 0.001);
        FAIL() << "no error";
    } catch (const RunError& error) {
        const std::string message = error.what();
        for (const char* part :
             {"disc 'disc0'", "overlaps disc 'disc1'", "contact.force_scale", "time 0.2"}) {
            EXPECT_NE(message.find(part), std::string::npos) << message;
        }
    }
}

} // namespace
} // namespace slurry::testing
