// Counts of operations, against counts by hand.
#include "solver/bench/counted.hpp"

#include "solver/bench/pair_operations.hpp"
#include "solver/terms/views.hpp"

#include <gtest/gtest.h>

namespace slurry {
namespace {

void expect_counts(const OperationCounts& found, const OperationCounts& expected) {
    EXPECT_EQ(found.additions, expected.additions);
    EXPECT_EQ(found.multiplications, expected.multiplications);
    EXPECT_EQ(found.fusable, expected.fusable);
    EXPECT_EQ(found.divisions, expected.divisions);
    EXPECT_EQ(found.reciprocals, expected.reciprocals);
    EXPECT_EQ(found.inverse_square_roots, expected.inverse_square_roots);
    EXPECT_EQ(found.positive_parts, expected.positive_parts);
}

struct Inputs {
    OperationGraph graph;
    Counted i{2, graph, OperationKind::invariant};
    Counted x{3, graph, OperationKind::variable};
    Counted y{5, graph, OperationKind::variable};

    OperationCounts count(std::initializer_list<Counted> results) const {
        std::vector<std::size_t> nodes;
        for (const Counted& result : results) {
            nodes.push_back(result.node);
        }
        return graph.count(nodes);
    }
};

TEST(Counted, CalculatesAsNumbersDo) {
    const Inputs in;
    EXPECT_EQ((2 * in.i - in.x / in.y + 1).value, 2 * 2.0 - 3.0 / 5 + 1);
    EXPECT_EQ(inverse_square_root(Counted(4)).value, 0.5);
    EXPECT_EQ(positive_part(in.x - in.y).value, 0);
    EXPECT_GT(in.y, in.x);
}

TEST(Counted, CountsEachOperationOnce) {
    const Inputs in;
    const Counted sum = positive_part(in.x - 1) / inverse_square_root(in.y) + in.x * in.y;
    expect_counts(in.count({sum}), {.additions = 2,
                                    .multiplications = 1,
                                    .fusable = 1,
                                    .divisions = 1,
                                    .inverse_square_roots = 1,
                                    .positive_parts = 1});
    EXPECT_EQ(in.count({sum}).flops(), 5);
}

TEST(Counted, LeavesOutRepetitionsInvariantsAndWhatNobodyReads) {
    const Inputs in;
    const Counted unread = in.x / in.y;
    EXPECT_GT(unread.value, 0);
    const Counted once = in.x * in.y;
    const Counted again = in.y * in.x;
    const Counted weight = (in.i * in.i + 1) * once;
    expect_counts(in.count({weight, again}), {.multiplications = 2});
    expect_counts(in.count({in.i / 3}), {});
}

TEST(Counted, FusesAMultiplicationOnlyIntoTheSumThatAloneNeedsIt) {
    const Inputs in;
    const Counted product = in.x * in.y;
    expect_counts(in.count({product + in.x}), {.additions = 1, .multiplications = 1, .fusable = 1});
    expect_counts(in.count({product + in.x, product}), {.additions = 1, .multiplications = 1});
    // A sum takes one of two along.
    expect_counts(in.count({product + in.x * in.i}), {.additions = 1, .multiplications = 2, .fusable = 1});
}

struct HatKernel {
    template <class P> static P value(const P& s) { return positive_part(1 - s * inverse_square_root(s)); }
    template <class P> static P slope(const P& s) { return s * s; }
};

struct Approach {
    template <class P> struct Sums { P approach{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        sums.approach += (i.velocity_x() - j.velocity_x()) * pair.dx;
    }
};

struct KernelSum {
    template <class P> struct Sums { P kernel{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& /*unused*/,
                    const RateView<P>& /*unused*/) {
        sums.kernel += pair.kernel;
    }
};

TEST(PairOperations, OfATermWithoutKernel) {
    // x_i - x_j, u_i - u_j, their product, and the sum; nothing of dy, distance and kernel
    expect_counts(count_pair_operations<HatKernel, RateView>(Composition<Approach>{}),
                  {.additions = 3, .multiplications = 1, .fusable = 1});
}

TEST(PairOperations, OfTwoTermsShareThePair) {
    // dx and dy 2, their squares 2 and the sums with the softening 2, root 1, q 1, 1 - q 1, maximum 1,
    // sum 1; of the slope nothing. Approach adds u_i - u_j, a product and a sum.
    const OperationCounts kernel = count_pair_operations<HatKernel, RateView>(Composition<KernelSum>{});
    EXPECT_EQ(kernel.flops(), 10);
    EXPECT_EQ(kernel.positive_parts, 1);
    EXPECT_EQ(kernel.inverse_square_roots, 1);
    EXPECT_EQ((count_pair_operations<HatKernel, RateView>(Composition<KernelSum, Approach>{}).flops()), 13);
}

} // namespace
} // namespace slurry
