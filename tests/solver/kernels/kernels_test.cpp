// What every kernel must be, and Eq. 2.4 in particular. Lengths in smoothing lengths.
#include "solver/kernels/fitted_quintic.hpp"
#include "solver/kernels/quintic_spline.hpp"
#include "solver/kernels/wendland.hpp"
#include "solver/loop/pair.hpp"
#include "solver/vector.hpp"

#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace slurry {
namespace {

// Integral over [0, 3] in thirds: Gauss-Legendre with 16 points is exact for every polynomial piece.
template <class Function> double integral(Function&& function, double upper) {
    const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
        gsl_integration_glfixed_table_alloc(16), gsl_integration_glfixed_table_free);
    double sum = 0;
    for (int piece = 0; piece < 3; ++piece) {
        for (std::size_t k = 0; k < 16; ++k) {
            double q = 0;
            double weight = 0;
            gsl_integration_glfixed_point(piece * upper / 3, (piece + 1) * upper / 3, k, &q, &weight,
                                          table.get());
            sum += weight * function(q);
        }
    }
    return sum;
}

template <class Kernel> class EveryKernel : public ::testing::Test {};
using Kernels = ::testing::Types<QuinticSpline, WendlandC2, WendlandC4, FittedQuintic>;
TYPED_TEST_SUITE(EveryKernel, Kernels);

TYPED_TEST(EveryKernel, IntegratesToOne) {
    const auto ring = [](double q) { return 2 * std::numbers::pi * q * TypeParam::value(q * q); };
    EXPECT_NEAR(integral(ring, TypeParam::support), 1, 1e-14);
}

// The integral of x^2 (dW/dr) / r over the plane is -1, by parts: with it gradients and viscosity are
// consistent.
TYPED_TEST(EveryKernel, HasAConsistentGradient) {
    const auto ring = [](double q) { return std::numbers::pi * q * q * q * TypeParam::slope(q * q); };
    EXPECT_NEAR(integral(ring, TypeParam::support), -1, 1e-13);
}

TYPED_TEST(EveryKernel, SlopeAgreesWithFiniteDifferences) {
    constexpr double step = 1e-5;
    for (double q = 0.01; q < 3.2; q += 0.0137) {
        const double difference =
            (TypeParam::value((q + step) * (q + step)) - TypeParam::value((q - step) * (q - step))) /
            (2 * step);
        EXPECT_NEAR(TypeParam::slope(q * q) * q, difference, 1e-8) << q;
    }
}

TYPED_TEST(EveryKernel, DecreasesFromItsPeakToZeroAtTheSupport) {
    for (double q = 0.01; q < TypeParam::support - 1e-9; q += 0.01) {
        EXPECT_GT(TypeParam::value(q * q), 0) << q;
        EXPECT_LT(TypeParam::slope(q * q), 0) << q;
    }
    for (const double beyond : {1 + 1e-12, 1.0001, 4.0, 1e8}) {
        const double q = beyond * TypeParam::support;
        EXPECT_EQ(TypeParam::value(q * q), 0) << q;
        EXPECT_EQ(TypeParam::slope(q * q), 0) << q;
    }
}

TYPED_TEST(EveryKernel, PairOfCoincidentParticlesIsFinite) {
    const Pair<double> coincident = make_pair<TypeParam>(0.0, 0.0);
    EXPECT_TRUE(std::isfinite(coincident.slope));
    EXPECT_NEAR(coincident.kernel, TypeParam::value(1e-30), 1e-6);
    EXPECT_EQ(coincident.slope * coincident.dx, 0);
    const Pair<float> in_float = make_pair<TypeParam>(0.0F, 0.0F);
    EXPECT_TRUE(std::isfinite(in_float.slope));
}

TYPED_TEST(EveryKernel, PairCarriesTheGradient) {
    const auto kernel = [](double x, double y) { return make_pair<TypeParam>(x, y).kernel; };
    constexpr double step = 1e-6;
    for (double angle = 0.1; angle < 6; angle += 0.7) {
        const double x = 1.3 * std::cos(angle);
        const double y = 1.3 * std::sin(angle);
        const Pair<double> pair = make_pair<TypeParam>(x, y);
        EXPECT_NEAR(pair.slope * x, (kernel(x + step, y) - kernel(x - step, y)) / (2 * step), 1e-9);
        EXPECT_NEAR(pair.slope * y, (kernel(x, y + step) - kernel(x, y - step)) / (2 * step), 1e-9);
    }
}

// sum V y^2 (dW/dr) / r, or x^2, over rows of particles along x, `1` apart, at any phase to one another:
// along x an integral.
template <class Kernel> Vector moments_of_rows() {
    Vector sum = Vector::Zero();
    constexpr double step = 1e-4;
    for (int y = -3; y <= 3; ++y) {
        for (double x = -3.5; x < 3.5; x += step) {
            const double slope = step * Kernel::slope(x * x + y * y + 1e-20);
            sum += Vector(slope * x * x, slope * y * y);
        }
    }
    return sum;
}

TEST(FittedQuintic, KeepsTheStrengthOfGradientsInAShearFlow) {
    EXPECT_LT((moments_of_rows<FittedQuintic>() + Vector(1, 1)).norm(), 1e-7);
    const double spline = (moments_of_rows<QuinticSpline>() + Vector(1, 1)).norm();
    EXPECT_GT(spline, 5e-5);
    EXPECT_LT(spline, 1e-4);
}

TEST(FittedQuintic, IsCloseToTheSpline) {
    double kernel = 0, force = 0, kernel_peak = 0, force_peak = 0;
    for (double q = 0.01; q < 3.1; q += 0.01) {
        const Pair<double> fitted = make_pair<FittedQuintic>(q, 0.0);
        const Pair<double> spline = make_pair<QuinticSpline>(q, 0.0);
        kernel = std::max(kernel, std::abs(fitted.kernel - spline.kernel));
        force = std::max(force, std::abs(fitted.slope - spline.slope) * q);
        kernel_peak = std::max(kernel_peak, spline.kernel);
        force_peak = std::max(force_peak, -spline.slope * q);
    }
    EXPECT_LT(kernel, 2.1e-4 * kernel_peak);
    EXPECT_LT(force, 1.5e-3 * force_peak);
}

TEST(QuinticSpline, IntegratesToOneInOneAndThreeDimensions) {
    constexpr auto lambda = QuinticSpline::normalisation;
    const auto shape = [&](double q) { return QuinticSpline::value(q * q) / lambda[1]; };
    EXPECT_NEAR(integral([&](double q) { return 2 * lambda[0] * shape(q); }, 3), 1, 1e-14);
    const auto shell = [&](double q) { return 4 * std::numbers::pi * q * q * shape(q); };
    EXPECT_NEAR(lambda[2] * integral(shell, 3), 1, 1e-14);
    const double printed = 3 / (359 * std::numbers::pi);
    EXPECT_NEAR(printed * integral(shell, 3), 1.0028, 5e-5);
}

TEST(QuinticSpline, FollowsTheFourBranchesOfTheEquation) {
    const auto branches = [](double q) {
        const double outer = std::pow(3 - q, 5);
        const double middle = 6 * std::pow(2 - q, 5);
        const double inner = 15 * std::pow(1 - q, 5);
        return q < 1 ? outer - middle + inner : (q < 2 ? outer - middle : (q < 3 ? outer : 0.0));
    };
    for (double q = 0.001; q < 3.5; q += 0.0123) {
        EXPECT_NEAR(QuinticSpline::value(q * q), QuinticSpline::normalisation[1] * branches(q), 1e-14) << q;
    }
}

} // namespace
} // namespace slurry
