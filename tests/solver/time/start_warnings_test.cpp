// What a run accepts, but says.
#include "solver/time/start_warnings.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

using Words = std::vector<std::string>;

// A channel from y = 0.2 m to 1.2 m in x from -0.3 to 0.7 m, 20 spacings of 0.05 m high.
Scene channel() {
    Scene scene = flat_channel(20, 1);
    scene.path = "scene.toml";
    scene.output.end_time = 1;
    scene.output.series_samples = 5;
    return scene;
}

Words warnings_of(const Scene& scene) {
    return start_warnings(scene, Region(scene));
}

Scene with_hill(const Vector& velocity) {
    Scene scene = channel();
    scene.walls[0].shape = GaussianShape{0.2, 0.4, 0.2, 0.15};
    scene.walls[0].velocity = velocity;
    return scene;
}

TEST(StartWarnings, AreNoneOfAProbeInTheFluid) {
    Scene scene = with_hill({0, 0});
    scene.probes = {{"above", PointProbe{{0.2, 0.65}}}, {"floor", WallProbe{"floor", 7}}};
    EXPECT_EQ(warnings_of(scene), Words{});
}

TEST(StartWarnings, NameTheWallThatAPointProbeIsBehind) {
    Scene scene = with_hill({0, 0});
    scene.probes = {{"above", PointProbe{{0.2, 0.65}}}, {"inside", PointProbe{{0.2, 0.5}}}};
    EXPECT_EQ(warnings_of(scene),
              Words{"scene.toml: probe 'inside' at (0.2, 0.5) m is behind wall 'floor' at "
                    "the start: its samples will be NaN; move it into the fluid"});
}

TEST(StartWarnings, SayWhenAMovingWallFreesTheProbe) {
    Scene scene = with_hill({0.5, 0});
    scene.walls[1].velocity = {0, 0};
    scene.probes = {{"inside", PointProbe{{0.2, 0.5}}}};
    EXPECT_EQ(warnings_of(scene),
              Words{"scene.toml: probe 'inside' at (0.2, 0.5) m is behind wall 'floor' at "
                    "the start: its samples will be NaN until 0.25 s"});
}

TEST(StartWarnings, AreOfThinFilmsBetweenDiscsAndWalls) {
    Scene scene = channel();
    DiscScene disc = middle_disc();
    const auto with = [&](double radius, double y) {
        disc.placement = SingleDisc{radius, {0.2, y}};
        scene.discs = {disc};
        return warnings_of(scene);
    };
    const auto warning = [](const std::string& wall, const std::string& film, const std::string& spacing) {
        return "scene.toml: the film between disc 'disc' and wall '" + wall + "' is " + film +
               " particle spacings: advised 3 or more, so " + spacing +
               "a disc that is smaller or farther from the wall";
    };
    EXPECT_EQ(with(0.2, 0.45), Words{}) << "a spacing from one wall";
    EXPECT_EQ(with(0.2, 0.425), Words{warning("floor", "0.025 m at the start, 0.5",
                                              "particle_spacing of at most 0.008333 m, or ")});
    EXPECT_EQ(with(0.2, 0.4), Words{warning("floor", "0 m at the start, 0", "")});
    EXPECT_EQ(with(0.35, 0.7), Words{}) << "3 spacings on both sides";
    const std::string advice = "particle_spacing of at most 0.03333 m, or ";
    EXPECT_EQ(with(0.4, 0.7), (Words{warning("floor", "0.1 m at the start, 2", advice),
                                     warning("lid", "0.1 m at the start, 2", advice)}));
    scene.start.arrangement = Arrangement::empty;
    EXPECT_EQ(with(0.4, 0.7), Words{}) << "there is no film without fluid";
}

TEST(StartWarnings, AreNoneOfDiscsAtRandomPlaces) {
    Scene scene = channel();
    DiscScene discs = middle_disc();
    RandomDiscs random;
    random.count = 3;
    random.radius = 0.1;
    random.least_distance = 0.01;
    discs.placement = random;
    scene.discs = {discs};
    EXPECT_EQ(warnings_of(scene), Words{});
}

} // namespace
} // namespace slurry::testing
