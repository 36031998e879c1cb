#include "solver/bench/port_bound.hpp"

#include <gtest/gtest.h>

namespace slurry {
namespace {

TEST(PortBound, GrowsByHalfACycleForEachInstructionOnceArithmeticIsWhatIsShort) {
    OperationCounts many;
    many.additions = 1000;
    const double before = port_bound_cycles<double>(many);
    EXPECT_GE(before, 500);
    many.multiplications = 10;
    EXPECT_DOUBLE_EQ(port_bound_cycles<double>(many), before + 5);
    many.fusable = 10;
    EXPECT_DOUBLE_EQ(port_bound_cycles<double>(many), before + (fuses_multiply_add ? 0 : 5));
    many.inverse_square_roots = 1; // the estimate and two Newton steps
    EXPECT_DOUBLE_EQ(port_bound_cycles<double>(many), before + (fuses_multiply_add ? 0 : 5) + 4.5);
}

TEST(PortBound, OfNoArithmeticIsThatOfBringingTheRowsIntoRegisters) {
    EXPECT_GE(port_bound_cycles<float>({}), native_lanes<float>); // a row and an index for each pair
    EXPECT_GE(port_bound_cycles<double>({}), native_lanes<double>);
}

TEST(PortBound, OfManyDivisionsIsTheDividersTime) {
    OperationCounts divisions;
    divisions.divisions = 1000;
    EXPECT_DOUBLE_EQ(port_bound_cycles<float>(divisions), 1000 * native_lanes<float> * 5.0 / 8);
    EXPECT_DOUBLE_EQ(port_bound_cycles<double>(divisions), 2000 * native_lanes<double>);
}

} // namespace
} // namespace slurry
