#include "solver/converge/estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace slurry {
namespace {

// truth + coefficient h^order at h = 2 * 1e-6, sqrt(2) times finer each time, with normal noise.
std::vector<GridValue> manufactured(double truth, double coefficient, double order, int count = 3,
                                    double noise = 0, unsigned seed = 1) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0, 1);
    std::vector<GridValue> values;
    for (int k = 0; k < count; ++k) {
        const double h = std::pow(2, 1 - 0.5 * k);
        values.push_back(
            {h * 1e-6, truth + coefficient * std::pow(h, order) + noise * normal(generator), noise});
    }
    return values;
}

double true_error(const std::vector<GridValue>& values, double truth) {
    return std::abs(values.back().value - truth);
}

class ManufacturedOrder : public ::testing::TestWithParam<double> {};

TEST_P(ManufacturedOrder, IsFoundAndExtrapolatesToTheTruth) {
    for (const int count : {3, 5}) {
        const auto values = manufactured(7, -0.3, GetParam(), count);
        const Estimate estimate = estimate_error(values);
        EXPECT_EQ(estimate.verdict, Verdict::converging);
        EXPECT_NEAR(estimate.order, GetParam(), 0.011);
        EXPECT_NEAR(estimate.extrapolated, 7, 0.005);
        EXPECT_NEAR(estimate.band(), 1.25 * true_error(values, 7), 0.02 * true_error(values, 7) + 0.006);
    }
}
INSTANTIATE_TEST_SUITE_P(Orders, ManufacturedOrder, ::testing::Values(0.75, 1.0, 1.5, 1.98));

TEST(Estimate, AnOrderAboveTheSchemesIsNotExtrapolatedWith) {
    const auto values = manufactured(7, 0.3, 4);
    const Estimate estimate = estimate_error(values);
    EXPECT_EQ(estimate.verdict, Verdict::converging);
    EXPECT_NEAR(estimate.order, 4, 0.011);
    EXPECT_EQ(estimate.order_used, 2);
    EXPECT_GT(estimate.band(), true_error(values, 7));
}

TEST(Estimate, TheBandCoversTheTruthUnderNoise) {
    for (const int count : {3, 5}) {
        for (const double order : {1.0, 1.5, 2.0}) {
            for (const double noise : {0.001, 0.003, 0.01}) { // the error is 0.05
                constexpr int samples = 60;
                int covered = 0, banded = 0;
                for (unsigned seed = 0; seed < samples; ++seed) {
                    const auto values = manufactured(7, 0.05, order, count, noise, seed);
                    const Estimate estimate = estimate_error(values);
                    banded += estimate.verdict != Verdict::diverging ? 1 : 0;
                    covered += true_error(values, 7) <= estimate.band() ? 1 : 0; // NaN covers nothing
                }
                EXPECT_GE(covered, 0.9 * banded) << count << " spacings, order " << order << ", " << noise;
                EXPECT_GE(banded, 0.7 * samples) << count << " spacings, order " << order << ", " << noise;
            }
        }
    }
}

TEST(Estimate, NoiseAloneIsSettledAndItsBandIsOfItsSize) {
    const Estimate estimate =
        estimate_error(std::vector<GridValue>{{2, 5.01, 0.02}, {1.4, 4.99, 0.02}, {1, 5, 0.02}});
    EXPECT_EQ(estimate.verdict, Verdict::settled);
    EXPECT_TRUE(std::isnan(estimate.order));
    EXPECT_NEAR(estimate.band(), 0.06, 1e-12);
}

TEST(Estimate, EqualValuesHaveNoError) {
    const Estimate estimate = estimate_error(std::vector<GridValue>{{2, 5, 0}, {1.4, 5, 0}, {1, 5, 0}});
    EXPECT_EQ(estimate.verdict, Verdict::settled);
    EXPECT_EQ(estimate.band(), 0);
}

TEST(Estimate, DifferencesThatGrowAreRefused) {
    const Estimate monotone =
        estimate_error(std::vector<GridValue>{{2, 5, 0.01}, {1.4, 5.1, 0.01}, {1, 5.4, 0.01}});
    EXPECT_EQ(monotone.verdict, Verdict::diverging);
    EXPECT_TRUE(std::isnan(monotone.band()));
    const Estimate to_and_fro =
        estimate_error(std::vector<GridValue>{{2, 5, 0.01}, {1.4, 5.1, 0.01}, {1, 4.6, 0.01}});
    EXPECT_EQ(to_and_fro.verdict, Verdict::diverging);
}

TEST(Estimate, DifferencesWithoutAnOrderHaveABandButNoExtrapolation) {
    const Estimate estimate =
        estimate_error(std::vector<GridValue>{{2, 5.2, 0.01}, {1.4, 5, 0.01}, {1, 5.1, 0.01}});
    EXPECT_EQ(estimate.verdict, Verdict::scattered);
    EXPECT_TRUE(std::isnan(estimate.extrapolated));
    EXPECT_GE(estimate.band(), 0.4);
}

TEST(Estimate, RefusesWhatItCannotJudge) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using Values = std::vector<GridValue>;
    EXPECT_THROW(static_cast<void>(estimate_error(Values{{2, 5, 0}, {1, 5, 0}})), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(estimate_error(Values{{2, 5, 0}, {1.4, nan, 0}, {1, 5, 0}})),
                 std::invalid_argument);
    EXPECT_THROW(static_cast<void>(estimate_error(Values{{1, 5, 0}, {1.4, 5, 0}, {2, 5, 0}})),
                 std::invalid_argument);
}

} // namespace
} // namespace slurry
