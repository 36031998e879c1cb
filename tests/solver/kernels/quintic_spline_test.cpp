// The quintic spline, Eq. 2.4.
#include "solver/kernels/quintic_spline.hpp"

#include "solver/loop/pair.hpp"

#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace slurry {
namespace {

// Integral of f(q) q^power / lambda over the support. Gauss-Legendre with 8 points is exact for every
// polynomial piece.
double radial_integral(int power) {
    const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
        gsl_integration_glfixed_table_alloc(8), gsl_integration_glfixed_table_free);
    double sum = 0;
    for (int piece = 0; piece < 3; ++piece) {
        for (std::size_t k = 0; k < 8; ++k) {
            double q = 0;
            double weight = 0;
            gsl_integration_glfixed_point(piece, piece + 1, k, &q, &weight, table.get());
            sum += weight * QuinticSpline::shape(q) * std::pow(q, power);
        }
    }
    return sum;
}

TEST(QuinticSpline, IntegratesToOneInOneTwoAndThreeDimensions) {
    const std::array<double, 3> sphere{2, 2 * std::numbers::pi, 4 * std::numbers::pi};
    for (std::size_t dimension = 0; dimension < 3; ++dimension) {
        const double integral = QuinticSpline::normalisation[dimension] * sphere[dimension] *
                                radial_integral(static_cast<int>(dimension));
        EXPECT_NEAR(integral, 1, 1e-14) << dimension + 1 << "D";
    }
}

TEST(QuinticSpline, PrintedThreeDimensionalFactorDoesNotIntegrateToOne) {
    const double printed = 3 / (359 * std::numbers::pi);
    EXPECT_NEAR(printed * 4 * std::numbers::pi * radial_integral(2), 1.0028, 5e-5);
}

TEST(QuinticSpline, FollowsTheFourBranchesOfTheEquation) {
    const auto branches = [](double q) {
        const double outer = std::pow(3 - q, 5);
        const double middle = 6 * std::pow(2 - q, 5);
        const double inner = 15 * std::pow(1 - q, 5);
        return q < 1 ? outer - middle + inner : (q < 2 ? outer - middle : (q < 3 ? outer : 0.0));
    };
    for (double q = 0; q < 3.5; q += 0.0123) {
        EXPECT_NEAR(QuinticSpline::shape(q), branches(q), 1e-12) << q;
    }
}

TEST(QuinticSpline, SlopeAgreesWithFiniteDifferences) {
    constexpr double step = 1e-5;
    for (double q = 0.01; q < 3.2; q += 0.0137) {
        const double difference =
            (QuinticSpline::shape(q + step) - QuinticSpline::shape(q - step)) / (2 * step);
        EXPECT_NEAR(QuinticSpline::slope(q), difference, 1e-7) << q; // truncation: step^2 f''' / 6 < 1e-8
    }
}

TEST(QuinticSpline, KernelAndSlopeAreContinuousWhereThePiecesMeet) {
    constexpr double step = 1e-9;
    for (const double knot : {1.0, 2.0, 3.0}) {
        EXPECT_NEAR(QuinticSpline::shape(knot - step), QuinticSpline::shape(knot + step), 1e-6) << knot;
        EXPECT_NEAR(QuinticSpline::slope(knot - step), QuinticSpline::slope(knot + step), 1e-6) << knot;
    }
}

TEST(QuinticSpline, DecreasesFromItsPeakToZeroAtTheSupport) {
    EXPECT_EQ(QuinticSpline::slope(0.0), 0);
    for (double q = 0.01; q < 3; q += 0.01) {
        EXPECT_GT(QuinticSpline::shape(q), 0) << q;
        EXPECT_LT(QuinticSpline::slope(q), 0) << q;
    }
    for (const double q : {3.0, 3.0001, 10.0, 1e8}) {
        EXPECT_EQ(QuinticSpline::shape(q), 0) << q;
        EXPECT_EQ(QuinticSpline::slope(q), 0) << q;
    }
}

TEST(QuinticSpline, PairCarriesTheKernelAndItsGradient) {
    constexpr double h = 0.04;
    const auto scale = KernelScale<double>::of<QuinticSpline>(h);
    const auto kernel = [&](double x, double y) { return make_pair<QuinticSpline>(scale, x, y).kernel; };
    constexpr double step = 1e-7;
    for (double angle = 0.1; angle < 6; angle += 0.7) {
        const double x = 1.3 * h * std::cos(angle);
        const double y = 1.3 * h * std::sin(angle);
        const Pair<double> pair = make_pair<QuinticSpline>(scale, x, y);
        const double steepest = pair.kernel / h;
        EXPECT_NEAR(pair.slope * x, (kernel(x + step, y) - kernel(x - step, y)) / (2 * step),
                    1e-6 * steepest);
        EXPECT_NEAR(pair.slope * y, (kernel(x, y + step) - kernel(x, y - step)) / (2 * step),
                    1e-6 * steepest);
        EXPECT_NEAR(pair.kernel, QuinticSpline::normalisation[1] * QuinticSpline::shape(1.3) / (h * h),
                    1e-9 * pair.kernel);
    }
    const Pair<double> coincident = make_pair<QuinticSpline>(scale, 0.0, 0.0);
    EXPECT_TRUE(std::isfinite(coincident.slope));
    EXPECT_EQ(coincident.slope * coincident.dx, 0);
}

} // namespace
} // namespace slurry
