// Rough walls that start at once give the fluid a potential flow.
#include "solver/particles/wall_impulse.hpp"

#include "solver/particles/arrangement.hpp"
#include "solver/scene/start_velocity.hpp"
#include "tests/solver/geometry/scenes.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace slurry::testing {
namespace {

constexpr double pad_speed = 2;

Scene filled(Scene scene) {
    scene.fluid = {1000, 1e-3, Vector::Zero()};
    scene.numerics.sound_speed = 10;
    return scene;
}

// Waves of a height on a pad that moves beneath a flat lid; all lengths in wavelengths.
Scene wavy_pad(double height, double spacing) {
    return filled(
        make_scene(make_domain({0, -0.1}, {1, 0.5}, true),
                   {make_wall("lid", LineShape{{0, 0.5}, {1, 0.5}}, FluidSide::below),
                    make_wall("pad", CosineShape{0, height, 1, 0}, FluidSide::above, {pad_speed, 0})},
                   spacing));
}

Disc disc_at(const Vector& position, DiscMotion motion) {
    Disc disc;
    disc.motion = motion;
    disc.radius = 0.1;
    disc.mass = 1000 * disc.area();
    disc.position = position;
    return disc;
}

TEST(WallImpulse, OfALowWaveIsThatOfLinearTheory) {
    constexpr double height = 0.002;
    constexpr double wave_number = 2 * std::numbers::pi;
    const Scene scene = wavy_pad(height, 0.02);
    const WallImpulse impulse(scene, Region(scene), {});
    const double scale = pad_speed * height * wave_number / std::sinh(wave_number * 0.5);
    for (const Vector& place :
         {Vector(0.3, 0.05), Vector(0.11, 0.21), Vector(0.83, 0.32), Vector(0.57, 0.4)}) {
        const double phase = wave_number * place.x();
        const double depth = wave_number * (0.5 - place.y());
        const Vector expected =
            scale * Vector(-std::cosh(depth) * std::cos(phase), std::sinh(depth) * std::sin(phase));
        EXPECT_LT((impulse.velocity(place) - expected).norm(), 0.02 * scale * std::cosh(wave_number * 0.5));
    }
}

// The largest speed across the wall that the fluid lacks, or has too much of, at points of the wall.
double largest_miss(double spacing) {
    const Scene scene = wavy_pad(0.1, spacing);
    const Region region(scene);
    const WallImpulse impulse(scene, region, {});
    double largest = 0;
    for (const WallPoint& point : region.walls()[1].sample(57)) {
        const Vector past =
            impulse.velocity(point.position + 0.25 * spacing * point.normal) - Vector(pad_speed, 0);
        largest = std::max(largest, std::abs(past.dot(point.normal)));
    }
    return largest;
}

TEST(WallImpulse, LetsNothingThroughASteepWall) {
    EXPECT_LT(largest_miss(0.02), 0.15 * pad_speed);
    EXPECT_LT(largest_miss(0.005), 0.4 * largest_miss(0.02));
}

// Of the start with the impulse, m2/s, as seen from the pad: through the faces of the cells between the
// height `from` of the pad at x, a place between two columns of cells, and the lid.
double flux_past_the_pad(const Scene& scene, double x, double from) {
    const WallImpulse impulse(scene, Region(scene), {});
    const double spacing = scene.numerics.particle_spacing;
    double sum = 0;
    for (double y = from + spacing / 2; y < 0.5; y += spacing) {
        sum += (start_velocity(scene, {x, y}) + impulse.velocity({x, y}) - scene.walls[1].velocity).x();
    }
    return sum * spacing;
}

void expect_as_much_over_crests_as_over_troughs(const Scene& scene) {
    const double over_troughs = flux_past_the_pad(scene, 0.5, -0.1);
    EXPECT_GT(std::abs(over_troughs), 0.1 * pad_speed);
    EXPECT_NEAR(flux_past_the_pad(scene, 0, 0.1) / over_troughs, 1, 1e-5);
    EXPECT_NEAR(flux_past_the_pad(scene, 0.25, 0) / over_troughs, 1, 1e-5);
}

TEST(WallImpulse, BringsAsMuchFluidThroughTheGapAsTheWallLeavesBehind) {
    expect_as_much_over_crests_as_over_troughs(wavy_pad(0.1, 0.01));
}

TEST(WallImpulse, LeadsAFlowOverWavesThatRest) {
    Scene scene = wavy_pad(0.1, 0.01);
    scene.walls[0].velocity = {pad_speed, 0};
    scene.walls[1].velocity = {0, 0};
    scene.start.velocity = InitialVelocity::shear;
    scene.start.speed = pad_speed;
    expect_as_much_over_crests_as_over_troughs(scene);
}

TEST(WallImpulse, FlowsAroundAHeldDisc) {
    const Scene scene = wavy_pad(0.1, 0.01);
    const Disc disc = disc_at({0.3, 0.3}, DiscMotion::fixed);
    const WallImpulse impulse(scene, Region(scene), {&disc, 1});
    const WallImpulse free(scene, Region(scene), {});
    double around = 0;
    double through = 0;
    for (int k = 0; k < 24; ++k) {
        const double angle = 2 * std::numbers::pi * k / 24;
        const Vector normal(std::cos(angle), std::sin(angle));
        const Vector place = disc.position + (disc.radius + 0.0025) * normal;
        around = std::max(around, std::abs(impulse.velocity(place).dot(normal)));
        through = std::max(through, std::abs(free.velocity(place).dot(normal)));
    }
    EXPECT_LT(around, 0.15 * through);
}

TEST(WallImpulse, MovesAFreeDiscByItsDensity) {
    Scene scene = wavy_pad(0.1, 0.02);
    const Vector place(0.3, 0.3);
    DiscScene disc;
    disc.name = "disc";
    disc.placement = SingleDisc{0.1, place};
    disc.density = 3000;
    scene.discs = {disc};
    const Vector fluid = WallImpulse(scene, Region(scene), {}).velocity(place);
    const Particles particles = arrange_particles(scene, Region(scene));
    EXPECT_GT(fluid.norm(), 0.05 * pad_speed);
    EXPECT_LT((particles.discs[0].velocity - fluid / 2).norm(), 1e-12); // 2 / (1 + 3)
}

TEST(WallImpulse, IsNoneWhereItIsOffOrNothingJumpsOrNothingIsThere) {
    const auto none = [](const Scene& scene) { return WallImpulse(scene, Region(scene), {}).none(); };
    Scene scene = wavy_pad(0.1, 0.02);
    EXPECT_FALSE(none(scene));
    scene.start.impulse = false;
    EXPECT_TRUE(none(scene));
    scene = wavy_pad(0.1, 0.02);
    scene.start.arrangement = Arrangement::empty;
    EXPECT_TRUE(none(scene));
    scene = wavy_pad(0.1, 0.02);
    scene.walls[1].velocity = {0, 0};
    scene.walls[0].velocity = {pad_speed, 0};
    EXPECT_TRUE(none(scene));
    EXPECT_EQ(WallImpulse(scene, Region(scene), {}).velocity({0.5, 0.2}), Vector(0, 0));
}

} // namespace
} // namespace slurry::testing
