// The momentum balance at a wall.
#include "solver/terms/wall_pressure_gradient.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

TEST(WallPressureGradient, IsThatOfBodyForceAndViscosity) {
    Fluid fluid;
    fluid.density = 1000;
    fluid.dynamic_viscosity = 2;
    fluid.body_force = {0.5, -9};
    EXPECT_NEAR(wall_pressure_gradient(fluid, {0, -1}, 0), 9000, 1e-9);
    EXPECT_NEAR(wall_pressure_gradient(fluid, {1, 0}, -70), 500 - 140, 1e-9);
    fluid.gravity = {0, -1};
    EXPECT_NEAR(wall_pressure_gradient(fluid, {0, 1}, 0), -9000, 1e-9);
    fluid.hydrostatics = Hydrostatics::full;
    EXPECT_NEAR(wall_pressure_gradient(fluid, {0, 1}, 0), -10000, 1e-9);
}

} // namespace
} // namespace slurry::testing
