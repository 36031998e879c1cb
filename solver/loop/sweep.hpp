#pragma once
// The pair loop: for W targets at once, over their neighbours, the sums of a composition of terms.
//
// A term is a struct with
//   template <class P> struct Sums { P ... ; };              accumulators, zero-initialised
//   add(Sums<P>&, const Pair<P>&, const View<P>& i, const View<P>& j)   one pair
//   finish(const Sums<P>&, const View<P>& i, const Coefficients&, Result<P>&)   after the last neighbour
// where View names the fields of the pass's rows. What a composition does not name is not compiled into its loop.
#include "solver/loop/neighbour_list.hpp"
#include "solver/loop/pair.hpp"
#include "solver/loop/row.hpp"

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
        (Terms::finish(static_cast<const typename Terms::template Sums<P>&>(sums), i, coefficients, result), ...);
    }
};

template <class Real, int W, class Kernel, template <class> class View, template <class> class Result, class Coefficients,
          class... Terms, class StoreResult>
void sweep(Composition<Terms...> /*which*/, const NeighbourList& list, std::span<const Row<Real>> rows,
           const KernelScale<Real>& scale, const Coefficients& coefficients, StoreResult&& store_result) {
    using P = Pack<Real, W>;
    const auto blocks = static_cast<std::ptrdiff_t>(list.block_count());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t block = 0; block < blocks; ++block) {
        const auto b = static_cast<std::size_t>(block);
        const View<P> i{gather<Real, W>(rows.data(), list.targets(b))};
        AllSums<P, Terms...> sums{};
        const std::uint32_t* neighbours = list.neighbours(b);
        const std::size_t count = list.count(b);
        for (std::size_t k = 0; k < count; ++k, neighbours += W) {
            const View<P> j{gather<Real, W>(rows.data(), neighbours)};
            const Pair<P> pair = make_pair<Kernel>(scale, i.x() - j.x(), i.y() - j.y());
            Composition<Terms...>::add(sums, pair, i, j);
        }
        Result<P> result{};
        Composition<Terms...>::finish(sums, i, coefficients, result);
        store_result(b * static_cast<std::size_t>(W), result);
    }
}

} // namespace slurry
