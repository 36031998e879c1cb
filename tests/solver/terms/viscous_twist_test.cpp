// The torque on a particle of a disc beyond that of the force at its place.
#include "solver/terms/viscous_twist.hpp"

#include "solver/kernels/fitted_quintic.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

// Of a particle in the middle of a lattice whose velocity is linear with the gradient (xx, xy, yx, yy), times
// the inverse mass; everything in units of the lattice's spacing.
double twist_of(double xx, double xy, double yx, double yy, double viscosity) {
    constexpr double inverse_mass = 2;
    const auto at = [&](double x, double y) {
        return ForceView<double>{{x, y, xx * x + xy * y, yx * x + yy * y, 0, 0, 1, 0}};
    };
    ViscousTwist::Sums<double> sums;
    for (int row = -3; row <= 3; ++row) {
        for (int column = -3; column <= 3; ++column) {
            const ForceView<double> j = at(column, row);
            const auto pair = make_pair<FittedQuintic>(-j.x(), -j.y());
            ViscousTwist::add(sums, pair, at(0, 0), j);
        }
    }
    Acceleration<double> result{};
    ViscousTwist::finish(sums, at(0, 0), ForceCoefficients<double>{inverse_mass, viscosity, 0}, result);
    return result.twist / inverse_mass;
}

// Half of the sum over r x f: with sum V (dW/dr) / r x^2 = -1 it is eta V (dv/dx - du/dy), so that a rigid
// rotation gives twice the viscosity times the rate of turning, which Eq. 2.15 has too much.
TEST(ViscousTwist, IsViscosityTimesVorticityTimesVolume) {
    constexpr double kernel_error = 1e-3; // of the sums over a lattice, against the integral
    EXPECT_NEAR(twist_of(0, -0.7, 0.7, 0, 3), 3 * 2 * 0.7, 3 * 1.4 * kernel_error);
    EXPECT_NEAR(twist_of(0, 0.7, 0, 0, 3), -3 * 0.7, 3 * 0.7 * kernel_error);
    EXPECT_NEAR(twist_of(0, 0, 0.7, 0, 3), 3 * 0.7, 3 * 0.7 * kernel_error);
}

TEST(ViscousTwist, IsNotThereInAStrain) {
    EXPECT_NEAR(twist_of(0, 0.7, 0.7, 0, 3), 0, 1e-12);
    EXPECT_NEAR(twist_of(0.4, 0, 0, -0.4, 3), 0, 1e-12);
}

} // namespace
} // namespace slurry::testing
