// A density that is off comes with its likeliest reason, whether the run is stopped or ends.
#include "solver/time/density_error.hpp"

#include "solver/output/result_file.hpp"
#include "tests/solver/time/resumable_run.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace slurry::testing {
namespace {

// c = 10 m/s in a domain 1 m wide, 12 spacings across; a lid at `lid_speed`.
struct Diagnosis {
    const char* name;
    std::function<void(Scene&, DensityFault&)> change;
    const char* advice;
};

class DensityAdvice : public ::testing::TestWithParam<Diagnosis> {};

TEST_P(DensityAdvice, NamesTheReasonAndWhatToChange) {
    Scene scene = flat_channel(12, 1);
    DensityFault fault;
    fault.time = 1; // ten times what sound needs to cross the domain
    fault.fluid_speed = 1;
    GetParam().change(scene, fault);
    const std::string advice = density_advice(scene, fault);
    EXPECT_NE(advice.find(GetParam().advice), std::string::npos) << advice;
    EXPECT_EQ(advice.find('\n'), std::string::npos);
}

const std::string name_of(const ::testing::TestParamInfo<Diagnosis>& info) {
    return info.param.name;
}

const char* const general =
    "reduce numerics.acoustic_cfl, or raise numerics.sound_speed: a flow's density error";
const char* const too_fast = "walls, discs or the start move at up to 2 m/s, 0.2 of numerics.sound_speed, "
                             "allowed 0.1: raise numerics.sound_speed to 20";

INSTANTIATE_TEST_SUITE_P(
    Each, DensityAdvice,
    ::testing::Values(
        Diagnosis{"Unknown", [](Scene&, DensityFault&) {}, general},
        Diagnosis{"FastWall",
                  [](Scene& scene, DensityFault&) {
                      scene.walls[1].velocity = {-2, 0};
                  },
                  too_fast},
        Diagnosis{"FastDisc",
                  [](Scene& scene, DensityFault&) {
                      scene.discs = {middle_disc()};
                      scene.discs[0].velocity = {0, 2};
                  },
                  too_fast},
        Diagnosis{"FastStart", [](Scene& scene, DensityFault&) { scene.start.speed = -2; }, too_fast},
        Diagnosis{"Jump",
                  [](Scene& scene, DensityFault& fault) {
                      scene.walls[0] = {"pad", CosineShape{0.3, 0.1, 1, 0}, FluidSide::above, {1, 0}};
                      fault.time = 0.09;
                      fault.fluid_speed = 1.5; // which the jump has brought about
                      fault.jump = {"pad", 0.55};
                  },
                  "the wall 'pad' starts at once at 0.55 m/s across its surface, 0.055 of "
                  "numerics.sound_speed, allowed 0.03: raise numerics.sound_speed to 18.33, or let it stand "
                  "and set walls.lid.velocity=[0, 0]"},
        Diagnosis{"JumpLongAgo",
                  [](Scene&, DensityFault& fault) {
                      fault.time = 0.11;
                      fault.jump = {"pad", 0.55};
                  },
                  general},
        Diagnosis{"JumpTooSlowToMatter",
                  [](Scene&, DensityFault& fault) {
                      fault.time = 0.09;
                      fault.jump = {"pad", 0.3};
                  },
                  general},
        Diagnosis{"NoBackgroundPressure",
                  [](Scene& scene, DensityFault& fault) {
                      scene.numerics.background_pressure_ratio = 0;
                      fault.gap = 0.01;
                  },
                  "set numerics.background_pressure_ratio to 1, not 0"},
        Diagnosis{"FastFluid", [](Scene&, DensityFault& fault) { fault.fluid_speed = 3; },
                  "the fluid moves at up to 3 m/s, 0.3 of numerics.sound_speed, allowed 0.1: raise "
                  "numerics.sound_speed to 30"},
        Diagnosis{"FluidHardlyTooFast", [](Scene&, DensityFault& fault) { fault.fluid_speed = 1.2; },
                  general},
        Diagnosis{"FluidThatFliesOff", [](Scene&, DensityFault& fault) { fault.fluid_speed = 1e6; }, general},
        Diagnosis{
            "NarrowGap", [](Scene&, DensityFault& fault) { fault.gap = 0.25; },
            "in a gap of 3 particle spacings, advised at least 5: reduce numerics.particle_spacing to 0.05"},
        Diagnosis{"WideGap", [](Scene&, DensityFault& fault) { fault.gap = 0.42; }, general}),
    name_of);

TEST(GapAround, IsBetweenTheTwoNearestSolidsThatFaceEachOther) {
    Scene scene = flat_channel(12);
    const Region region(scene);
    Particles particles;
    EXPECT_NEAR(gap_around(particles, region, {0.1, 0.4}), 1, 1e-12);
    Disc disc;
    disc.position = {0.65, 0.7}; // across the side at x = 0.7 from the place
    disc.radius = 0.25;
    particles.discs = {disc};
    EXPECT_NEAR(gap_around(particles, region, {-0.35 + 1e-9, 1.05}), 0.25, 1e-6);
    particles.discs[0].position = {0.2, 1.0}; // behind the nearer of two solids on the same side
    particles.discs[0].radius = 0.1;
    EXPECT_NEAR(gap_around(particles, region, {0.2, 0.5}), 0.7, 1e-12);
}

TEST(GapAround, IsInfiniteInACornerAndWithoutSolids) {
    Scene scene = core_scene({0, 0}, {1, 1}, {false, false}, 0.1);
    scene.walls = {{"bottom", LineShape{{0, 0}, {1, 0}}, FluidSide::above, Vector::Zero()},
                   {"right", LineShape{{1, 0}, {1, 1}}, FluidSide::left, Vector::Zero()},
                   {"top", LineShape{{1, 1}, {0, 1}}, FluidSide::below, Vector::Zero()},
                   {"left", LineShape{{0, 1}, {0, 0}}, FluidSide::right, Vector::Zero()}};
    EXPECT_TRUE(std::isinf(gap_around({}, Region(scene), {0.1, 0.2})));
    EXPECT_TRUE(std::isinf(gap_around({}, Region(doubly_periodic(10)), {0.1, 0.3})));
}

// What is said of a result with samples at steps 0, 5 and 10 of 0.01 s.
template <class Say> std::string said_of(const std::vector<double>& errors, Say&& say) {
    const OwnFolder folder;
    const Scene scene = flat_channel(12, 1);
    ResultFile file(folder.path(), scene, "test", true);
    for (std::size_t k = 0; k < errors.size(); ++k) {
        file.begin_sample(0.05 * static_cast<double>(k));
        file.add_sample("largest_speed", "m/s", 1.0 + static_cast<double>(k));
        file.add_sample("largest_density_error", "1", errors[k]);
    }
    return say(file.finish(), scene);
}

std::string warning_for(const std::vector<double>& errors) {
    return said_of(errors, [](const std::filesystem::path& result, const Scene& scene) {
        return density_warning(result, scene, Region(scene), 0.01);
    });
}

std::string note_for(const std::vector<double>& errors) {
    return said_of(errors, density_note);
}

TEST(DensityNote, TellsTheSoundSpeedForOnePercent) {
    EXPECT_EQ(note_for({0, 0.01, 0.0099}), "");
    const std::string note = note_for({0, 0.04, 0.03});
    for (const char* part : {"up to 4 % off", "at 0.05 s", "sound_speed of about 20 "}) {
        EXPECT_NE(note.find(part), std::string::npos) << part << "\nis not in\n" << note;
    }
    EXPECT_EQ(note_for({0, 0.051, 0.01}), "") << "there is a warning for that";
}

TEST(DensityWarning, SaysHowMuchWhenAndWhatToDo) {
    const std::string warning = warning_for({0, 0.0812, 0.06});
    for (const char* part : {"result.h5: ", "8.12 %", "step 5", "time 0.05 s", "allowed 5 %",
                             "the fluid moves at up to 2 m/s", "raise numerics.sound_speed to 20"}) {
        EXPECT_NE(warning.find(part), std::string::npos) << part << "\nis not in\n" << warning;
    }
    EXPECT_EQ(warning.find('\n'), std::string::npos);
}

TEST(DensityWarning, IsNoneUpToTheLimit) {
    EXPECT_EQ(warning_for({0, 0.05, 0.01}), "");
    EXPECT_NE(warning_for({0, 0.05001, 0.01}), "");
}

} // namespace
} // namespace slurry::testing
