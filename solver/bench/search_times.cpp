#include "solver/bench/search_times.hpp"

#include "solver/loop/search_timing.hpp"

#include <omp.h>

#include <array>
#include <utility>

namespace slurry {

namespace {

constexpr std::array searches{std::pair{NeighbourSearch::strips, "strips"},
                              std::pair{NeighbourSearch::cells, "cells"},
                              std::pair{NeighbourSearch::plane_sweep, "plane_sweep"}};
constexpr std::array sets{std::pair{PointSet::uniform, "uniform"},
                          std::pair{PointSet::clustered, "clustered"}};

std::vector<std::size_t> point_counts(bool quick) {
    return quick ? std::vector<std::size_t>{1000}
                 : std::vector<std::size_t>{1000, 10'000, 100'000, 1'000'000, 4'000'000};
}

} // namespace

std::vector<SearchTime> time_searches(int cores, bool quick) {
    const int before = omp_get_max_threads();
    std::vector<SearchTime> times;
    for (const auto& [search, name] : searches) {
        for (const auto& [set, set_name] : sets) {
            for (const std::size_t points : point_counts(quick)) {
                if (search == NeighbourSearch::plane_sweep && points > 1'000'000) {
                    continue;
                }
                for (const int threads : cores > 1 ? std::vector{1, cores} : std::vector{1}) {
                    if (threads > 1 && search != NeighbourSearch::strips) {
                        continue;
                    }
                    omp_set_num_threads(threads);
                    const int repetitions = points > 100'000 ? 1 : 5;
                    times.push_back(
                        {name, set_name, points, threads, time_search(search, points, set, repetitions)});
                }
            }
        }
    }
    omp_set_num_threads(before);
    return times;
}

} // namespace slurry
