// Tait's equation of state, Eq. 2.11.
#include "solver/terms/equation_of_state.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

const EquationOfState water{1000, 20};

TEST(EquationOfState, IsTheSeventhPowerOfTheDensityRatio) {
    for (const double ratio : {0.9, 0.99, 1.0, 1.001, 1.1}) {
        const double expected = 1000 * 20 * 20 / 7.0 * (std::pow(ratio, 7) - 1);
        EXPECT_NEAR(water.pressure(1000 * ratio), expected, 1e-9) << ratio;
    }
    EXPECT_EQ(water.pressure(1000), 0);
}

TEST(EquationOfState, DensityOfThePressureOfADensityIsThatDensity) {
    for (double density = 900; density < 1100; density += 3.7) {
        EXPECT_NEAR(water.density(water.pressure(density)), density, 1e-10);
    }
}

TEST(EquationOfState, SlopeAtTheReferenceDensityIsTheSquaredSoundSpeed) {
    constexpr double step = 1e-2;
    const double slope = (water.pressure(1000 + step) - water.pressure(1000 - step)) / (2 * step);
    EXPECT_NEAR(slope, 20 * 20, 1e-5);
}

} // namespace
} // namespace slurry::testing
