#include "solver/probes/particle_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace slurry::test {
namespace {

constexpr double spacing = 0.1;

struct Cloud {
    std::vector<double> x, y;

    [[nodiscard]] FluidView view() const { return {x, y, x, y, x}; }
};

Cloud random_cloud(const Domain& domain, int count) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    Cloud cloud;
    for (int k = 0; k < count; ++k) {
        cloud.x.push_back(domain.lower.x() + uniform(generator) * domain.size().x());
        cloud.y.push_back(domain.lower.y() + uniform(generator) * domain.size().y());
    }
    return cloud;
}

using Found = std::vector<std::tuple<std::size_t, long, long>>; // offsets in 1e-9 of the unit of length

Found rounded(const std::vector<NearParticle>& near) {
    Found found;
    for (const auto& [index, offset] : near) {
        found.emplace_back(index, std::lround(offset.x() * 1e9), std::lround(offset.y() * 1e9));
    }
    std::ranges::sort(found);
    return found;
}

Found all_pairs(const Cloud& cloud, const Domain& domain, const Vector& point, double radius) {
    std::vector<NearParticle> near;
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
        for (int column = -4; column <= 4; ++column) {
            for (int row = -4; row <= 4; ++row) {
                if ((column != 0 && !domain.periodic[0]) || (row != 0 && !domain.periodic[1])) {
                    continue;
                }
                const Vector image(column * domain.size().x(), row * domain.size().y());
                const Vector offset = Vector(cloud.x[i], cloud.y[i]) + image - point;
                if (offset.norm() < radius) {
                    near.push_back({i, offset});
                }
            }
        }
    }
    return rounded(near);
}

TEST(ParticleFinder, FindsWhatAllPairsFind) {
    for (const bool periodic_x : {false, true}) {
        for (const bool periodic_y : {false, true}) {
            for (const double width : {0.37, 3.0}) { // the first is narrower than the search is wide
                const Domain domain{Vector(-1, 0.5), Vector(-1 + width, 2.5), {periodic_x, periodic_y}};
                const Cloud cloud = random_cloud(domain, 400);
                const ParticleFinder finder(cloud.view(), domain, spacing);
                for (const Vector& point : {Vector(-1, 0.5), Vector(-0.9, 2.49), Vector(-1 + width, 1.3),
                                            Vector(-1.2, 2.6)}) { // the last outside
                    EXPECT_EQ(rounded(finder.near(point, 0.52)), all_pairs(cloud, domain, point, 0.52));
                }
            }
        }
    }
}

TEST(ParticleFinder, NeverFindsAParticleWithoutAPosition) {
    const Domain domain{Vector(0, 0), Vector(1, 1), {true, false}};
    Cloud cloud = random_cloud(domain, 100);
    cloud.x[3] = std::numeric_limits<double>::quiet_NaN();
    cloud.y[4] = std::numeric_limits<double>::infinity();
    const ParticleFinder finder(cloud.view(), domain, spacing);
    const auto near = finder.near(Vector(0.5, 0.5), 0.7);
    EXPECT_GT(near.size(), 50U);
    for (const NearParticle& particle : near) {
        EXPECT_NE(particle.index, 3U);
        EXPECT_NE(particle.index, 4U);
    }
}

TEST(ParticleFinder, RefusesQuantitiesOfDifferentLengths) {
    const Domain domain{Vector(0, 0), Vector(1, 1), {true, false}};
    const std::vector<double> three(3);
    const std::vector<double> two(2);
    EXPECT_THROW(ParticleFinder({three, three, three, three, two}, domain, spacing), std::invalid_argument);
}

} // namespace
} // namespace slurry::test
