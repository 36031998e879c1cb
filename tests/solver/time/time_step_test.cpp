// The time step of Eq. 2.35.
#include "solver/time/time_step.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

Scene scene_of(double viscosity, double force) {
    Scene scene = doubly_periodic(10);
    scene.numerics.smoothing_ratio = 1.2; // h = 0.12
    scene.numerics.acoustic_cfl = scene.numerics.viscous_cfl = scene.numerics.force_cfl = 0.25;
    scene.fluid = {1000, viscosity, {0.6 * force, -0.8 * force}};
    return scene;
}

TEST(TimeStep, AcousticLimit) {
    EXPECT_DOUBLE_EQ(largest_time_step(scene_of(0, 0)), 0.25 * 0.12 / 10);
    EXPECT_DOUBLE_EQ(largest_time_step(scene_of(1, 1)), 0.25 * 0.12 / 10); // the others are longer
}

TEST(TimeStep, ViscousLimit) {
    EXPECT_DOUBLE_EQ(largest_time_step(scene_of(5e3, 1)), 0.25 * 0.12 * 0.12 / 5);
}

TEST(TimeStep, ForceLimit) {
    EXPECT_DOUBLE_EQ(largest_time_step(scene_of(1, 1e5)), 0.25 * std::sqrt(0.12 / 1e5));
}

TEST(TimeStep, FactorsOfTheSceneReplaceTheQuarter) {
    for (const auto& [viscosity, force] : {std::pair{0.0, 0.0}, {5e3, 0.0}, {0.0, 1e5}}) {
        Scene scene = scene_of(viscosity, force);
        const double before = largest_time_step(scene);
        scene.numerics.acoustic_cfl = scene.numerics.viscous_cfl = scene.numerics.force_cfl = 0.125;
        EXPECT_DOUBLE_EQ(largest_time_step(scene), before / 2);
    }
}

TEST(TimeStep, IsShorterForStiffContactsAndLightDiscs) {
    Scene scene = scene_of(1, 1);
    const double fluid = largest_time_step(scene);
    const auto disc_of = [&](double density) {
        Disc disc;
        disc.radius = 0.6; // 5 smoothing lengths
        disc.mass = density * scene.fluid.density * disc.area();
        return std::vector{disc};
    };
    EXPECT_EQ(largest_time_step(scene, {}, 0), fluid);
    EXPECT_EQ(largest_time_step(scene, disc_of(1), 0), fluid);
    EXPECT_DOUBLE_EQ(largest_time_step(scene, disc_of(1), 1e4), 2 * std::numbers::pi / 12e4);
    EXPECT_DOUBLE_EQ(largest_time_step(scene, disc_of(0.005), 0), std::sqrt(0.025) * 0.12 / 10); // stiffness
    scene.fluid.dynamic_viscosity = 1e4;
    const double drag = 0.14 * 0.05 / (1 + 0.19 * 0.05);
    EXPECT_DOUBLE_EQ(largest_time_step(scene, disc_of(0.01), 0), drag * 0.12 * 0.12 / 10);
    scene.numerics.viscous_cfl =
        0.4; // a disc of the fluid's density and 2.5 smoothing lengths diverges with it
    auto small = disc_of(1);
    small[0].radius = 0.3;
    small[0].mass = scene.fluid.density * small[0].area();
    EXPECT_LT(largest_time_step(scene, small, 0), 0.85 / (1.1 + 5.7 / 2.5) * 0.12 * 0.12 / 10);
    small[0].mass *= 100;
    EXPECT_EQ(largest_time_step(scene, small, 0), largest_time_step(scene));
    auto held = disc_of(0.01);
    held[0].motion = DiscMotion::fixed;
    EXPECT_EQ(largest_time_step(scene, held, 0), largest_time_step(scene));
}

} // namespace
} // namespace slurry::testing
