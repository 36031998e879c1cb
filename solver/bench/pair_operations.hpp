#pragma once
// What one pair of a sweep computes, counted by running its own code.
#include "solver/bench/counted.hpp"
#include "solver/loop/sweep.hpp"

#include <array>
#include <bit>

namespace slurry {

// From two rows to the terms' sums: distance, kernel, terms. `finish` and the loading of rows are not in it.
template <class Kernel, template <class> class View, class... Terms>
OperationCounts count_pair_operations(Composition<Terms...> /*which*/) {
    OperationGraph graph;
    const auto row = [&](OperationKind kind, double example) {
        Fields<Counted> fields;
        for (Counted& field : fields) {
            field = Counted(example, graph, kind);
        }
        return View<Counted>{fields};
    };
    const auto i = row(OperationKind::invariant, 1);
    const auto j = row(OperationKind::variable, 2);
    const auto pair = make_pair<Kernel>(Counted(i.x() - j.x()), Counted(i.y() - j.y()));
    using Sums = AllSums<Counted, Terms...>;
    Sums sums{};
    Composition<Terms...>::add(sums, pair, i, j);
    static_assert(sizeof(Sums) % sizeof(Counted) == 0, "sums hold packs only");
    std::vector<std::size_t> results;
    for (const Counted& sum : std::bit_cast<std::array<Counted, sizeof(Sums) / sizeof(Counted)>>(sums)) {
        if (sum.graph != nullptr) { // else no pair adds to it
            results.push_back(sum.node);
        }
    }
    return graph.count(results);
}

} // namespace slurry
