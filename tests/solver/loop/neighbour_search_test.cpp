// Every search against all pairs: the same lists, in the same order, for every width and number of threads.
#include "solver/loop/neighbour_search.hpp"

#include "solver/loop/neighbour_list.hpp"
#include "solver/loop/periodic_rows.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

namespace slurry::testing {
namespace {

using Indices = std::vector<std::uint32_t>;

struct Case {
    std::vector<double> x, y;
    Indices candidates;
    std::size_t first = 0, last = 0;
    double cutoff = 0.13;

    void add(double at_x, double at_y) {
        x.push_back(at_x);
        y.push_back(at_y);
    }
    // All points are candidates and ask.
    Case everyone() && {
        candidates.resize(x.size());
        std::iota(candidates.begin(), candidates.end(), 0U);
        last = x.size();
        return std::move(*this);
    }
};

Indices by_all_pairs(const Case& points, std::size_t target) {
    Indices found;
    for (const auto other : points.candidates) {
        const double dx = points.x[target] - points.x[other];
        const double dy = points.y[target] - points.y[other];
        if (other != target && dx * dx + dy * dy < points.cutoff * points.cutoff) {
            found.push_back(other);
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

void expect_all_pairs(const Case& points, const NeighbourList& list, std::size_t width) {
    const auto padding = static_cast<std::uint32_t>(points.x.size());
    std::size_t pairs = 0;
    std::size_t evaluated = 0;
    ASSERT_EQ(list.block_count(), (points.last - points.first + width - 1) / width);
    for (std::size_t block = 0; block < list.block_count(); ++block) {
        std::size_t longest = 0;
        for (std::size_t lane = 0; lane < width; ++lane) {
            const std::size_t target = points.first + block * width + lane;
            const bool exists = target < points.last;
            ASSERT_EQ(list.target(block, lane), exists ? target : padding);
            Indices expected = exists ? by_all_pairs(points, target) : Indices();
            longest = std::max(longest, expected.size());
            pairs += expected.size();
            expected.resize(std::max(expected.size(), list.count(block)), padding);
            Indices found(list.count(block));
            for (std::size_t k = 0; k < found.size(); ++k) {
                found[k] = list.neighbours(block)[k * width + lane];
            }
            ASSERT_EQ(found, expected) << "target " << target;
        }
        ASSERT_EQ(list.count(block), longest);
        evaluated += longest * width;
    }
    EXPECT_EQ(list.pairs(), pairs);
    EXPECT_EQ(list.evaluated(), evaluated);
}

void expect_all_pairs_by_every_search(const Case& points) {
    const int threads_before = omp_get_max_threads();
    for (const auto search :
         {NeighbourSearch::strips, NeighbourSearch::cells, NeighbourSearch::plane_sweep}) {
        for (const int width : {1, 4, 8, 16}) {
            NeighbourList list(width, search);
            for (const int threads : {1, 2}) { // the second build finds the first one's lists in place
                SCOPED_TRACE("search " + std::to_string(static_cast<int>(search)) + ", width " +
                             std::to_string(width) + ", threads " + std::to_string(threads));
                omp_set_num_threads(threads);
                list.build(points.x, points.y, points.candidates, points.first, points.last,
                           static_cast<std::uint32_t>(points.x.size()), points.cutoff);
                expect_all_pairs(points, list, static_cast<std::size_t>(width));
            }
        }
    }
    omp_set_num_threads(threads_before);
}

// Distances are exact numbers, so that those at the cut-off are ties.
Case lattice(double cutoff) {
    Case points;
    for (int row = 0; row < 17; ++row) {
        for (int column = 0; column < 23; ++column) {
            points.add(0.25 * column - 1, 0.25 * row - 2);
        }
    }
    points.cutoff = cutoff;
    return std::move(points).everyone();
}

Case random_points(std::size_t count, double side_x, double side_y, double offset = 0) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    Case points;
    for (std::size_t k = 0; k < count; ++k) {
        const double x = offset + side_x * uniform(generator);
        points.add(x, offset + side_y * uniform(generator));
    }
    return std::move(points).everyone();
}

TEST(NeighbourSearches, OnALatticeWithTiesAtTheCutoff) {
    for (const double tie : {0.25, 0.5, 1.25}) { // 1.25: also 3, 4 and 5 quarters
        for (const double cutoff : {std::nextafter(tie, 0), tie, std::nextafter(tie, 2)}) {
            SCOPED_TRACE("cut-off " + std::to_string(cutoff));
            expect_all_pairs_by_every_search(lattice(cutoff));
        }
    }
}

TEST(NeighbourSearches, OfRandomPoints) {
    expect_all_pairs_by_every_search(random_points(700, 1, 1));
    expect_all_pairs_by_every_search(random_points(300, 1, 1, 1e6)); // far from the origin
    expect_all_pairs_by_every_search(random_points(200, 3, 0));      // on lines
    expect_all_pairs_by_every_search(random_points(200, 0, 3));
}

TEST(NeighbourSearches, OfClustersFarApart) {
    Case points = random_points(200, 0.3, 0.3);
    for (const double distance : {1.0, 1e5, 1e12}) {
        const Case cluster = random_points(120, 0.2, 0.2);
        for (std::size_t k = 0; k < cluster.x.size(); ++k) {
            points.add(cluster.x[k] + distance, cluster.y[k] - distance);
        }
    }
    expect_all_pairs_by_every_search(std::move(points).everyone());
}

TEST(NeighbourSearches, OfCoincidentPoints) {
    Case points = random_points(150, 1, 1);
    for (std::size_t k = 0; k < 150; ++k) {
        points.add(points.x[k], points.y[k]);
    }
    for (int k = 0; k < 300; ++k) {
        points.add(0.1, -0.2);
    }
    expect_all_pairs_by_every_search(std::move(points).everyone());
}

TEST(NeighbourSearches, OfNoPointsAndOfFew) {
    expect_all_pairs_by_every_search(Case().everyone());
    for (const std::size_t count : {1UL, 2UL, 3UL, 9UL}) {
        expect_all_pairs_by_every_search(random_points(count, 0.1, 0.1));
    }
}

TEST(NeighbourSearches, WithoutCandidatesOrTargets) {
    Case points = random_points(20, 0.2, 0.2);
    points.candidates.clear();
    expect_all_pairs_by_every_search(points);
    points = random_points(20, 0.2, 0.2);
    points.first = points.last;
    expect_all_pairs_by_every_search(points);
}

TEST(NeighbourSearches, OfCandidatesInAnyOrderForTargetsOutsideTheirBox) {
    Case points = random_points(800, 1.5, 1.5);
    std::erase_if(points.candidates,
                  [&](auto k) { return std::abs(points.x[k]) > 0.3 || std::abs(points.y[k] - 0.1) > 0.2; });
    std::reverse(points.candidates.begin(), points.candidates.end());
    points.first = 100;
    expect_all_pairs_by_every_search(points);
    std::shuffle(points.candidates.begin(), points.candidates.end(), std::mt19937(3));
    expect_all_pairs_by_every_search(points);
}

TEST(NeighbourSearches, PointsThatAreNotFiniteHaveNoNeighbours) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Case points = random_points(100, 0.5, 0.5);
    points.x[7] = nan;
    points.y[20] = nan;
    points.x[33] = points.y[34] = infinity;
    points.x[35] = points.y[35] = -infinity;
    expect_all_pairs_by_every_search(points);
}

TEST(NeighbourSearches, OfPointsAsFarAwayAsNumbersGo) {
    constexpr double most = std::numeric_limits<double>::max();
    for (const double far : {1e17, 1e160, 1e300, most}) {
        Case points = random_points(60, 0.5, 0.5);
        for (int k = 0; k < 3; ++k) {
            points.add(far, -far);
            points.add(-far, 0.1);
            points.add(0.1, far);
        }
        expect_all_pairs_by_every_search(std::move(points).everyone());
        Case alone;
        alone.add(far, far);
        alone.add(-far, -far);
        expect_all_pairs_by_every_search(std::move(alone).everyone());
    }
}

TEST(NeighbourSearches, OfParticlesWithPeriodicCopiesAndMovedTargets) {
    const Case start = random_points(400, 1, 1);
    Particles particles;
    particles.fluid.resize(300);
    particles.dummies.resize(100);
    for (std::size_t k = 0; k < 400; ++k) {
        (k < 300 ? particles.fluid.x[k] : particles.dummies.x[k - 300]) = start.x[k];
        (k < 300 ? particles.fluid.y[k] : particles.dummies.y[k - 300]) = start.y[k];
    }
    constexpr double depth = 0.05;
    PeriodicRows rows;
    rows.rebuild(particles, {{-0.5, -0.5}, {0.5, 0.5}, {true, true}}, start.cutoff, start.cutoff + depth);
    Case fluid{{rows.x().begin(), rows.x().end()},
               {rows.y().begin(), rows.y().end()},
               rows.all_rows(),
               0,
               rows.fluid_count()};
    expect_all_pairs_by_every_search(fluid);
    Case dummies{fluid.x, fluid.y, rows.fluid_rows(), rows.fluid_count(), rows.particle_count()};
    for (std::size_t d = dummies.first; d < dummies.last; ++d) {
        dummies.y[d] += depth;
    }
    expect_all_pairs_by_every_search(dummies);
}

} // namespace
} // namespace slurry::testing
