// Layers of dummies that follow a wall.
#include "solver/geometry/wall.hpp"

#include "tests/solver/geometry/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slurry::testing {
namespace {

// Behind a bulge an arc is shorter by depth times angle, and the fans about the two kinks at its feet make
// that up: all layers are as long as the wall.
TEST(Layers, BehindABulgeHaveTheVolumeOfTheirLength) {
    const double radius = 0.2;
    const double spacing = 0.01;
    const int layers = 3;
    for (const double angle : {0.5, 2.0, 3.0}) {
        const Wall wall(make_wall("bulge", ArcShape{0.3, 1, radius, angle, true}, FluidSide::above),
                        make_domain({0, 0}, {2, 1}, true));
        double volume = 0;
        for (const Dummy& dummy : wall.curve_dummies(spacing, layers)) {
            volume += dummy.volume;
        }
        const double length = 2 - 2 * radius * std::sin(angle / 2) + radius * angle;
        EXPECT_NEAR(volume / (layers * spacing), length, 1e-5) << angle;
    }
}

} // namespace
} // namespace slurry::testing
