// What the rows of a pass hold beyond the particles' state.
#include "solver/loop/pass_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slurry::testing {
namespace {

// Of the wall fit's weights, (1 - (r / 3h)^2)^2 over the half-plane before a wall, the part within
// `thickness` smoothing lengths of it; along the wall the integral is proportional to (1 - (n / 3h)^2)^(5/2).
double share_of_film(double thickness) {
    constexpr int steps = 1000;
    const auto integral = [](double upper) {
        double sum = 0;
        for (int k = 0; k < steps; ++k) {
            const double n = upper * (k + 0.5) / steps;
            sum += std::pow(1 - n * n / 9, 2.5) * upper / steps;
        }
        return sum;
    };
    return integral(thickness) / integral(3);
}

TEST(KnownShare, IsNothingInAFilmAndAllFromTwoSmoothingLengthsOn) {
    EXPECT_EQ(known_share(0), 0);
    EXPECT_EQ(known_share(share_of_film(1)), 0);
    EXPECT_EQ(known_share(share_of_film(2)), 1);
    EXPECT_EQ(known_share(share_of_film(3)), 1);
    EXPECT_EQ(known_share(1.1), 1); // particles closer than on average
}

TEST(KnownShare, GrowsWithoutAJump) {
    double before = 0;
    for (double share = 0; share < 1; share += 1e-3) {
        const double known = known_share(share);
        EXPECT_GE(known, before);
        EXPECT_LT(known, before + 0.01);
        before = known;
    }
}

} // namespace
} // namespace slurry::testing
