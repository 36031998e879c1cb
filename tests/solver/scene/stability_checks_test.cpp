#include "solver/scene/stability_checks.hpp"

#include "tests/solver/scene/scene_folder.hpp"

namespace slurry::test {
namespace {

using Words = std::vector<std::string>;

struct Unstable {
    Words settings;     // of which the last one takes it beyond the limit
    std::string stable; // in its place
    std::string place, found, allowed;
};

class UnstableScene : public SceneFolder, public ::testing::WithParamInterface<Unstable> {};

TEST_P(UnstableScene, IsRefusedAndItsNeighbourIsNot) {
    const Unstable& unstable = GetParam();
    const std::string message = refusal(full_scene, unstable.settings);
    for (const std::string& part :
         {unstable.place, "found " + unstable.found, "allowed " + unstable.allowed}) {
        EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
    }
    Words settings = unstable.settings;
    settings.back() = unstable.stable;
    EXPECT_TRUE(refusal(full_scene, settings).starts_with("ACCEPTED")) << refusal(full_scene, settings);
    settings = unstable.settings;
    settings.emplace_back("start.arrangement=\"empty\"");
    settings.insert(settings.end(), {"start.velocity=\"rest\"", "start.speed=0"});
    EXPECT_TRUE(refusal(full_scene, settings).starts_with("ACCEPTED")) << "without fluid all is stable";
}

// full_scene: h = 0.1 m, c = 10 m/s, nu = 1e-6 m2/s, a shear of 1 m/s.
INSTANTIATE_TEST_SUITE_P(
    Each, UnstableScene,
    ::testing::Values(
        Unstable{{"numerics.acoustic_cfl=2.31"},
                 "numerics.acoustic_cfl=2.29",
                 "numerics.acoustic_cfl",
                 "numerics.acoustic_cfl = 2.31, a time step of 2.31 h / c",
                 "less than 2.3"},
        Unstable{{"fluid.dynamic_viscosity=1e4", "numerics.viscous_cfl=0.5"},
                 "numerics.viscous_cfl=0.49",
                 "numerics.viscous_cfl",
                 "numerics.viscous_cfl = 0.5, a time step of 0.5 h^2 / nu",
                 "less than 0.5"},
        Unstable{{"numerics.fourth_order_diffusion_share=0", "numerics.density_diffusion=0.7"},
                 "numerics.density_diffusion=0.6",
                 "numerics.density_diffusion",
                 "numerics.density_diffusion = 0.7 with a time step of 0.75 h / c",
                 "less than 0.667, or a smaller numerics.acoustic_cfl"},
        Unstable{{"numerics.wall_continuity=\"extrapolated\"", "discs.single.motion=\"fixed\"",
                  "discs.random.motion=\"fixed\"", "numerics.acoustic_cfl=0.5"},
                 "numerics.acoustic_cfl=0.49",
                 "numerics.wall_continuity",
                 "numerics.wall_continuity = \"extrapolated\" with a time step of 0.5 h / c",
                 "\"solenoidal\" or \"wall_velocity\", or a numerics.acoustic_cfl of less than 0.5"},
        Unstable{{"discs.random.motion=\"fixed\"", "numerics.acoustic_cfl=0.25",
                  "discs.single.motion=\"free\"", "numerics.wall_continuity=\"extrapolated\""},
                 "numerics.wall_continuity=\"solenoidal\"",
                 "numerics.wall_continuity",
                 "numerics.wall_continuity = \"extrapolated\" with discs that are free",
                 "\"solenoidal\" or \"wall_velocity\": discs"},
        Unstable{{"domain.periodic=\"xy\"", "start.velocity=\"taylor_green\"", "domain.upper=[4, 6]"},
                 "domain.upper=[4, 8]",
                 "start.velocity",
                 "\"taylor_green\" in a domain of 4 x 6 (m) that is periodic along y",
                 "a height that is a whole multiple of the width"},
        Unstable{{"discs.single.velocity=[1.51, 0]"}, // where the shear is at 0.5 m/s
                 "discs.single.velocity=[1.49, 0]",
                 "discs.single.velocity",
                 "a disc \"single\" that starts at 1.01 (m/s) against the fluid",
                 "at most 1, a tenth of numerics.sound_speed"},
        Unstable{{"discs.random.velocity=[0, 2.1]"},
                 "discs.random.velocity=[0, 1.9]",
                 "discs.random.velocity",
                 "a disc \"random\" that starts at 1.1 (m/s) against the fluid",
                 "at most 1, a tenth of numerics.sound_speed"},
        Unstable{{"discs.single.spin=-2.6"}, // with a rim at 1.04 m/s; the shear does not count at rest
                 "discs.single.spin=-2.4",
                 "discs.single.spin",
                 "a disc \"single\" whose rim starts at 1.04 (m/s) against the fluid",
                 "at most 1, a tenth of numerics.sound_speed"},
        Unstable{{"discs.single.spin=1", "discs.single.velocity=[1.2, 0]"},
                 "discs.single.velocity=[1.05, 0]",
                 "discs.single.velocity",
                 "a disc \"single\" whose rim starts at 1.1 (m/s) against the fluid",
                 "at most 1, a tenth of numerics.sound_speed"},
        Unstable{{"discs.random.sizes=\"uniform\"", "discs.random.spread=0.5", "discs.random.spin=1.7"},
                 "discs.random.spin=1.6",
                 "discs.random.spin",
                 "a disc \"random\" whose rim starts at 1.02 (m/s) against the fluid",
                 "at most 1, a tenth of numerics.sound_speed"}));

// Of Eq. 2.27: from 0.37 of the contact distance on, discs get no faster than half of what stops at touch.
TEST_F(SceneFolder, RandomDiscsThatWouldBeThrownApartAreRefused) {
    const auto with = [&](const Words& settings) { return refusal(full_scene, settings); };
    EXPECT_NE(with({"discs.random.least_distance=0.07"})
                  .find("found discs.random.least_distance = 0.07, allowed at least 0.07401 (m), or 0"),
              std::string::npos)
        << with({"discs.random.least_distance=0.07"});
    EXPECT_TRUE(with({"discs.random.least_distance=0.075"}).starts_with("ACCEPTED"));
    EXPECT_TRUE(with({"discs.random.least_distance=0"}).starts_with("ACCEPTED"));
    for (const char* harmless : {"contact.distance=0.1", "contact.stiffness=4", "contact.force_scale=1e3",
                                 "discs.random.motion=\"fixed\""}) {
        EXPECT_TRUE(with({"discs.random.least_distance=0.07", harmless}).starts_with("ACCEPTED")) << harmless;
    }
}

// nu = 0.02 m2/s, a spacing of 0.1 m: 5 at 1 m/s.
TEST_F(SceneFolder, CellReynoldsNumbersBeyondWhatIsKnownToBeAccurateAreWarnedOf) {
    const auto warnings = [&](const Words& more) {
        Words settings{"fluid.dynamic_viscosity=20", "start.velocity=\"rest\"", "start.speed=0"};
        settings.insert(settings.end(), more.begin(), more.end());
        return read(full_scene, settings).warnings;
    };
    EXPECT_TRUE(warnings({"walls.line.velocity=[-10, 0]"}).empty());
    const Words found = warnings({"walls.line.velocity=[-10.1, 0]"});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found[0].ends_with(
        "scene.toml:10:20: found numerics.particle_spacing = 0.1 with a wall at 10.1 (m/s), a cell Reynolds "
        "number of 50.5, advised at most 50: a particle_spacing of at most 0.09901 (m), or the layers along "
        "walls are not resolved"))
        << found[0];
    EXPECT_TRUE(warnings({"fluid.dynamic_viscosity=1e-6", "fluid.body_force=[1, 0]"}).empty());
    EXPECT_TRUE(warnings({"walls.line.velocity=[-10.1, 0]", "start.arrangement=\"empty\""}).empty());
}

} // namespace
} // namespace slurry::test
