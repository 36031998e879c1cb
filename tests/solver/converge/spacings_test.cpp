#include "solver/converge/spacings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slurry {
namespace {

Domain box(double width, double height) {
    return {{-0.3, 0.2}, {-0.3 + width, 0.2 + height}, {true, false}};
}

double misfit(double length, double spacing) {
    return std::abs(length / spacing - std::round(length / spacing));
}

TEST(Spacings, OneThatFitsIsKept) {
    EXPECT_DOUBLE_EQ(admissible_spacing(box(1, 0.5), 0.05), 0.05);
}

TEST(Spacings, OneThatDoesNotFitMovesToTheNearestThatDoes) {
    EXPECT_NEAR(admissible_spacing(box(1, 0.5), 0.047), 1.0 / 22, 1e-12); // even: half the width fits, too
    EXPECT_NEAR(admissible_spacing(box(1, 1), 0.047), 1.0 / 21, 1e-12);
}

TEST(Spacings, SidesWithoutACommonMeasureAreBothNearlyFitted) {
    const double spacing = admissible_spacing(box(1, 0.4931), 0.03);
    EXPECT_NEAR(spacing, 0.03, 0.12 * 0.03);
    EXPECT_LT(misfit(1, spacing) * spacing, 0.01);
    EXPECT_LT(misfit(0.4931, spacing) * spacing, 0.01);
}

TEST(Spacings, OfAStudyFallByTheRootOfTwoAndFit) {
    const auto spacings = study_spacings(box(3e-5, 1.5e-5), 2.5e-7, 4);
    ASSERT_EQ(spacings.size(), 4U);
    EXPECT_NEAR(spacings.back(), 2.5e-7, 1e-15);
    for (std::size_t k = 0; k < spacings.size(); ++k) {
        EXPECT_LT(misfit(3e-5, spacings[k]), 1e-6);
        EXPECT_LT(misfit(1.5e-5, spacings[k]), 1e-6);
        if (k > 0) {
            EXPECT_NEAR(spacings[k - 1] / spacings[k], std::sqrt(2), 0.05);
        }
    }
}

TEST(Adaptation, SaysWhichSpacingBecameWhichAndWhy) {
    const std::string said = adaptation(box(4e-5, 2.1e-5), 4e-7, 4e-5 / 99);
    for (const char* part : {"spacing 4e-07 m becomes 4.0404e-07 m", "4e-05 m and 2.1e-05 m",
                             "99 and 51.975, not 100 and 52.5"}) {
        EXPECT_NE(said.find(part), std::string::npos) << said;
    }
}

TEST(Adaptation, SaysNothingOfASpacingThatFits) {
    EXPECT_EQ(adaptation(box(3e-5, 1.5e-5), 2.5e-7, admissible_spacing(box(3e-5, 1.5e-5), 2.5e-7)), "");
}

} // namespace
} // namespace slurry
