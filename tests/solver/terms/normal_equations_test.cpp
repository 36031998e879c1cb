// Fits in lanes against Eigen.
#include "solver/terms/normal_equations.hpp"

#include <Eigen/QR>

#include <gtest/gtest.h>

#include <cmath>

namespace slurry::testing {
namespace {

using Equations = NormalEquations<double, 3>;
using Factored = FactoredEquations<double, 3>;

constexpr int samples = 9;

// Functions 1, t, `third`(t) at uneven places, and the values 2 - t + 3 t^2.
template <class Third> std::array<double, 3> fit(Third third) {
    Equations equations;
    std::array<double, 3> right{};
    for (int k = 0; k < samples; ++k) {
        const double t = k + 0.3 * std::sin(5.0 * k);
        const double weight = 1 + 0.5 * std::cos(k);
        const auto weighted = equations.add(weight, {1, t, third(t)});
        for (std::size_t i = 0; i < 3; ++i) {
            right[i] += weighted[i] * (2 - t + 3 * t * t);
        }
    }
    return Factored(equations).solve(right);
}

TEST(NormalEquations, FindCoefficientsThatFitExactly) {
    const auto found = fit([](double t) { return t * t; });
    EXPECT_NEAR(found[0], 2, 1e-10);
    EXPECT_NEAR(found[1], -1, 1e-10);
    EXPECT_NEAR(found[2], 3, 1e-10);
}

TEST(NormalEquations, LeaveOutAFunctionThatOthersExplain) {
    const auto found = fit([](double t) { return 4 * t - 1; });
    const auto without = fit([](double /*unused*/) { return 0.0; });
    EXPECT_EQ(found[2], 0);
    EXPECT_EQ(found[0], without[0]);
    EXPECT_EQ(found[1], without[1]);
    EXPECT_TRUE(std::isfinite(found[0]) && std::isfinite(found[1]));
}

TEST(NormalEquations, OfNothingAreZero) {
    const auto found = Factored(Equations{}).solve({});
    EXPECT_EQ(found, (std::array<double, 3>{}));
}

TEST(NormalEquations, InLanesAreThoseOneByOne) {
    using P = Pack<double, 4>;
    NormalEquations<P, 3> lanes;
    std::array<P, 3> right{};
    std::array<Equations, 4> single;
    std::array<std::array<double, 3>, 4> single_right{};
    for (int k = 0; k < samples; ++k) {
        std::array<P, 3> functions{};
        for (int lane = 0; lane < 4; ++lane) {
            const double t = k * 0.2 - lane * 0.1;
            functions[0][lane] = 1;
            functions[1][lane] = t;
            functions[2][lane] = lane == 3 ? 2 * t : t * t; // nothing new in the last
            const auto one = static_cast<std::size_t>(lane);
            const auto weighted = single[one].add(0.7, {1, t, functions[2][lane]});
            for (std::size_t i = 0; i < 3; ++i) {
                single_right[one][i] += weighted[i] * std::exp(t);
            }
        }
        const auto weighted = lanes.add(P{} + 0.7, functions);
        for (std::size_t i = 0; i < 3; ++i) {
            for (int lane = 0; lane < 4; ++lane) {
                right[i][lane] += weighted[i][lane] * std::exp(functions[1][lane]);
            }
        }
    }
    const auto found = FactoredEquations<P, 3>(lanes).solve(right);
    for (int lane = 0; lane < 4; ++lane) {
        const auto one = static_cast<std::size_t>(lane);
        const auto expected = Factored(single[one]).solve(single_right[one]);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(found[i][lane], expected[i], 1e-9);
        }
    }
}

} // namespace
} // namespace slurry::testing
