#include "solver/geometry/random_profile.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace slurry {
namespace {

using std::numbers::pi;
constexpr double period = 4e-5;

double height(const std::vector<Harmonic>& waves, double x) {
    double sum = 0;
    for (const Harmonic& wave : waves)
        sum += wave.amplitude * std::cos(wave.wavenumber * x + wave.phase);
    return sum;
}

// Mean over the period of the product of two heights a distance apart.
double correlation(const std::vector<Harmonic>& waves, double apart) {
    const int n = 4000;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        sum += height(waves, period * i / n) * height(waves, period * i / n + apart);
    return sum / n;
}

TEST(RandomProfile, HasItsRmsHeightAndCorrelationWhateverTheSeed) {
    for (const std::uint64_t seed : {0U, 1U, 99U}) {
        const std::vector<Harmonic> waves = harmonics({0, 5e-7, 2e-6, seed}, period);
        EXPECT_NEAR(correlation(waves, 0), 25e-14, 1e-22);
        // A long period has many harmonics, and only the missing mean tells it from an endless profile.
        for (const double apart : {1e-6, 2e-6, 4e-6})
            EXPECT_NEAR(correlation(waves, apart) / 25e-14, std::exp(-std::pow(apart / 2e-6, 2)), 0.1);
        EXPECT_NEAR(height(waves, 0.3 * period), height(waves, 1.3 * period), 1e-18);
    }
}

// The numbers that SplitMix64 gives for the seed 1234567, as published with its code.
TEST(RandomProfile, PhasesAreTheSameOnEveryMachine) {
    const std::vector<Harmonic> waves = harmonics({0, 1e-6, 4e-6, 1234567}, period);
    const std::uint64_t published[]{6457827717110365317U, 3203168211198807973U, 9817491932198370423U};
    ASSERT_GE(waves.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_DOUBLE_EQ(waves[i].phase, 2 * pi * std::ldexp(static_cast<double>(published[i] >> 11U), -53));
    EXPECT_NE(harmonics({0, 1e-6, 4e-6, 2}, period)[0].phase, waves[0].phase);
}

TEST(RandomProfile, LongCorrelationLeavesOneWave) {
    const std::vector<Harmonic> waves = harmonics({0, 1e-6, 1e-4, 1}, period);
    ASSERT_EQ(waves.size(), 1U);
    EXPECT_NEAR(waves[0].amplitude, std::sqrt(2.0) * 1e-6, 1e-20);
}

} // namespace
} // namespace slurry
