// Shapes that the domain holds too little of.
#include "solver/scene/wall_checks.hpp"

#include "tests/solver/scene/scene_folder.hpp"

namespace slurry::test {
namespace {

using Words = std::vector<std::string>;

class WallShapes : public SceneFolder {
  protected:
    [[nodiscard]] std::string warning(const Words& changes) const {
        const Words warnings = read(full_scene, changes).warnings;
        EXPECT_LE(warnings.size(), 1U);
        return warnings.empty() ? "" : warnings.front();
    }
};

// full_scene is 4 m wide and not periodic.
TEST_F(WallShapes, OfTheUsualWidthAreNotWarnedOf) {
    for (const char* usual : {"walls.random.correlation_length=0.8", "walls.gaussian.width=4"}) {
        EXPECT_EQ(warning({usual}), "");
    }
    EXPECT_EQ(warning({"domain.periodic=x", "walls.gaussian.width=1"}), "");
}

TEST_F(WallShapes, OfWhichLittleIsLeftAreWarnedOf) {
    EXPECT_EQ(warning({"walls.random.correlation_length=0.81"}),
              "--set walls.random.correlation_length=0.81: found walls.random.correlation_length = 0.81 (m), "
              "advised at most 0.8, a fifth of the domain's width: the longer it is, the more the profile is "
              "one cosine");
    EXPECT_EQ(warning({"walls.gaussian.width=4.1"}),
              "--set walls.gaussian.width=4.1: found walls.gaussian.width = 4.1 (m), advised at most 4, the "
              "domain's width: a wider bump is all but flat in it");
    EXPECT_EQ(warning({"domain.periodic=x", "walls.gaussian.width=1.1"}),
              "--set walls.gaussian.width=1.1: found walls.gaussian.width = 1.1 (m), advised at most 1, a "
              "quarter of the periodic domain's width: a wider bump is cut off, with a kink where the domain "
              "repeats");
}

TEST_F(WallShapes, OfWhichNothingIsLeftAreRefused) {
    EXPECT_EQ(
        refusal(full_scene, {"walls.random.correlation_length=4.1"}),
        "--set walls.random.correlation_length=4.1: found walls.random.correlation_length = 4.1, allowed "
        "at most 4 (m), the domain's width: a longer one leaves one cosine, and nothing random but its "
        "place");
    EXPECT_EQ(refusal(full_scene, {"domain.periodic=x", "walls.gaussian.width=4.1"}),
              "--set walls.gaussian.width=4.1: found walls.gaussian.width = 4.1, allowed at most 4 (m), the "
              "width of the periodic domain: a wider bump is flat in it");
}

} // namespace
} // namespace slurry::test
