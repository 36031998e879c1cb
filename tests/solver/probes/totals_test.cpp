#include "solver/probes/totals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace slurry::test {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(Totals, OfThreeParticlesAreThoseByHand) {
    const std::array velocity_x{3.0, -1.0, 0.0};
    const std::array velocity_y{4.0, 0.0, 2.0};
    const std::array density{1000.0, 990.0, 1004.0};
    const Totals totals = fluid_totals(velocity_x, velocity_y, density, 0.5, 1000);
    EXPECT_DOUBLE_EQ(totals.kinetic_energy, 0.5 * 0.5 * (25 + 1 + 4));
    EXPECT_DOUBLE_EQ(totals.momentum.x(), 1);
    EXPECT_DOUBLE_EQ(totals.momentum.y(), 3);
    EXPECT_DOUBLE_EQ(totals.mean_density, 998);
    EXPECT_DOUBLE_EQ(totals.largest_speed, 5);
    EXPECT_NEAR(totals.largest_density_error, 0.01, 1e-15);
}

TEST(Totals, LoseNoNaN) {
    for (std::size_t bad = 0; bad < 3; ++bad) { // first, in the middle, last
        std::array<double, 3> velocity_x{1, 2, 3};
        const std::array<double, 3> velocity_y{};
        std::array<double, 3> density{1000, 1000, 1000};
        velocity_x[bad] = not_a_number;
        density[bad] = not_a_number;
        const Totals totals = fluid_totals(velocity_x, velocity_y, density, 1, 1000);
        EXPECT_TRUE(std::isnan(totals.kinetic_energy));
        EXPECT_TRUE(std::isnan(totals.momentum.x()));
        EXPECT_TRUE(std::isnan(totals.mean_density));
        EXPECT_TRUE(std::isnan(totals.largest_speed));
        EXPECT_TRUE(std::isnan(totals.largest_density_error));
    }
}

TEST(Totals, OfNothingHaveNoMeanDensity) {
    const Totals totals = fluid_totals({}, {}, {}, 1, 1000);
    EXPECT_EQ(totals.kinetic_energy, 0);
    EXPECT_TRUE(std::isnan(totals.mean_density));
}

} // namespace
} // namespace slurry::test
