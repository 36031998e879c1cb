#include "solver/converge/steadiness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace slurry {
namespace {

struct Series {
    std::vector<double> time, value;
};

// 100 samples over 10 s.
template <class Of> Series sampled(Of of) {
    Series series;
    for (int k = 0; k <= 100; ++k) {
        series.time.push_back(0.1 * k);
        series.value.push_back(of(0.1 * k));
    }
    return series;
}

Series noisy_start_up(double relaxation_time, double noise) {
    std::mt19937 generator(5);
    std::normal_distribution<double> normal(0, noise);
    return sampled([&](double t) { return 3 - 3 * std::exp(-t / relaxation_time) + normal(generator); });
}

TEST(Steadiness, StartsWhereTheTransientIsLostInTheNoise) {
    const Series series = noisy_start_up(0.5, 0.01);
    const double from = steady_from(series.time, series.value);
    EXPECT_GT(from, 0.5 * std::log(3 / 0.05));
    EXPECT_LT(from, 7);
    const Reading mean = mean_from(series.time, series.value, from);
    EXPECT_NEAR(mean.value, 3, 3 * 0.01 / std::sqrt(30));
    EXPECT_GT(mean.noise, 0.0003);
    EXPECT_LT(mean.noise, 0.005);
}

TEST(Steadiness, WhatStillDriftsIsNotSteady) {
    const Series decay = sampled([](double t) { return std::exp(-t / 10); });
    EXPECT_TRUE(std::isnan(steady_from(decay.time, decay.value)));
    const Series ramp = sampled([](double t) { return t; });
    EXPECT_TRUE(std::isnan(steady_from(ramp.time, ramp.value)));
    const Series slow = noisy_start_up(5, 0.01);
    EXPECT_TRUE(std::isnan(steady_from(slow.time, slow.value)));
}

TEST(Steadiness, NothingIsSteadyInFewSamplesOrWithoutNumbers) {
    const std::vector<double> few{0, 1, 2, 3}, same{1, 1, 1, 1};
    EXPECT_TRUE(std::isnan(steady_from(few, same)));
    const Series broken = sampled([](double) { return std::numeric_limits<double>::quiet_NaN(); });
    EXPECT_TRUE(std::isnan(steady_from(broken.time, broken.value)));
}

TEST(Steadiness, TheNoiseOfAMeanKnowsThatNeighbouringSamplesBelongTogether) {
    std::mt19937 generator(2);
    std::normal_distribution<double> normal(0, 1);
    double held = 0;
    const Series series = sampled([&](double t) { // one draw for every ten samples
        held = std::lround(10 * t) % 10 == 0 ? normal(generator) : held;
        return held;
    });
    EXPECT_GT(mean_from(series.time, series.value, 0).noise, 2 / std::sqrt(100));
}

TEST(FinalValue, IsTheLastSampleAndItsNoiseIgnoresASmoothTrend) {
    const Series smooth = sampled([](double t) { return std::exp(-t / 10); });
    EXPECT_EQ(final_value(smooth.time, smooth.value).value, smooth.value.back());
    EXPECT_LT(final_value(smooth.time, smooth.value).noise, 1e-4);
    const Series rough = noisy_start_up(5, 0.05);
    EXPECT_NEAR(final_value(rough.time, rough.value).noise, 0.05, 0.04);
}

} // namespace
} // namespace slurry
