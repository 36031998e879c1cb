#include "tests/solver/scene/scene_folder.hpp"

namespace slurry::test {
namespace {

using Overrides = SceneFolder;

TEST_F(Overrides, SetKeysOfTablesAndOfNamedTables) {
    const Scene scene =
        read(full_scene, {"numerics.acoustic_cfl=0.5", "walls.line.velocity=[1, 0]", " fluid.density = 900 ",
                          "probes.wall.points=7", "discs.random.count=9", "contact.stiffness=0.1",
                          "output.snapshot_times=[0.25, 0.5]"});
    EXPECT_EQ(scene.numerics.acoustic_cfl, 0.5);
    EXPECT_EQ(scene.walls[0].velocity, Vector(1, 0));
    EXPECT_EQ(scene.fluid.density, 900);
    EXPECT_EQ(std::get<WallProbe>(scene.probes[0].kind).points, 7);
    EXPECT_EQ(std::get<RandomDiscs>(scene.discs[1].placement).count, 9);
    EXPECT_EQ(scene.contact.stiffness, 0.1);
    EXPECT_EQ(scene.output.snapshot_times, (std::vector<double>{0.25, 0.5}));
    EXPECT_NE(scene.resolved_text.find("acoustic_cfl = 0.5"), std::string::npos);
}

TEST_F(Overrides, AddTablesAndTakeTheLastOfTwo) {
    const Scene scene = read(full_scene, {"scene.title=first", "scene.title=second"});
    EXPECT_EQ(scene.title, "second");
}

TEST_F(Overrides, TakeBareWordsAsStrings) {
    EXPECT_EQ(read(full_scene, {"scene.title=two words"}).title, "two words");
    EXPECT_EQ(read(full_scene, {"domain.periodic=x"}).domain.periodic[0], true);
    write("other-1.csv", "0,1\n1,1\n");
    EXPECT_EQ(std::get<ProfileShape>(read(full_scene, {"walls.profile.file=./other-1.csv"}).walls[5].shape)
                  .points.size(),
              2U);
}

TEST_F(Overrides, AreNamedInRefusals) {
    EXPECT_EQ(refusal(full_scene, {"numerics.acustic_cfl=0.5"}),
              "--set numerics.acustic_cfl=0.5: found the unknown path numerics.acustic_cfl, allowed "
              "table.key=value, or in walls, discs and probes table.NAME.key=value, nearest known key "
              "numerics.acoustic_cfl");
    EXPECT_EQ(refusal(full_scene, {"numerics.acoustic_cfl=nan"}),
              "--set numerics.acoustic_cfl=nan: found numerics.acoustic_cfl = the number nan, allowed a "
              "number > 0 and "
              "<= 10");
    EXPECT_EQ(refusal(full_scene, {"walls.lime.velocity=[0, 0]"}),
              "--set walls.lime.velocity=[0, 0]: found no \"lime\" in walls, allowed line, cosine, gaussian, "
              "arc, sine, "
              "profile, random, nearest known key walls.line.velocity");
    EXPECT_EQ(refusal(full_scene, {"domain.upper=[-1, 4]"}).substr(0, 28), "--set domain.upper=[-1, 4]: ");
    EXPECT_EQ(refusal(full_scene, {"numerics.particle_spacing=1e-5"}).substr(0, 38),
              "--set numerics.particle_spacing=1e-5: ");
}

TEST_F(Overrides, RefuseWhatSetsNothing) {
    for (const char* change : {"",
                               "=",
                               "=3",
                               ".=3",
                               "..=3",
                               "numerics",
                               "fluid={density=3}",
                               "fluid=3",
                               "walls.velocity=[0, 0]",
                               "walls.line={}",
                               "walls.line.shape.x=1",
                               "numerics.acoustic_cfl.x=1",
                               "numerics.acoustic_cfl=",
                               "numerics.acoustic_cfl==1",
                               "numerics.acoustic_cfl=1\nviscous_cfl=1",
                               "scene.title=\"x\"\ntitle=3",
                               "scene.title=a\"b",
                               "scene.title=[",
                               "walls.cosine.file=profile.csv",
                               "probes.point.points=3"}) {
        const std::string message = refusal(full_scene, {change});
        EXPECT_TRUE(message.starts_with("--set ")) << change << "\n" << message;
    }
}

TEST_F(Overrides, LeaveNoKeyIgnored) {
    // The keys of the cosine in the file have no meaning for a line.
    EXPECT_TRUE(refusal(full_scene, {"walls.cosine.shape=line"})
                    .starts_with("scene.toml:29:1: found the unknown key amplitude"));
}

} // namespace
} // namespace slurry::test
