// Who has left its neighbours behind since they were last looked at ends the run; with discs alone there are
// none.
#include "solver/loop/neighbourhood.hpp"

#include "solver/particles/run_error.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

constexpr double support = 3; // smoothing lengths

Neighbourhood neighbourhood_of(const Scene& scene) {
    return {scene, support, support, 1, sizeof(double)};
}

TEST(Neighbourhood, NamesTheParticleThatLeftItsNeighbours) {
    const Scene scene = flat_channel(20);
    Particles particles = arrange(scene);
    Neighbourhood neighbourhood = neighbourhood_of(scene);
    neighbourhood.refresh(particles);
    const std::size_t moved = 3;
    particles.fluid.x[moved] += 6 * scene.numerics.particle_spacing;
    try {
        neighbourhood.refresh(particles);
        FAIL() << "went on";
    } catch (const RunError& error) {
        const std::string name = "particle " + std::to_string(particles.fluid.identity[moved]) + " at";
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

TEST(Neighbourhood, LetsNobodyMoveMoreThanASmoothingLengthBetweenTwoLooks) {
    const Scene scene = flat_channel(20);
    const double skin = 0.5 * scene.numerics.particle_spacing; // at most
    for (const auto& [way, stops] : {std::pair(0.99, false), std::pair(1.01, true)}) {
        Particles particles = arrange(scene);
        Neighbourhood neighbourhood = neighbourhood_of(scene);
        neighbourhood.refresh(particles);
        particles.fluid.y[3] += way * scene.numerics.smoothing_length() + (stops ? skin : 0);
        if (stops) {
            EXPECT_THROW(neighbourhood.refresh(particles), RunError);
        } else {
            EXPECT_NO_THROW(neighbourhood.refresh(particles));
        }
    }
}

TEST(Neighbourhood, DiscsAloneMayFlyPastEachOther) {
    Scene scene = doubly_periodic(20);
    scene.start.arrangement = Arrangement::empty;
    scene.discs = {middle_disc()};
    Particles particles = arrange(scene);
    Neighbourhood neighbourhood = neighbourhood_of(scene);
    neighbourhood.refresh(particles);
    ASSERT_GT(particles.dummies.size(), 0U);
    particles.dummies.x.front() += 6 * scene.numerics.particle_spacing;
    EXPECT_NO_THROW(neighbourhood.refresh(particles));
}

} // namespace
} // namespace slurry::testing
