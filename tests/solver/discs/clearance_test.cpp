// How far a point is from the nearest rim.
#include "solver/discs/clearance.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace slurry::testing {
namespace {

const Domain film_domain{{-0.3, 0.2}, {0.7, 1.2}, {true, false}};

Disc rim_at(const Vector& position, double radius) {
    Disc disc;
    disc.position = position;
    disc.radius = radius;
    return disc;
}

TEST(Clearance, IsTheDistanceToTheNearestRimAndNegativeInADisc) {
    const std::vector<Disc> discs{rim_at({0.1, 0.5}, 0.1), rim_at({0.5, 0.5}, 0.05)};
    EXPECT_NEAR(clearance(discs, film_domain, {0.1, 0.8}), 0.2, 1e-15);
    EXPECT_NEAR(clearance(discs, film_domain, {0.1, 0.44}), -0.04, 1e-15);
    EXPECT_NEAR(clearance(discs, film_domain, {0.42, 0.5}), 0.03, 1e-15); // nearer to the small one
}

TEST(Clearance, ReachesAcrossPeriodicSidesOnlyAndCountsDiscsThatDriftedAway) {
    const std::vector<Disc> discs{rim_at({0.65 + 3, 0.3}, 0.05)};
    EXPECT_NEAR(clearance(discs, film_domain, {-0.25, 0.3}), 0.05, 1e-14);
    EXPECT_NEAR(clearance(discs, film_domain, {0.65, 1.1}), 0.75, 1e-14);
}

TEST(Clearance, IsInfiniteWithoutDiscs) {
    EXPECT_EQ(clearance({}, film_domain, {0, 0.5}), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace slurry::testing
