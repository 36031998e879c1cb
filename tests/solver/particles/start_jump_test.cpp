// A rough wall that jumps to full speed compresses the fluid before its flanks.
#include "solver/particles/start_jump.hpp"

#include "tests/solver/geometry/scenes.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

// The paper's rough channel, the pad at 1 m/s in place of the wafer.
Scene pad_jumps(double sound_speed) {
    Scene scene = rough_channel(1e-6);
    scene.path = "channel.toml";
    scene.numerics.sound_speed = sound_speed;
    scene.walls[0].velocity = {0, 0};
    scene.walls[1].velocity = {-1, 0};
    return scene;
}

Scene without_impulse(Scene scene) {
    scene.start.impulse = false;
    return scene;
}

std::vector<std::string> warnings_of(const Scene& scene) {
    return start_jump_warnings(scene, Region(scene));
}

// Of the steepest point of the cosine, whose slope is pi / 3.
const double steepest_normal = std::sin(std::atan(std::numbers::pi / 3));

TEST(StartJump, IsTheLargestSpeedAcrossTheWall) {
    const Scene scene = pad_jumps(10);
    const StartJump jump = largest_jump_across(scene, Region(scene).walls());
    EXPECT_EQ(jump.wall, "pad");
    EXPECT_NEAR(jump.speed, steepest_normal, 1e-5);
}

TEST(StartJump, IsNoneOfAFlatWallThatSlidesAlongItself) {
    const Scene scene = rough_channel(1e-6);
    EXPECT_EQ(largest_jump_across(scene, Region(scene).walls()).speed, 0);
}

TEST(StartJump, IsAgainstTheFluidAsItStarts) {
    Scene scene = rough_channel(1e-6);
    scene.start.velocity = InitialVelocity::shear;
    scene.start.speed = 1;
    const StartJump jump = largest_jump_across(scene, Region(scene).walls());
    EXPECT_EQ(jump.wall, "pad");
    // The largest of y / 15 um times the normal's x, for y = 5 um (1 - cos t) and a slope of pi / 3 sin t.
    EXPECT_NEAR(jump.speed, 0.342825, 1e-5);
}

TEST(StartJump, IsWarnedOfBeyondWhatEveryRunSurvived) {
    const double boundary = steepest_normal / 0.055;
    EXPECT_TRUE(warnings_of(without_impulse(pad_jumps(1.001 * boundary))).empty());
    const auto warnings = warnings_of(without_impulse(pad_jumps(0.999 * boundary)));
    ASSERT_EQ(warnings.size(), 1U);
    for (const char* part :
         {"channel.toml: the wall 'pad' starts at once at 0.7232 m/s across its surface",
          "0.0551 of numerics.sound_speed", "at most 0.055", "raise numerics.sound_speed to 24.11",
          "or let it stand and set walls.wafer.velocity=[1, 0], which ends in the same flow"}) {
        EXPECT_NE(warnings[0].find(part), std::string::npos) << part << "\nis not in\n" << warnings[0];
    }
    EXPECT_EQ(warnings[0].find('\n'), std::string::npos);
}

TEST(StartJump, IsTheFluidsSpeedPastTheWallWithTheImpulse) {
    const Scene scene = pad_jumps(10);
    const StartJump jump = start_jump(scene, Region(scene));
    EXPECT_TRUE(jump.impulse);
    EXPECT_EQ(jump.wall, "pad");
    // A plug through the gap of 5 um of a channel that is 10 um high on average would pass the crest at 2
    // m/s.
    EXPECT_GT(jump.speed, 1.5);
    EXPECT_LT(jump.speed, 2.5);
    const double boundary = jump.speed / 0.38;
    EXPECT_TRUE(warnings_of(pad_jumps(1.001 * boundary)).empty());
    const auto warnings = warnings_of(pad_jumps(0.999 * boundary));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("and the fluid passes it at"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find(fmt::format("raise numerics.sound_speed to {:.4g}", jump.speed / 0.3)),
              std::string::npos)
        << warnings[0];
}

TEST(StartJump, IsNotWarnedOfWithoutFluidOrWhenTheFlatWallMoves) {
    Scene scene = without_impulse(pad_jumps(10));
    EXPECT_FALSE(warnings_of(scene).empty());
    scene.start.arrangement = Arrangement::empty;
    EXPECT_TRUE(warnings_of(scene).empty());
    Scene wafer_moves = rough_channel(1e-6);
    wafer_moves.numerics.sound_speed = 2;
    EXPECT_TRUE(warnings_of(wafer_moves).empty());
}

TEST(StartJump, HasNoFlatWallToMoveInsteadOppositeAnotherRoughOneOrBesideADiscThatIsHeld) {
    Scene rough = without_impulse(pad_jumps(10));
    rough.walls[0].shape = CosineShape{1.4e-5, 1e-6, 3e-5, 0};
    Scene held = without_impulse(pad_jumps(10));
    held.discs.emplace_back();
    held.discs[0].motion = DiscMotion::fixed;
    for (const Scene& scene : {rough, held}) {
        const auto warnings = warnings_of(scene);
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_TRUE(warnings[0].ends_with("raise numerics.sound_speed to 24.11")) << warnings[0];
    }
}

} // namespace
} // namespace slurry::testing
