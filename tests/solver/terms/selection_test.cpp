// A scene runs the terms that it needs, and says why.
#include "solver/terms/selection.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

bool runs(const Scene& scene, const std::string& term) {
    for (const TermReason& reason : explain_terms(scene)) {
        if (reason.term.find(term) != std::string::npos) {
            EXPECT_FALSE(reason.reason.empty()) << term;
            return reason.runs;
        }
    }
    ADD_FAILURE() << "no term is called " << term;
    return false;
}

TEST(TermSelection, SceneWithoutWallsViscosityOrBackgroundPressureRunsNoneOfTheirTerms) {
    Scene scene = doubly_periodic(8);
    scene.fluid.dynamic_viscosity = 0;
    scene.numerics.background_pressure_ratio = 0;
    const TermSelection terms = select_terms(scene);
    EXPECT_FALSE(terms.walls);
    EXPECT_FALSE(terms.viscosity);
    EXPECT_FALSE(terms.transport_velocity);
    EXPECT_FALSE(terms.advection_tensor) << "there is nothing to advect without a transport velocity";
    for (const char* term : {"wall fit", "viscous force", "transport velocity", "advection tensor"}) {
        EXPECT_FALSE(runs(scene, term)) << term;
    }
    EXPECT_TRUE(runs(scene, "continuity"));
    EXPECT_TRUE(runs(scene, "pressure force"));
}

TEST(TermSelection, ChannelRunsWhatItNeeds) {
    Scene scene = flat_channel(8);
    scene.numerics.density_diffusion = 0.1;
    const TermSelection terms = select_terms(scene);
    EXPECT_TRUE(terms.walls && terms.viscosity && terms.transport_velocity && terms.advection_tensor &&
                terms.gradient_correction && terms.density_diffusion);
    EXPECT_FALSE(terms.hydrostatic_diffusion);
    for (const char* term : {"wall fit", "viscous force", "transport velocity", "advection tensor",
                             "gradient correction", "density diffusion"}) {
        EXPECT_TRUE(runs(scene, term)) << term;
    }
    EXPECT_FALSE(runs(scene, "hydrostatic"));
}

TEST(TermSelection, WallsAreContinuedByFitsOrByTheMeansOfThePaper) {
    Scene scene = flat_channel(8);
    scene.numerics.wall_extrapolation = WallExtrapolation::mean;
    EXPECT_TRUE(runs(scene, "wall extrapolation (2.16, 2.17)"));
    for (const TermReason& reason : explain_terms(scene)) {
        EXPECT_EQ(reason.term.find("wall fit"), std::string::npos);
    }
    EXPECT_FALSE(runs(doubly_periodic(8), "wall fit"));
}

TEST(TermSelection, HydrostaticDiffusionNeedsBothBodyForceAndDiffusion) {
    Scene scene = flat_channel(8);
    scene.fluid.body_force = {0, -9.81};
    EXPECT_FALSE(select_terms(scene).hydrostatic_diffusion);
    scene.numerics.density_diffusion = 0.1;
    EXPECT_TRUE(select_terms(scene).hydrostatic_diffusion);
}

TEST(TermSelection, SwitchesOfTheSceneAreObeyed) {
    Scene scene = flat_channel(8);
    scene.numerics.advection_tensor = false;
    scene.numerics.gradient_correction = false;
    EXPECT_FALSE(select_terms(scene).advection_tensor);
    EXPECT_TRUE(select_terms(scene).transport_velocity);
    EXPECT_FALSE(select_terms(scene).gradient_correction);
}

} // namespace
} // namespace slurry::testing
