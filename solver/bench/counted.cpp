#include "solver/bench/counted.hpp"

#include <algorithm>
#include <cmath>

namespace slurry {

namespace {

bool is_operation(OperationKind kind) {
    return kind != OperationKind::invariant && kind != OperationKind::variable;
}

bool is_sum(OperationKind kind) {
    return kind == OperationKind::add || kind == OperationKind::subtract;
}

} // namespace

std::size_t OperationGraph::add_input(OperationKind kind) {
    nodes_.push_back({kind, nodes_.size(), nodes_.size()});
    varies_.push_back(kind == OperationKind::variable);
    return nodes_.size() - 1;
}

std::size_t OperationGraph::add_constant(double value) {
    const auto known = constants_.find(value);
    return known != constants_.end() ? known->second
                                     : constants_[value] = add_input(OperationKind::invariant);
}

std::size_t OperationGraph::add_operation(OperationKind kind, std::size_t first, std::size_t second) {
    const bool commutes = kind == OperationKind::add || kind == OperationKind::multiply;
    const Operation operation{kind, commutes ? std::min(first, second) : first,
                              commutes ? std::max(first, second) : second};
    const auto [place, is_new] = operations_.try_emplace(operation, nodes_.size());
    if (is_new) {
        nodes_.push_back(operation);
        varies_.push_back(varies_[first] || varies_[second]);
    }
    return place->second;
}

// How often each node is an operand (or a result) of what the results need for each pair.
std::vector<int> OperationGraph::uses(std::span<const std::size_t> results) const {
    std::vector<int> uses(nodes_.size(), 0);
    for (const std::size_t result : results) {
        ++uses[result];
    }
    for (std::size_t node = nodes_.size(); node-- > 0;) {
        const Operation& operation = nodes_[node];
        if (uses[node] > 0 && varies_[node] && is_operation(operation.kind)) {
            ++uses[operation.first];
            ++uses[operation.second];
        }
    }
    return uses;
}

OperationCounts OperationGraph::count(std::span<const std::size_t> results) const {
    const std::vector<int> used = uses(results);
    OperationCounts counts;
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        const OperationKind kind = nodes_[node].kind;
        const int times = used[node] > 0 && varies_[node] ? 1 : 0;
        counts.additions += is_sum(kind) ? times : 0;
        counts.multiplications += kind == OperationKind::multiply ? times : 0;
        counts.divisions += kind == OperationKind::divide ? times : 0;
        counts.reciprocals += kind == OperationKind::reciprocal ? times : 0;
        counts.inverse_square_roots += kind == OperationKind::inverse_square_root ? times : 0;
        counts.positive_parts += kind == OperationKind::positive_part ? times : 0;
    }
    counts.fusable = count_fusable(used);
    return counts;
}

// A multiplication with a single use is saved when that is a sum; a sum takes one along.
int OperationGraph::count_fusable(const std::vector<int>& uses) const {
    const auto fuses = [&](std::size_t operand) {
        return nodes_[operand].kind == OperationKind::multiply && uses[operand] == 1 && varies_[operand];
    };
    int fusable = 0;
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        const Operation& operation = nodes_[node];
        if (uses[node] > 0 && is_sum(operation.kind) && (fuses(operation.first) || fuses(operation.second))) {
            ++fusable;
        }
    }
    return fusable;
}

Counted Counted::made(double value, OperationKind kind, const Counted& a, const Counted& b) {
    OperationGraph* graph = a.graph != nullptr ? a.graph : b.graph;
    Counted result(value);
    if (graph != nullptr) {
        const auto node_of = [&](const Counted& x) {
            return x.graph != nullptr ? x.node : graph->add_constant(x.value);
        };
        result.graph = graph;
        result.node = graph->add_operation(kind, node_of(a), node_of(b));
    }
    return result;
}

Counted reciprocal(const Counted& x) {
    return Counted::made(1 / x.value, OperationKind::reciprocal, x, x);
}

Counted inverse_square_root(const Counted& x) {
    return Counted::made(1 / std::sqrt(x.value), OperationKind::inverse_square_root, x, x);
}

Counted positive_part(const Counted& x) {
    return Counted::made(std::max(x.value, 0.0), OperationKind::positive_part, x, x);
}

} // namespace slurry
