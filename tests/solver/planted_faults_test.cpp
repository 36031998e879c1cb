// Faults that the sanitizers have to find: scripts/sanitize runs each by itself and expects a report.
// Disabled otherwise.
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace slurry::testing {
namespace {

TEST(PlantedFaults, DISABLED_ReadBehindTheEnd) {
    const std::vector<double> values(8, 1.0);
    const volatile std::size_t behind = values.size();
    EXPECT_NE(values.data()[behind], 0);
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
