#include "solver/loop/search_timing.hpp"

#include "solver/loop/neighbour_list.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

namespace slurry::testing {
namespace {

constexpr std::array sets{PointSet::uniform, PointSet::clustered};

TEST(SearchTiming, IsPositiveForEverySearchAndSet) {
    for (const auto set : sets) {
        for (const auto search :
             {NeighbourSearch::strips, NeighbourSearch::cells, NeighbourSearch::plane_sweep}) {
            EXPECT_GT(time_search(search, 500, set, 2), 0);
        }
    }
    EXPECT_THROW(time_search(NeighbourSearch::strips, 500, PointSet::uniform, 0), std::invalid_argument);
}

TEST(SearchTiming, ClustersAreMoreCrowdedThanTheLatticeButNotMoreSoForMorePoints) {
    const auto neighbours = [](PointSet set, std::size_t count) {
        const auto [x, y] = timing_points(set, count);
        std::vector<std::uint32_t> all(x.size());
        std::iota(all.begin(), all.end(), 0U);
        NeighbourList list(8, NeighbourSearch::strips);
        list.build(x, y, all, 0, count, static_cast<std::uint32_t>(count), search_timing_cutoff);
        return static_cast<double>(list.pairs()) / static_cast<double>(count);
    };
    for (const std::size_t count : {1000UL, 10'000UL, 100'000UL}) {
        EXPECT_GT(neighbours(PointSet::uniform, count), 30);
        EXPECT_LT(neighbours(PointSet::uniform, count), 36);
        EXPECT_GT(neighbours(PointSet::clustered, count), 50);
        EXPECT_LT(neighbours(PointSet::clustered, count), 150);
    }
}

} // namespace
} // namespace slurry::testing
