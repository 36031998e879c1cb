#include "solver/loop/plane_sweep.hpp"

#include "solver/loop/packed_points.hpp"

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <numeric>
#include <set>

namespace slurry {

namespace {

using Indices = std::vector<std::uint32_t>;

// The finite ones of the points, by x.
Indices swept(const SearchProblem& problem, Indices indices) {
    std::erase_if(indices, [&](auto index) {
        return !std::isfinite(problem.x[index]) || !std::isfinite(problem.y[index]);
    });
    std::sort(indices.begin(), indices.end(), [&](auto a, auto b) { return problem.x[a] < problem.x[b]; });
    return indices;
}

} // namespace

PlaneSweep::PlaneSweep(const SearchProblem& problem)
    : first_target_(problem.first), lists_(problem.last - problem.first) {
    const auto& [x, y, listed, first, last, cutoff, row_height] = problem;
    const double reach = cutoff * (1 + 1e-6);
    const Indices candidates = swept(problem, {listed.begin(), listed.end()});
    Indices targets(last - first);
    std::iota(targets.begin(), targets.end(), static_cast<std::uint32_t>(first));
    targets = swept(problem, std::move(targets));

    std::pmr::unsynchronized_pool_resource pool;
    std::pmr::set<std::pair<double, std::uint32_t>> active(&pool); // y, index
    auto entering = candidates.begin();
    auto leaving = candidates.begin();
    Indices window;
    PackedPoints points;
    for (const auto target : targets) {
        for (; entering != candidates.end() && x[*entering] <= x[target] + reach; ++entering) {
            active.emplace(y[*entering], *entering);
        }
        for (; leaving != entering && x[*leaving] < x[target] - reach; ++leaving) {
            active.erase({y[*leaving], *leaving});
        }
        window.clear();
        for (auto other = active.lower_bound({y[target] - reach, 0});
             other != active.end() && other->first <= y[target] + reach; ++other) {
            window.push_back(other->second);
        }
        points.resize(window.size());
        for (std::size_t slot = 0; slot < window.size(); ++slot) {
            points.set(slot, x[window[slot]], y[window[slot]], window[slot]);
        }
        const Window all{0, static_cast<std::uint32_t>(window.size())};
        points.append_near({x[target], y[target], target}, std::span(&all, 1), cutoff * cutoff, found_);
    }
    for (std::size_t k = 0; k < targets.size(); ++k) {
        lists_[targets[k] - first] = found_.list(k);
    }
}

void PlaneSweep::find(std::size_t first, std::size_t last, NeighbourLists& lists) const {
    lists.ends.clear();
    for (std::size_t target = first; target < last; ++target) {
        const auto& list = lists_[target - first_target_];
        const std::size_t size = lists.size();
        lists.entries.resize(std::max(lists.entries.size(), size + list.size()));
        std::copy(list.begin(), list.end(), lists.entries.begin() + static_cast<std::ptrdiff_t>(size));
        lists.ends.push_back(size + list.size());
    }
}

} // namespace slurry
