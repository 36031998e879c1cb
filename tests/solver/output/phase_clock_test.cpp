#include "solver/output/phase_clock.hpp"

#include <gtest/gtest.h>

namespace slurry {
namespace {

TEST(PhaseClock, ChargesNestedPhasesOnceOnly) {
    double now = 100;
    PhaseClock clock([&] { return now; });
    now += 1; // no phase
    for (int repeat = 0; repeat < 2; ++repeat) {
        const PhaseClock::Scope outer(clock, "forces");
        now += 2;
        {
            const PhaseClock::Scope inner(clock, "neighbours");
            now += 5;
        }
        now += 3;
    }
    ASSERT_EQ(clock.phases().size(), 2U);
    EXPECT_EQ(clock.phases()[0].name, "forces");
    EXPECT_DOUBLE_EQ(clock.phases()[0].seconds, 10);
    EXPECT_EQ(clock.phases()[1].name, "neighbours");
    EXPECT_DOUBLE_EQ(clock.phases()[1].seconds, 10);
    EXPECT_DOUBLE_EQ(clock.elapsed(), 21);
}

TEST(PhaseClock, SummaryGivesRateAndSharesThatAddUp) {
    double now = 0;
    PhaseClock clock([&] { return now; });
    {
        const PhaseClock::Scope scope(clock, "output");
        now += 1;
    }
    {
        const PhaseClock::Scope scope(clock, "forces");
        now += 7;
    }
    now += 2;
    const std::string text = clock.summary(1000, 500);
    EXPECT_NE(text.find("1000 particles, 500 steps in 10 s: 5e+04 particle-steps per second"),
              std::string::npos)
        << text;
    const auto forces = text.find("forces                   70.0 %");
    const auto other = text.find("other                    20.0 %");
    const auto output = text.find("output                   10.0 %");
    EXPECT_NE(forces, std::string::npos) << text;
    EXPECT_NE(other, std::string::npos) << text;
    EXPECT_NE(output, std::string::npos) << text;
    EXPECT_LT(forces, output) << "the largest share comes first";
}

TEST(PhaseClock, MeasuresRealTime) {
    PhaseClock clock;
    const double before = steady_seconds();
    {
        const PhaseClock::Scope scope(clock, "wait");
        while (steady_seconds() - before < 2e-3) {
        }
    }
    EXPECT_GE(clock.phases().front().seconds, 1.9e-3);
    EXPECT_LE(clock.phases().front().seconds, clock.elapsed());
}

} // namespace
} // namespace slurry
