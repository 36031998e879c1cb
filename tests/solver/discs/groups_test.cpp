#include "solver/discs/groups.hpp"

#include "tests/solver/discs/disc_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace slurry::testing {
namespace {

TEST(DiscGroups, ReachTheirFractions) {
    Scene scene = box({true, false});
    RandomDiscs weighed;
    weighed.weight_fraction = 0.2;
    weighed.radius = 0.01;
    RandomDiscs spread;
    spread.area_fraction = 0.1;
    spread.radius = 0.01;
    spread.sizes = SizeDistribution::uniform;
    spread.spread = 0.5;
    RandomDiscs light = weighed;
    light.weight_fraction = 0.05;
    scene.discs = {random_discs("heavy", weighed), random_discs("spread", spread),
                   random_discs("light", light), single("single", 0.1, {0.5, 0.5})};
    scene.discs[2].density = 500;
    const std::vector<PlacedDisc> discs = place(scene);
    const auto area = [&](const std::string& name) {
        std::vector<PlacedDisc> group;
        std::ranges::copy_if(discs, std::back_inserter(group),
                             [&](const PlacedDisc& disc) { return disc.name.starts_with(name); });
        return area_of(group);
    };
    const double half_disc = std::numbers::pi * 0.01 * 0.01 / 2;
    EXPECT_NEAR(area("spread"), 0.1, std::numbers::pi * 0.015 * 0.015 / 2);
    const double fluid = 1000 * (1 - area_of(discs));
    // A disc more or less changes the fluid's mass, too.
    EXPECT_NEAR(2000 * area("heavy") / (2000 * area("heavy") + fluid), 0.2, 1.5 * 2000 * half_disc / 1000);
    EXPECT_NEAR(500 * area("light") / (500 * area("light") + fluid), 0.05, 1.5 * 500 * half_disc / 1000);
}

// Mean and variance of a quantity over the radii that a group draws.
template <class Quantity> std::array<double, 2> moments(const RandomDiscs& random, Quantity quantity) {
    Scene scene = box({true, true});
    scene.numerics.particle_spacing = 1e-6;
    scene.domain.upper = {100, 100};
    scene.discs = {random_discs("grain", random)};
    double mean = 0;
    double square = 0;
    const std::vector<PlacedDisc> discs = place(scene);
    for (const PlacedDisc& disc : discs) {
        mean += quantity(disc.radius) / static_cast<double>(discs.size());
        square += std::pow(quantity(disc.radius), 2) / static_cast<double>(discs.size());
    }
    return {mean, square - mean * mean};
}

TEST(DiscGroups, HaveTheMomentsOfTheirSizes) {
    constexpr int count = 20'000;
    const double deviation = 1 / std::sqrt(count);
    RandomDiscs random = counted(count, 0.01);
    const auto [constant, none] = moments(random, [](double radius) { return radius; });
    EXPECT_NEAR(constant, 0.01, 1e-12);
    EXPECT_NEAR(none, 0, 1e-12);

    random.sizes = SizeDistribution::uniform;
    random.spread = 0.6;
    const auto [mean, variance] = moments(random, [](double radius) { return radius / 0.01; });
    EXPECT_NEAR(mean, 1, 4 * 0.6 / std::sqrt(3.0) * deviation);
    EXPECT_NEAR(variance, 0.36 / 3, 4 * 0.36 * std::sqrt(4.0 / 45) * deviation);

    random.sizes = SizeDistribution::lognormal;
    random.spread = 0.3;
    const auto [logarithm, of_logarithm] =
        moments(random, [](double radius) { return std::log(radius / 0.01); });
    EXPECT_NEAR(logarithm, 0, 4 * 0.3 * deviation);
    EXPECT_NEAR(of_logarithm, 0.09, 4 * 0.09 * std::sqrt(2.0) * deviation);

    random = counted(count, 0);
    random.sizes = SizeDistribution::file;
    random.radii = {0.01, 0.02, 0.02, 0.04};
    const auto [share, of_share] = moments(random, [](double radius) { return radius == 0.02 ? 1.0 : 0.0; });
    EXPECT_NEAR(share, 0.5, 4 * 0.5 * deviation);
    EXPECT_NEAR(of_share, 0.25, 0.01);
}

TEST(DiscGroups, AreRefusedWhenTheyAreTooFewTooManyOrTooSmall) {
    Scene scene = box({true, false});
    RandomDiscs random;
    random.area_fraction = 1e-3;
    random.radius = 0.04;
    scene.discs = {random_discs("grain", random)};
    EXPECT_NE(
        refusal(scene).find("discs 'grain': the fraction is an area of 0.001 m2, less than half a disc"),
        std::string::npos)
        << refusal(scene);

    random.area_fraction = 0.2;
    random.radius = 1e-3;
    scene.numerics.particle_spacing = 1e-4;
    scene.discs = {random_discs("grain", random), random_discs("dust", random)};
    EXPECT_NE(refusal(scene).find("discs, allowed at most 1e+05; --limit discs=1.28e+05 would allow it"),
              std::string::npos)
        << refusal(scene);

    random = counted(1000, 1e-2);
    random.sizes = SizeDistribution::lognormal;
    random.spread = 1;
    scene.numerics.particle_spacing = 2e-3;
    scene.discs = {random_discs("grain", random)};
    const std::string small = refusal(scene);
    EXPECT_NE(small.find("discs 'grain': a radius of 0.00"), std::string::npos) << small;
    EXPECT_NE(small.find("needs 3 or more, so less spread, larger discs or a particle_spacing"),
              std::string::npos)
        << small;
}

} // namespace
} // namespace slurry::testing
