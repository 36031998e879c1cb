// The search for discs nearby finds just what a look at all of them finds.
#include "solver/discs/crowd.hpp"

#include "solver/discs/nearest_image.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace slurry::testing {
namespace {

constexpr double rim_radius = 0.05;
constexpr double rim_distance = 0.02; // which rims keep
constexpr double centre_reach = 2 * rim_radius + rim_distance;
constexpr double crowd_width = 10.001 * centre_reach; // of the domain

// Ten cells wide, each hardly wider than centres reach, and off the origin so that a lost offset shows.
Domain crowd_domain(std::array<bool, 2> periodic) {
    const Vector lower(0.4, -0.3);
    return {lower, lower + Vector(crowd_width, crowd_width), periodic};
}

// Two centres this far apart, somewhere in the domain: is the one too near to the other?
bool found_too_near(const Domain& domain, const Vector& first, const Vector& offset) {
    Crowd crowd(domain, rim_radius, rim_distance);
    crowd.add({first, rim_radius, rim_distance});
    return crowd.too_near({wrapped(first + offset, domain), rim_radius, rim_distance}).has_value();
}

TEST(Crowd, RimsThatKeepTheirDistanceAreNotTooNearAndOthersAreWhereverTheyAre) {
    const Domain domain = crowd_domain({true, true});
    std::mt19937 generator(2);
    std::uniform_real_distribution<double> share(0, 1);
    for (int k = 0; k < 2000; ++k) {
        const Vector first =
            domain.lower + Vector(share(generator), share(generator)).cwiseProduct(domain.size());
        const double angle =
            2 * std::numbers::pi * (k % 4 == 0 ? std::round(4 * share(generator)) / 4 : share(generator));
        const Vector direction(std::cos(angle), std::sin(angle));
        EXPECT_TRUE(found_too_near(domain, first, 0.999 * centre_reach * direction))
            << first.transpose() << ", " << angle;
        EXPECT_FALSE(found_too_near(domain, first, 1.001 * centre_reach * direction))
            << first.transpose() << ", " << angle;
    }
}

TEST(Crowd, BeyondASideThatIsNotPeriodicThereIsNoImage) {
    const Domain domain = crowd_domain({false, true});
    Crowd crowd(domain, rim_radius, rim_distance);
    crowd.add({domain.lower + Vector(0.01, 0.5), rim_radius, rim_distance});
    EXPECT_FALSE(crowd.too_near({domain.lower + Vector(crowd_width - 0.01, 0.5), rim_radius, rim_distance}));
    EXPECT_TRUE(
        crowd.too_near({domain.lower + Vector(-0.01, 0.5), rim_radius, rim_distance})); // outside, and near
    EXPECT_FALSE(crowd.too_near({{1e300, 0}, rim_radius, rim_distance}));
}

TEST(Crowd, TheLargerOfTwoLeastDistancesCounts) {
    const Domain domain = crowd_domain({true, true});
    Crowd crowd(domain, rim_radius, rim_distance);
    crowd.add({domain.lower, rim_radius, rim_distance});
    const Vector beside = domain.lower + Vector(centre_reach - 0.01, 0);
    EXPECT_TRUE(crowd.too_near({beside, rim_radius, 0}));
    EXPECT_NEAR(crowd.gap({beside, rim_radius, 0}, 0), rim_distance - 0.01, 1e-15);
}

} // namespace
} // namespace slurry::testing
