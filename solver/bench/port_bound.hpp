#pragma once
// The fewest cycles in which a core could get through the pairs of a sweep: every execution port that is
// short works in every cycle, and nothing waits for memory or for an earlier result.
//
// The core is one of Intel's since Haswell: two ports do arithmetic and a third one shuffles; with 512 bits
// there are only two, one of which shuffles as well; two loads a cycle. Counted are, for as many pairs as a
// vector has lanes:
// - the operations of the terms (solver/bench/counted.hpp), a multiplication that an addition can take along
//   being free;
// - 1 / sqrt and 1 / x as the hardware's estimate and Newton steps of four and two instructions, one step for
//   float and two for double;
// - divisions with the time that they occupy the divider (Ice Lake, uops.info);
// - the registers' transposition: `row_fields` instructions for each halving of the lanes. The fourth halving
//   (16 lanes) joins halves while they are loaded and needs no shuffle, but takes a port;
// - loads: each row, in as many pieces as it is vectors long, and each index.
// Real loops also pay for latencies, loop counters, and what `finish` does.
#include "solver/bench/counted.hpp"
#include "solver/loop/row.hpp"

#include <algorithm>
#include <bit>

namespace slurry {

#ifdef __FMA__
inline constexpr bool fuses_multiply_add = true;
#else
inline constexpr bool fuses_multiply_add = false;
#endif

// Vector instructions a cycle in the loop that measures the peak.
inline constexpr int arithmetic_ports = 2;

// Cycles for native_lanes<Real> pairs.
template <class Real> double port_bound_cycles(const OperationCounts& operations) {
    constexpr std::size_t lanes = native_lanes<Real>;
    constexpr bool single = sizeof(Real) == sizeof(float);
    constexpr int newton_steps = single ? 1 : 2;
    constexpr int inverse_square_root = 1 + 4 * newton_steps;
    constexpr int reciprocal = 1 + 2 * newton_steps;
    constexpr int halvings = std::bit_width(lanes) - 1;
    constexpr int shuffled_halvings = std::min(halvings, 3);
    constexpr double shuffles = row_fields * shuffled_halvings;
    constexpr double joins = row_fields * (halvings - shuffled_halvings);
    constexpr std::size_t pieces = std::max<std::size_t>(1, sizeof(Row<Real>) / vector_bytes);
    constexpr double loads = lanes * pieces + lanes;
    constexpr double division_cycles = lanes * (single ? 5.0 / 8 : 2.0);

    const double arithmetic = joins + operations.additions + operations.multiplications -
                              (fuses_multiply_add ? operations.fusable : 0) + operations.positive_parts +
                              operations.divisions + operations.reciprocals * reciprocal +
                              operations.inverse_square_roots * inverse_square_root;
    const double ports = vector_bytes == 64
                             ? (arithmetic + shuffles) / 2
                             : std::max(arithmetic / arithmetic_ports, (arithmetic + shuffles) / 3);
    return std::max({ports, shuffles, loads / 2, operations.divisions * division_cycles});
}

} // namespace slurry
