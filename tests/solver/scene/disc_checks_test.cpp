#include "solver/scene/disc_checks.hpp"

#include "tests/solver/scene/scene_folder.hpp"

#include <algorithm>

namespace slurry::test {
namespace {

using ReadDiscs = SceneFolder;
using Words = std::vector<std::string>;

TEST_F(ReadDiscs, FillsTheScene) {
    const Scene scene =
        read(full_scene,
             {"fluid.gravity=[0, -9.81]", "fluid.hydrostatics=full", "discs.single.motion=prescribed",
              "discs.single.velocity=[1, 0.5]", "discs.single.spin=-0.5", "discs.random.sizes=lognormal",
              "discs.random.spread=0.3", "discs.random.least_distance=0.25", "discs.random.seed=7",
              "contact.distance=0.2", "contact.force_scale=5", "contact.stiffness=1e-6"});
    EXPECT_EQ(scene.fluid.gravity, Vector(0, -9.81));
    EXPECT_EQ(scene.fluid.hydrostatics, Hydrostatics::full);
    ASSERT_EQ(scene.discs.size(), 2U);
    const auto& single = std::get<SingleDisc>(scene.discs[0].placement);
    EXPECT_EQ(scene.discs[0].name, "single");
    EXPECT_EQ(scene.discs[0].density, 1500);
    EXPECT_EQ(scene.discs[0].motion, DiscMotion::prescribed);
    EXPECT_EQ(scene.discs[0].velocity, Vector(1, 0.5));
    EXPECT_EQ(scene.discs[0].spin, -0.5);
    EXPECT_EQ(single.radius, 0.4);
    EXPECT_EQ(single.position, Vector(1, 2));
    const auto& random = std::get<RandomDiscs>(scene.discs[1].placement);
    EXPECT_EQ(random.count, 3);
    EXPECT_EQ(random.sizes, SizeDistribution::lognormal);
    EXPECT_EQ(random.radius, 0.4);
    EXPECT_EQ(random.spread, 0.3);
    EXPECT_EQ(random.least_distance, 0.25);
    EXPECT_EQ(random.seed, 7U);
    EXPECT_EQ(scene.contact.distance, 0.2);
    EXPECT_EQ(scene.contact.force_scale, 5);
    EXPECT_EQ(scene.contact.stiffness, 1e-6);
}

TEST_F(ReadDiscs, AreLeftOutOfScenesWithoutThem) {
    const Scene scene = read(full_scene.substr(0, full_scene.find("[[discs]]")));
    EXPECT_TRUE(scene.discs.empty());
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.contact.distance, 0);
    EXPECT_EQ(scene.contact.stiffness, 1);
    EXPECT_EQ(scene.fluid.gravity, Vector(0, 0));
    EXPECT_EQ(scene.fluid.hydrostatics, Hydrostatics::buoyancy);
}

TEST_F(ReadDiscs, HaveTheirParticlesOnALatticeOrOnRings) {
    EXPECT_EQ(read(full_scene).numerics.disc_dummies, DiscDummies::adapted);
    EXPECT_EQ(read(full_scene, {"scene.scheme=wang2014"}).numerics.disc_dummies, DiscDummies::lattice);
    EXPECT_EQ(read(full_scene, {"numerics.disc_dummies=rings"}).numerics.disc_dummies, DiscDummies::rings);
}

TEST_F(ReadDiscs, MayBeAloneWithoutFluid) {
    const Scene scene = read(full_scene, {"start.arrangement=empty", "start.velocity=rest", "start.speed=0"});
    EXPECT_EQ(scene.start.arrangement, Arrangement::empty);
}

TEST_F(ReadDiscs, TakeRadiiFromAFile) {
    const Words from_file{"discs.random.sizes=file", "discs.random.radius=0", "discs.random.file=radii.csv"};
    const auto radii = [&](const std::string& csv) {
        write("radii.csv", csv);
        const Scene scene = read(full_scene, from_file);
        EXPECT_EQ(std::get<RandomDiscs>(scene.discs[1].placement).file, path("radii.csv"));
        return std::get<RandomDiscs>(scene.discs[1].placement).radii;
    };
    const auto refused = [&](const std::string& csv) {
        write("radii.csv", csv);
        return refusal(full_scene, from_file);
    };
    EXPECT_EQ(radii("# radius, m\r\n0.5 # first\r\n\r\n4e-1"), (std::vector<double>{0.5, 0.4}));
    EXPECT_EQ(refused("0.5\n0\n"), "radii.csv:2: found the radius 0, allowed a number > 0 (m)");
    EXPECT_EQ(
        refused("0.5\n0.4, 0.3\n"),
        "radii.csv:2: found \"0.4, 0.3\", allowed one finite number, a radius (m), or # before a comment");
    EXPECT_TRUE(refused("nan\n").starts_with("radii.csv:1: found \"nan\""));
    EXPECT_EQ(refused("# none\n"),
              "--set discs.random.file=radii.csv: found radii.csv without radii, allowed at least one");
    EXPECT_NE(refused("0.5\n0.14\n")
                  .find("--set discs.random.file=radii.csv: found a disc \"random\" of radius "
                        "0.14 (m), 2.8 particle spacings across"),
              std::string::npos);
}

TEST_F(ReadDiscs, ResolvedTextReadsBackAsTheSameScene) {
    const Scene first = read(full_scene, {"discs.random.sizes=file", "discs.random.radius=0",
                                          "discs.random.file=radii.csv", "fluid.gravity=[0.5, -1]"});
    const Scene second = read(first.resolved_text);
    EXPECT_EQ(first.resolved_text, second.resolved_text);
    EXPECT_EQ(std::get<RandomDiscs>(second.discs[1].placement).radii, (std::vector<double>{0.4, 0.5}));
}

TEST_F(ReadDiscs, OfFewSpacingsAcrossAreWarnedOf) {
    EXPECT_TRUE(read(full_scene).warnings.empty());
    EXPECT_TRUE(read(full_scene, {"discs.single.radius=0.3"}).warnings.empty());
    const Words warnings = read(full_scene, {"discs.single.radius=0.25"}).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0],
              "--set discs.single.radius=0.25: found a disc \"single\" of radius 0.25 (m), 5 particle "
              "spacings across, advised at least 6: a particle_spacing of at most 0.08333 (m)");
    EXPECT_TRUE(refusal(full_scene, {"discs.single.radius=0.15"}).starts_with("ACCEPTED"));
}

