#pragma once
// The pair loop: for W targets at once, over their neighbours, the sums of a composition of terms.
//
// A term is a struct with
//   template <class P> struct Sums { P ... ; };              accumulators, zero-initialised
//   add(Sums<P>&, const Pair<P>&, const View<P>& i, const View<P>& j)   one pair
//   finish(const Sums<P>&, const View<P>& i, const Coefficients&, Result<P>&)   after the last neighbour
// where View names the fields of the pass's rows. What a composition does not name is not compiled into its
// loop. A term whose finish takes the sums as a template parameter can read those of the others.
#include "solver/loop/neighbour_list.hpp"
#include "solver/loop/pair.hpp"
#include "solver/loop/row.hpp"

#include <array>
#include <span>

namespace slurry {

template <class P, class... Terms> struct AllSums : Terms::template Sums<P>... {};

template <class... Terms> struct Composition {
    template <class P, class View>
    static void add(AllSums<P, Terms...>& sums, const Pair<P>& pair, const View& i, const View& j) {
        (Terms::add(static_cast<typename Terms::template Sums<P>&>(sums), pair, i, j), ...);
    }
    template <class P, class View, class Coefficients, class Result>
    static void finish(const AllSums<P, Terms...>& sums, const View& i, const Coefficients& coefficients,
                       Result& result) {
        (Terms::finish(sums, i, coefficients, result), ...);
    }
};

// One block of W targets. Flattened: a call inside the loop would send its vectors through memory. Rows are
// gathered one pair ahead, and two pairs make a round: else the processor waits for one pair's chain of
// operations before it has seen enough of the next, or spends its instructions on copies between registers.
template <class Real, int W, class Kernel, template <class> class View, template <class> class Result,
          class Coefficients, class... Terms>
[[gnu::flatten]] Result<Pack<Real, W>> sweep_block(Composition<Terms...> /*which*/, const NeighbourList& list,
                                                   std::size_t block, const Row<Real>* rows,
                                                   const Coefficients& coefficients) {
    using P = Pack<Real, W>;
    std::array<std::uint32_t, W> targets;
    for (std::size_t lane = 0; lane < W; ++lane) {
        targets[lane] = list.target(block, lane);
    }
    const View<P> i{gather<Real, W>(rows, targets.data())};
    AllSums<P, Terms...> sums{};
    const auto add = [&](const View<P>& j) {
        const Pair<P> pair = make_pair<Kernel>(P(i.x() - j.x()), P(i.y() - j.y()));
        Composition<Terms...>::add(sums, pair, i, j);
    };
    const std::uint32_t* neighbours = list.neighbours(block);
    std::size_t left = list.count(block);
    if (left > 0) {
        View<P> first{gather<Real, W>(rows, neighbours)};
        for (; left > 2; left -= 2) {
            const View<P> second{gather<Real, W>(rows, neighbours += W)};
            add(first);
            first = {gather<Real, W>(rows, neighbours += W)};
            add(second);
        }
        if (left == 2) {
            const View<P> second{gather<Real, W>(rows, neighbours + W)};
            add(first);
            add(second);
        } else {
            add(first);
        }
    }
    Result<P> result{};
    Composition<Terms...>::finish(sums, i, coefficients, result);
    return result;
}

// Calls store_result(first target, results of W targets) for every block. A thread owns whole blocks, so that
// nothing depends on the number of threads.
template <class Real, int W, class Kernel, template <class> class View, template <class> class Result,
          class Coefficients, class... Terms, class StoreResult>
void sweep(Composition<Terms...> which, const NeighbourList& list, std::span<const Row<Real>> rows,
           const Coefficients& coefficients, StoreResult&& store_result) {
    const auto blocks = static_cast<std::ptrdiff_t>(list.block_count());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t signed_block = 0; signed_block < blocks; ++signed_block) {
        const auto block = static_cast<std::size_t>(signed_block);
        store_result(block * static_cast<std::size_t>(W), sweep_block<Real, W, Kernel, View, Result>(
                                                              which, list, block, rows.data(), coefficients));
    }
}

} // namespace slurry
