#pragma once
// How many of the pairs that a sweep goes through are within the kernel's support.
#include "solver/loop/sweep.hpp"

namespace slurry {

template <class P> struct PairCount { P within; };

struct CountPairs {
    template <class P> struct Sums { P within{}; };
    template <class P, class View>
    static void add(Sums<P>& sums, const Pair<P>& pair, const View& /*unused*/, const View& /*unused*/) {
        const P zero{};
        sums.within += pair.kernel > zero ? zero + 1 : zero;
    }
    template <class P, class View>
    static void finish(const Sums<P>& sums, const View& /*unused*/, int /*no coefficients*/,
                       PairCount<P>& result) {
        result.within = sums.within;
    }
};

// Of the list's first `targets` targets, with the rows' positions.
template <class Real, int W, class Kernel, template <class> class View>
std::size_t count_pairs(const NeighbourList& list, const Row<Real>* rows, std::size_t targets) {
    std::size_t count = 0;
    for (std::size_t block = 0; block < list.block_count(); ++block) {
        const auto pairs =
            sweep_block<Real, W, Kernel, View, PairCount>(Composition<CountPairs>{}, list, block, rows, 0);
        std::array<Real, W> lanes;
        store(lanes.data(), pairs.within);
        for (std::size_t lane = 0; lane < W && block * W + lane < targets; ++lane) {
            count += static_cast<std::size_t>(lanes[lane]);
        }
    }
    return count;
}

} // namespace slurry
