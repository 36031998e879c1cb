// Packs and rows: what the pair loop does with whole vectors, against plain numbers.
#include "solver/loop/pack.hpp"

#include "solver/loop/row.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace slurry {
namespace {

template <class Real> std::vector<Row<Real>> numbered_rows(std::size_t count) {
    std::vector<Row<Real>> rows(count);
    for (std::size_t r = 0; r < count; ++r) {
        for (std::size_t f = 0; f < row_fields; ++f) {
            rows[r].field[f] = static_cast<Real>(10 * r + f);
        }
    }
    return rows;
}

template <class Real, int W> void expect_gather_matches_indexing() {
    const auto rows = numbered_rows<Real>(40);
    std::mt19937 generator(W);
    std::uniform_int_distribution<std::uint32_t> any(0, 39);
    for (int trial = 0; trial < 20; ++trial) {
        std::array<std::uint32_t, W> indices{};
        for (auto& index : indices) {
            index = any(generator);
        }
        std::array<std::uint32_t, W> offsets{};
        std::transform(indices.begin(), indices.end(), offsets.begin(), [](std::uint32_t index) {
            return index * static_cast<std::uint32_t>(sizeof(Row<Real>));
        });
        const auto fields = gather<Real, W>(rows.data(), offsets.data());
        for (std::size_t f = 0; f < row_fields; ++f) {
            std::array<Real, W> lanes{};
            store(lanes.data(), fields[f]);
            for (std::size_t lane = 0; lane < W; ++lane) {
                EXPECT_EQ(lanes[lane], rows[indices[lane]].field[f]) << "field " << f << ", lane " << lane;
            }
        }
    }
}

TEST(Gather, PlainNumbers) {
    expect_gather_matches_indexing<double, 1>();
}
TEST(Gather, NativeWidthOfDouble) {
    expect_gather_matches_indexing<double, native_lanes<double>>();
}
TEST(Gather, NativeWidthOfFloat) {
    expect_gather_matches_indexing<float, native_lanes<float>>();
}
#ifdef __AVX__ // else vectors of this width are split, and GCC warns that passing them changes the ABI
TEST(Gather, FourDoublesAreTransposed) {
    expect_gather_matches_indexing<double, 4>();
}
TEST(Gather, EightFloatsAreTransposed) {
    expect_gather_matches_indexing<float, 8>();
}
#endif
#ifdef __AVX512F__
TEST(Gather, EightDoublesAreTransposed) {
    expect_gather_matches_indexing<double, 8>();
}
TEST(Gather, SixteenFloatsAreTransposed) {
    expect_gather_matches_indexing<float, 16>();
}
#endif

TEST(InverseSquareRoot, IsAccurateOverManyMagnitudes) {
    using P = Pack<double, native_lanes<double>>;
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> exponent(-80, 80);
    for (int trial = 0; trial < 20000; ++trial) {
        std::array<double, native_lanes<double>> x{};
        for (double& value : x) {
            value = std::pow(10, exponent(generator));
        }
        std::array<double, native_lanes<double>> y{};
        store(y.data(), inverse_square_root(load<P>(x.data())));
        for (std::size_t lane = 0; lane < x.size(); ++lane) {
            ASSERT_NEAR(y[lane] * std::sqrt(x[lane]), 1, 1e-15) << x[lane];
        }
    }
}

TEST(InverseSquareRoot, IsAccurateAtPowersOfTwoWhereTheEstimateChangesTables) {
    using P = Pack<double, native_lanes<double>>;
    for (int power = -200; power <= 200; ++power) {
        const double below = std::nextafter(std::ldexp(1.0, power), 0);
        for (const double x : {below, std::ldexp(1.0, power), std::ldexp(1.5, power)}) {
            const P y = inverse_square_root(P{} + x);
            double first = 0;
            std::memcpy(&first, &y, sizeof(first));
            ASSERT_NEAR(first * std::sqrt(x), 1, 1e-15) << x;
        }
    }
}

TEST(PositivePart, CutsNegativeNumbersInEveryLane) {
    using P = Pack<double, native_lanes<double>>;
    std::array<double, native_lanes<double>> x{};
    for (std::size_t lane = 0; lane < x.size(); ++lane) {
        x[lane] = lane % 2 == 0 ? -1.0 - static_cast<double>(lane) : 1.0 + static_cast<double>(lane);
    }
    std::array<double, native_lanes<double>> y{};
    store(y.data(), positive_part(load<P>(x.data())));
    for (std::size_t lane = 0; lane < x.size(); ++lane) {
        EXPECT_EQ(y[lane], std::max(x[lane], 0.0));
    }
}

} // namespace
} // namespace slurry
