#pragma once
// A number that remembers how it came about: put in the place of a pack, it counts what the pair loop
// computes.
//
// The terms are written for reading and repeat themselves (every force names its weight again); the compiler
// does not. So operations are kept as a graph in which equal expressions are one node, and counted are the
// nodes that the results need and that differ from pair to pair: what is left in the loop without
// repetitions, without what is the same for all neighbours of a target, and without what nobody reads. No
// algebra is assumed.
#include "solver/loop/pack.hpp"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace slurry {

enum class OperationKind : std::uint8_t {
    invariant, // a number that stays while a target's neighbours are gone through
    variable,  // read from a neighbour's row
    add,
    subtract,
    multiply,
    divide,
    reciprocal,
    inverse_square_root,
    positive_part
};

struct OperationCounts {
    int additions = 0; // and subtractions
    int multiplications = 0;
    int fusable = 0; // additions that can take a multiplication along, as a fused multiply-add
    int divisions = 0;
    int reciprocals = 0;
    int inverse_square_roots = 0;
    int positive_parts = 0; // a maximum: an instruction, but no flop

    // Each operation is one flop, a fused multiply-add therefore two.
    [[nodiscard]] int flops() const {
        return additions + multiplications + divisions + reciprocals + inverse_square_roots;
    }
};

class OperationGraph {
  public:
    // A node that equals no other: an input.
    std::size_t add_input(OperationKind kind);
    std::size_t add_constant(double value);
    // The node of this operation, the one from before if it has been asked for already.
    std::size_t add_operation(OperationKind kind, std::size_t first, std::size_t second);
    // What the nodes `results` need for each pair.
    [[nodiscard]] OperationCounts count(std::span<const std::size_t> results) const;

  private:
    struct Operation {
        OperationKind kind;
        std::size_t first, second;
        auto operator<=>(const Operation&) const = default;
    };
    [[nodiscard]] std::vector<int> uses(std::span<const std::size_t> results) const;
    [[nodiscard]] int count_fusable(const std::vector<int>& uses) const;

    std::vector<Operation> nodes_; // an operation comes after its operands
    std::vector<bool> varies_;     // from pair to pair
    std::map<Operation, std::size_t> operations_;
    std::map<double, std::size_t> constants_;
};

struct Counted {
    double value = 0;
    OperationGraph* graph = nullptr; // none: a constant that has met no input yet
    std::size_t node = 0;

    Counted() = default;
    Counted(double constant) : value(constant) {} // implicit, as from a number to a pack
    Counted(double example, OperationGraph& where, OperationKind input)
        : value(example), graph(&where), node(where.add_input(input)) {}

    // One operand is named twice where an operation has only one.
    static Counted made(double value, OperationKind kind, const Counted& a, const Counted& b);

    friend Counted operator+(const Counted& a, const Counted& b) {
        return made(a.value + b.value, OperationKind::add, a, b);
    }
    friend Counted operator-(const Counted& a, const Counted& b) {
        return made(a.value - b.value, OperationKind::subtract, a, b);
    }
    friend Counted operator*(const Counted& a, const Counted& b) {
        return made(a.value * b.value, OperationKind::multiply, a, b);
    }
    friend Counted operator/(const Counted& a, const Counted& b) {
        return made(a.value / b.value, OperationKind::divide, a, b);
    }
    Counted& operator+=(const Counted& other) { return *this = *this + other; }
    Counted& operator-=(const Counted& other) { return *this = *this - other; }
    // Comparisons choose by the example's value and count nothing.
    friend auto operator<=>(const Counted& a, const Counted& b) { return a.value <=> b.value; }
};

// In the place of the templates of solver/loop/pack.hpp.
template <> struct ElementOf<Counted> { using type = double; };
Counted reciprocal(const Counted& x);
Counted inverse_square_root(const Counted& x);
Counted positive_part(const Counted& x);

} // namespace slurry
