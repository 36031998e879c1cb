#include "tests/solver/scene/scene_folder.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slurry::test {
namespace {

using ReadScene = SceneFolder;

TEST_F(ReadScene, FillsTheScene) {
    const Scene scene = read(replaced(full_scene, "upper = [4, 4]", "upper = [4, 4]\nperiodic = \"x\""));
    EXPECT_EQ(scene.domain.upper, Vector(4, 4));
    EXPECT_EQ(scene.domain.periodic, (std::array<bool, 2>{true, false}));
    EXPECT_EQ(scene.fluid.density, 1000);
    EXPECT_EQ(scene.numerics.density_diffusion, 0.2);
    EXPECT_EQ(scene.start.velocity, InitialVelocity::shear);
    ASSERT_EQ(scene.walls.size(), 7U);
    EXPECT_EQ(std::get<LineShape>(scene.walls[0].shape).to, Vector(4, 4));
    EXPECT_EQ(scene.walls[0].fluid_side, FluidSide::below);
    EXPECT_EQ(std::get<CosineShape>(scene.walls[1].shape).amplitude, -0.1);
    EXPECT_TRUE(std::get<ArcShape>(scene.walls[3].shape).upward);
    const auto& profile = std::get<ProfileShape>(scene.walls[5].shape);
    EXPECT_EQ(profile.file, path("profile.csv"));
    ASSERT_EQ(profile.points.size(), 3U);
    EXPECT_EQ(profile.points[1], Vector(2, 0.2));
    EXPECT_EQ(std::get<GridProbe>(scene.probes[2].kind).points, (std::array<int, 2>{3, 4}));
    EXPECT_EQ(scene.output.snapshot_times.size(), 0U);
    EXPECT_EQ(scene.path, path("scene.toml"));
}

TEST_F(ReadScene, ReadsAxesAsNamed) {
    const auto periodic = [&](const std::string& axes) {
        return read(full_scene, {"domain.periodic=" + axes}).domain.periodic;
    };
    EXPECT_EQ(periodic("none"), (std::array<bool, 2>{false, false}));
    EXPECT_EQ(periodic("x"), (std::array<bool, 2>{true, false}));
    EXPECT_EQ(periodic("y"), (std::array<bool, 2>{false, true}));
    EXPECT_EQ(periodic("xy"), (std::array<bool, 2>{true, true}));
}

TEST_F(ReadScene, ReadsTheNeighbourSearchAsNamed) {
    EXPECT_EQ(read(full_scene).numerics.neighbour_search, NeighbourSearch::strips);
    EXPECT_EQ(read(full_scene, {"numerics.neighbour_search=cells"}).numerics.neighbour_search,
              NeighbourSearch::cells);
    EXPECT_EQ(read(full_scene, {"numerics.neighbour_search=plane_sweep"}).numerics.neighbour_search,
              NeighbourSearch::plane_sweep);
    EXPECT_NE(
        refusal(replaced(full_scene, "sound_speed = 10", "sound_speed = 10\nneighbour_search = \"tree\""))
            .find("allowed one of \"strips\", \"cells\", \"plane_sweep\""),
        std::string::npos);
}

TEST_F(ReadScene, TakesTheSchemesDefaultsUnlessSaid) {
    const Numerics paper = read(full_scene, {"scene.scheme=wang2014"}).numerics;
    EXPECT_EQ(paper.density_diffusion, 0);
    EXPECT_EQ(paper.wall_dummies, DummyLayout::lattice);
    const Numerics mixed =
        read(full_scene, {"scene.scheme=wang2014", "numerics.density_diffusion=0.2"}).numerics;
    EXPECT_EQ(mixed.density_diffusion, 0.2);
    EXPECT_EQ(mixed.wall_dummies, DummyLayout::lattice);
}

TEST_F(ReadScene, ResolvedTextReadsBackAsTheSameScene) {
    const std::vector<std::string> overrides{"scene.title=\"a \\\"quoted\\\" \\\\ title, \u00b5m\"",
                                             "scene.scheme=wang2014",
                                             "start.seed=9223372036854775807",
                                             "numerics.particle_spacing=0.1000000000000000055",
                                             "output.snapshot_times=[0, 1e-300, 0.1, 1]",
                                             "fluid.density=1e22",
                                             "walls.line.velocity=[-0.0, 1e-320]"};
    const Scene first = read(full_scene, overrides);
    const Scene second = read(first.resolved_text);
    EXPECT_EQ(first.resolved_text, second.resolved_text);
    EXPECT_EQ(second.title, "a \"quoted\" \\ title, \u00b5m");
    EXPECT_EQ(second.start.seed, std::uint64_t{std::numeric_limits<std::int64_t>::max()});
    EXPECT_EQ(second.output.snapshot_times, (std::vector<double>{0, 1e-300, 0.1, 1}));
    EXPECT_EQ(second.walls[0].velocity.y(), 1e-320);
    EXPECT_TRUE(std::signbit(second.walls[0].velocity.x()));
    EXPECT_EQ(second.numerics.wall_dummies, DummyLayout::lattice);
    EXPECT_EQ(std::get<ProfileShape>(second.walls[5].shape).points,
              std::get<ProfileShape>(first.walls[5].shape).points);
}

TEST_F(ReadScene, SaysWhereAndWhatIsAllowed) {
    EXPECT_EQ(refusal(replaced(full_scene, "density", "densty")),
              "scene.toml:6:1: found the unknown key densty in [fluid], allowed density, dynamic_viscosity, "
              "body_force, gravity, hydrostatics, nearest known key fluid.density");
    EXPECT_EQ(refusal(replaced(full_scene, "sound_speed = 10", "sound_speed = \"10\"")),
              "scene.toml:11:15: found numerics.sound_speed = the string \"10\", allowed a number > 0 (m/s)");
    EXPECT_EQ(
        refusal(replaced(full_scene, "particle_spacing = 0.1", "particle_spacing = -1e-7")),
        "scene.toml:10:20: found numerics.particle_spacing = the number -1e-07, allowed a number > 0 (m)");
    EXPECT_EQ(refusal(replaced(full_scene, "density = 1000\n", "")),
              "scene.toml:5:1: found no fluid.density, allowed a number > 0 (kg/m3): it has no default");
    EXPECT_EQ(
        refusal(replaced(full_scene, "\"cosine\"\nfluid", "\"cosin\"\nfluid")),
        "scene.toml:26:9: found walls.shape = the string \"cosin\", allowed one of \"line\", \"cosine\", "
        "\"gaussian\", \"arc\", \"sine\", \"profile\", \"random\", nearest known key cosine");
    EXPECT_EQ(
        refusal(replaced(full_scene, "[fluid]", "[fluids]")),
        "scene.toml:5:2: found the unknown table [fluids], allowed scene, domain, fluid, numerics, start, "
        "walls, discs, contact, probes, output, nearest known key fluid");
}

TEST_F(ReadScene, GivesThePathOfADistantFileWhole) {
    const std::string name = std::string(120, 'a') + "\x01.toml";
    write(name, "walls = 3");
    try {
        (void)read_scene(path(name));
        FAIL() << "accepted";
    } catch (const SceneError& error) {
        const std::string shown = path(std::string(120, 'a') + "?.toml").string();
        EXPECT_TRUE(std::string(error.what()).starts_with(shown + ":1:1: found walls")) << error.what();
    }
}

TEST_F(ReadScene, PointsToTheTableThatHasTheKey) {
    EXPECT_TRUE(refusal(replaced(full_scene, "density = 1000", "sound_speed = 3"))
                    .ends_with("nearest known key numerics.sound_speed"));
    EXPECT_TRUE(refusal(replaced(full_scene, "wavelength = 4", "radius = 4"))
                    .ends_with("nearest known key walls.radius of shape = \"arc\""));
}

// A part of full_scene, what replaces it, and what the refusal must contain.
struct Fault {
    std::string part, by, message;
};

void PrintTo(const Fault& fault, std::ostream* stream) {
    *stream << fault.by;
}

class ContradictoryScene : public SceneFolder, public ::testing::WithParamInterface<Fault> {};

TEST_P(ContradictoryScene, IsRefused) {
    const std::string message = refusal(replaced(full_scene, GetParam().part, GetParam().by));
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Checks, ContradictoryScene,
    ::testing::Values(
        Fault{"upper = [4, 4]", "upper = [4, 0]", "scene.toml:3:9: found domain.upper = [4, 0]"},
        Fault{"upper = [4, 4]", "upper = [-4, 4]", "allowed lower < upper in x and in y"},
        Fault{"spacing = 0.1", "spacing = 1e-4",
              "scene.toml:10:20: found numerics.particle_spacing = 0.0001, about "
              "1.6e+09 particles, allowed a spacing of 0.0008945 (m) or more, particles at most 2e+07; "
              "--limit particles=1.6e+09 would allow it"},
        Fault{"spacing = 0.1", "spacing = 1e-320", "about inf particles"},
        Fault{"upper = [4, 4]", "upper = [1e308, 1e308]", "about inf particles"},
        Fault{"spacing = 0.1", "spacing = 2", "3 particles across the domain"},
        Fault{"name = \"cosine\"", "name = \"line\"",
              "scene.toml:25:8: found the name \"line\" twice in [[walls]]"},
        Fault{"name = \"grid\"", "name = \"point\"", "found the name \"point\" twice in [[probes]]"},
        Fault{"wall = \"cosine\"", "wall = \"cosin\"", "found the unknown wall \"cosin\""},
        Fault{"wall = \"cosine\"", "wall = \"cosin\"", "nearest known key cosine"},
        Fault{"position = [0.5, 0.75]", "position = [5, 0.75]", "[0, 0] to [4, 4], the domain"},
        Fault{"to = [4, 4]", "to = [0, 4]", "two different ends"},
        Fault{"fluid_side = \"below\"", "fluid_side = \"left\"",
              "\"above\" or \"below\" of what is no vertical"},
        Fault{"to = [4, 4]", "to = [0, 5]", "\"left\" or \"right\" of a vertical line"},
        Fault{"\nspeed = 1", "\nspeed = 0", "0 only with start.velocity = \"rest\""},
        Fault{"velocity = \"shear\"", "velocity = \"rest\"", "scene.toml:15:9: found start.speed = 1"},
        Fault{"end_time = 1", "end_time = 1\nsnapshot_times = [0.5, 2]",
              "found 2 after 0.5, allowed ascending times"},
        Fault{"end_time = 1", "end_time = 1\nsnapshot_times = [0.5, 0.5]", "found 0.5 after 0.5"},
        Fault{"end_time = 1", "end_time = 0", "allowed a number > 0 (s)"},
        Fault{"points = [3, 4]", "points = [9999, 9999]",
              "found 3e+09 probe values, points times samples of all probes, allowed at most 1e+08; --limit "
              "probe_values="},
        Fault{"end_time = 1", "end_time = 1e999", "scene.toml:82:17: found no TOML"},
        Fault{"[[walls]]", "[walls]", "cannot redefine"},
        Fault{"[output]", "[[output]]", "found output = an array of 1, allowed one table [output]"},
        Fault{"[fluid]", "\"a\\nb\" = 3\n[fluid]", "the unknown key a?b in [domain]"},
        Fault{"density = 1000", "density = 1000\ndensity = 1000", "scene.toml:7:"}));

TEST_F(ReadScene, RefusesWhatIsNoSceneFile) {
    EXPECT_THROW((void)read_scene(path("none.toml")), SceneError);
    EXPECT_THROW((void)read_scene(path("")), SceneError);
    EXPECT_THROW((void)read_scene("/dev/zero"), SceneError);
    EXPECT_NE(refusal("").find("scene.toml:1:1: found no domain.lower"), std::string::npos);
    EXPECT_EQ(refusal("walls = 3"), "scene.toml:1:1: found walls = the integer 3, allowed tables [[walls]]");
    EXPECT_EQ(refusal("walls = [3]"),
              "scene.toml:1:1: found walls = an array of 1, allowed tables [[walls]]");
    EXPECT_NE(refusal("\xff\xfe").find("scene.toml:1:1: found a character beyond ASCII"), std::string::npos);
    EXPECT_NE(refusal(std::string(1U << 20U, ' ') + full_scene).find("allowed at most 1048576"),
              std::string::npos);
}

// Each of these aborts toml++ 3.3 or is undefined behaviour in it.
TEST_F(ReadScene, SurvivesWhatTheParserDoesNot) {
    EXPECT_TRUE(refusal("[.a]").starts_with("scene.toml:1:2: found no TOML"));
    EXPECT_TRUE(refusal("[fluid]\n\u00e9 = 1").starts_with("scene.toml:2:1: found a character beyond ASCII"));
    EXPECT_TRUE(
        refusal("title = \"\u00e9\" \u00e9").starts_with("scene.toml:1:14: found a character beyond"));
    EXPECT_TRUE(
        refusal("a = \"\"\"x\"y\"\"\" \u00e9").starts_with("scene.toml:1:5: found a string of several"));
    EXPECT_TRUE(refusal("# \u00e9 \"\n" + full_scene).starts_with("ACCEPTED"));
    EXPECT_TRUE(refusal("\xEF\xBB\xBF" + full_scene).starts_with("ACCEPTED"));
}

TEST_F(ReadScene, SurvivesDeepNesting) {
    std::string dotted = "a";
    for (int level = 1; level < 100'000; ++level) {
        dotted += ".a";
    }
    EXPECT_FALSE(refusal(dotted + " = 1").starts_with("ACCEPTED"));
    EXPECT_FALSE(refusal("[" + dotted + "]").starts_with("ACCEPTED"));
    EXPECT_FALSE(refusal("a = " + std::string(100'000, '[')).starts_with("ACCEPTED"));
    EXPECT_FALSE(refusal(full_scene, {"fluid.density={" + dotted + "=1}"}).starts_with("ACCEPTED"));
}

} // namespace
} // namespace slurry::test
