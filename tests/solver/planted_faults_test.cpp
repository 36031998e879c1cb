// Faults that the sanitizers have to find: scripts/sanitize runs each by itself and expects a report.
// Disabled otherwise.
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>

namespace slurry::testing {
namespace {

TEST(PlantedFaults, DISABLED_ReadBehindTheEnd) {
    // Volatile, or the compiler stops at what it sees to be undefined.
    const volatile std::size_t count = 8;
    const auto values = std::make_unique<volatile double[]>(count);
    EXPECT_EQ(values[count], 0);
}

TEST(PlantedFaults, DISABLED_NumberTooLargeForAnInteger) {
    const volatile double large = 1e300;
    EXPECT_NE(static_cast<std::int64_t>(large), 0);
}

TEST(PlantedFaults, DISABLED_SumOfTwoThreads) {
    long sum = 0;
#pragma omp parallel for schedule(static)
    for (long i = 0; i < 1000; ++i) {
        sum += i; // without reduction(+ : sum)
    }
    EXPECT_NE(sum, 0);
}

} // namespace
} // namespace slurry::testing