TEST_F(ReadDiscs, AreWarnedOfRepulsionThatReachesBeyondTheSmallest) {
    EXPECT_TRUE(read(full_scene, {"contact.distance=0.4"}).warnings.empty());
    const Words warnings = read(full_scene, {"discs.single.radius=0.3", "contact.distance=0.31"}).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(
        warnings[0],
        "--set contact.distance=0.31: found contact.distance = 0.31 (m), advised at most 0.3, the radius "
        "of the smallest disc: discs repel each other before they are near");
}

// Changes to full_scene, and what the refusal must contain.
struct Refusal {
    Words changes;
    std::string message;
};

void PrintTo(const Refusal& refusal, std::ostream* stream) {
    *stream << refusal.message;
}

class RefusedDiscs : public SceneFolder, public ::testing::WithParamInterface<Refusal> {};

TEST_P(RefusedDiscs, SayWhy) {
    const std::string message = refusal(full_scene, GetParam().changes);
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Checks, RefusedDiscs,
    ::testing::Values(
        Refusal{{"discs.single.name=random"}, "found the name \"random\" twice in [[discs]], allowed unique"},
        Refusal{{"discs.single.name=random_12"},
                "--set discs.single.name=random_12: found the name \"random_12\", allowed others: the random "
                "discs \"random\" are named random_1, random_2, ..."},
        Refusal{{"discs.random.name=random_1x", "discs.single.name=random_"}, "ACCEPTED"},
        Refusal{{"discs.random.count=100000"},
                "--set discs.random.count=100000: found 100001 discs, allowed at most 1e+05; "
                "--limit discs=1.01e+05 would allow it"},
        Refusal{{"discs.random.count=0"},
                "scene.toml:91:1: found count = 0, area_fraction = 0 and weight_fraction = 0 of the random "
                "discs \"random\", allowed exactly one of the three that is not 0"},
        Refusal{{"discs.random.area_fraction=0.1"}, "found count = 3, area_fraction = 0.1 and"},
        Refusal{{"discs.random.weight_fraction=0.1"}, "allowed exactly one of the three that is not 0"},
        Refusal{{"discs.random.count=0", "discs.random.weight_fraction=1"},
                "--set discs.random.weight_fraction=1: found discs.random.weight_fraction = 1, allowed less "
                "than 1: the rest is fluid"},
        Refusal{{"discs.random.count=0", "discs.random.weight_fraction=0.1", "start.arrangement=empty",
                 "start.velocity=rest", "start.speed=0"},
                "found discs.random.weight_fraction = 0.1 in a scene without fluid, allowed 0"},
        Refusal{
            {"discs.random.radius=0"},
            "--set discs.random.radius=0: found discs.random.radius = 0, allowed a number > 0 (m); 0 only "
            "with sizes = \"file\""},
        Refusal{{"discs.random.sizes=file", "discs.random.file=radii.csv"},
                "found discs.random.radius = 0.4, allowed 0 with sizes = \"file\""},
        Refusal{{"discs.random.sizes=file", "discs.random.radius=0"},
                "found discs.random.file = \"\", allowed the name of a CSV file"},
        Refusal{{"discs.random.file=radii.csv"}, "allowed \"\" unless sizes = \"file\""},
        Refusal{{"discs.random.spread=0.5"}, "allowed 0 unless sizes = \"uniform\" or \"lognormal\""},
        Refusal{{"discs.random.sizes=uniform"}, "allowed > 0 and < 1 with sizes = \"uniform\""},
        Refusal{{"discs.random.sizes=uniform", "discs.random.spread=1"},
                "--set discs.random.spread=1: found discs.random.spread = 1, allowed > 0 and < 1"},
        Refusal{{"discs.random.sizes=lognormal"}, "allowed > 0 with sizes = \"lognormal\""},
        Refusal{{"discs.single.radius=0"},
                "found discs.single.radius = the integer 0, allowed a number > 0 (m)"},
        Refusal{{"discs.single.density=-1"}, "allowed a number > 0 (kg/m3)"},
        Refusal{
            {"discs.single.radius=0.149"},
            "--set discs.single.radius=0.149: found a disc \"single\" of radius 0.149 (m), 2.98 particle "
            "spacings across, allowed at least 3: a larger radius, or a particle_spacing of at most 0.09933 "
            "(m)"},
        Refusal{{"discs.random.sizes=uniform", "discs.random.spread=0.7"},
                "found a disc \"random\" of radius 0.12 (m), 2.4 particle spacings across"},
        Refusal{{"numerics.smoothing_ratio=1.5", "discs.single.radius=0.22"},
                "--set numerics.smoothing_ratio=1.5: found numerics.smoothing_ratio = 1.5 with a disc "
                "\"single\" of "
                "radius 0.22 (m), 4.4 particle spacings across, allowed at most 1.467: fluid beside"},
        Refusal{{"numerics.smoothing_ratio=1.46", "discs.single.radius=0.22"}, "ACCEPTED"},
        Refusal{
            {"discs.single.motion=fixed", "discs.single.velocity=[0, 1]"},
            "--set discs.single.velocity=[0, 1]: found discs.single.velocity of a fixed disc that is not 0, "
            "allowed 0 with motion = \"fixed\"; for another \"free\" or \"prescribed\""},
        Refusal{{"discs.single.motion=fixed", "discs.single.spin=1"},
                "--set discs.single.spin=1: found discs.single.spin of a fixed disc"},
        Refusal{{"discs.single.placement=random"}, "found the unknown key position in [discs]"},
        Refusal{{"contact.distance=0.09"},
                "--set contact.distance=0.09: found contact.distance = 0.09, allowed 0, for two particle "
                "spacings, or at least one: 0.1 (m)"},
        Refusal{
            {"contact.distance=2", "domain.periodic=x"},
            "--set contact.distance=2: found contact.distance = 2, allowed less than 2 (m), half the domain "
            "along x, which is periodic"},
        Refusal{{"contact.distance=2"}, "ACCEPTED"},
        Refusal{{"contact.distance=1.99", "domain.periodic=x"}, "ACCEPTED"},
        Refusal{{"contact.stiffness=0"}, "allowed a number > 0"},
        Refusal{
            {"fluid.gravity=[0, -9.81]", "domain.periodic=y"},
            "--set fluid.gravity=[0, -9.81]: found fluid.gravity = [0, -9.81] in a domain that is periodic "
            "along y, allowed 0 along y, where nothing ends the fall; fluid.body_force drives a periodic "
            "flow"},
        Refusal{{"fluid.gravity=[1, -9.81]", "domain.periodic=x"}, "periodic along x"},
        Refusal{{"fluid.gravity=[0, -9.81]", "domain.periodic=x"}, "ACCEPTED"},
        Refusal{{"start.arrangement=empty"},
                "found a start velocity with start.arrangement = \"empty\", allowed \"rest\""}));

TEST_F(ReadDiscs, AreNeededWhereThereIsNoFluid) {
    const std::string message = refusal(full_scene.substr(0, full_scene.find("[[discs]]")),
                                        {"start.arrangement=empty", "start.velocity=rest", "start.speed=0"});
    EXPECT_EQ(message,
              "--set start.arrangement=empty: found \"empty\" in a scene without discs, allowed fluid "
              "(\"lattice\", \"jittered\", \"relaxed\"), or discs in [[discs]]");
}

} // namespace
} // namespace slurry::test
