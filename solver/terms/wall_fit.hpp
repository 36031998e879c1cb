#pragma once
// Velocity and pressure of wall dummies by moving least squares about the nearest point of the wall, in place
// of the kernel means of Eqs. 2.16 and 2.17.
//
// A kernel mean of the fluid, reflected, has the slope of the fluid's velocity at the wall but the wrong sign
// of its curvature, so that the viscous force on the first row of particles is wrong wherever the velocity is
// not linear. The fits continue the polynomials of the fluid through the wall instead:
//   velocity - V_wall = n (b_0 + b_1 n + b_2 s)     no slip at n = 0, exactly (V_wall: the rigid motion)
//   pressure          = c_0 + c_2 s + g n
// with n the distance from the (parabolic) wall and s the offset along it, and weights
// (1 - (r / 3h)^2)^2, wide enough for two rows of particles in a gap to decide on b_1. At walls g is that of
// the momentum balance (solver/terms/wall_pressure_gradient.hpp): fitted, it gave energy to sound, and a
// Couette flow of cell Reynolds number 10 broke up. At discs it is fitted: their acceleration, which it
// follows from, follows from the pressure in turn, and taken from the step before it shook light ones to
// pieces.
#include "solver/loop/pair.hpp"
#include "solver/terms/normal_equations.hpp"
#include "solver/terms/views.hpp"

#include <numbers>
#include <type_traits>

namespace slurry {

inline constexpr double wall_fit_support = 3; // in smoothing lengths
// Integral of weight times distance over the half-plane in front of a flat wall: 16 (3h)^3 / 105.
inline constexpr double half_plane_moment = 16 * wall_fit_support * wall_fit_support * wall_fit_support / 105;
// What is left of it before a wall of the given half curvature, in 1 / h: positive where fluid is in a
// hollow.
template <class P> P moment_before_curve(const P& half_curvature) {
    constexpr double squared_support = wall_fit_support * wall_fit_support;
    constexpr double loss = std::numbers::pi * squared_support * squared_support / 48 / half_plane_moment;
    return 1 - Element<P>(loss) * half_curvature;
}

// How much the fluid before a wall can tell of what is behind it: of the curvature b_1 of its velocity, of
// the velocity that the continuity equation takes, and of its pressure's gradient. All where it fills the
// room within reach, nothing where it is a film. In films of up to two smoothing lengths a parabola through
// so few rows made viscosity stiffer than the time step is for: between a wall and a disc velocities changed
// sign from step to step and grew. In films of about one, a disc caught between two walls turned small errors
// into flow through them, and the fitted gradient drove a lone particle against the wall that a light disc
// rose to. `fluid_share`: see Extrapolation; of films it is 1 - (1 - (thickness / 3h)^2)^(7/2), so that the
// ramps go from 1.8 h to 2.3 h (curvature), 1.2 h to 1.7 h (velocity) and 0.8 h to 1 h (gradient).
template <class P> P rise(const P& share, double from, double to) {
    return 1 - positive_part(1 - positive_part((share - Element<P>(from)) * Element<P>(1 / (to - from))));
}
template <class P> P known_curvature(const P& fluid_share) {
    return rise(fluid_share, 0.8, 0.95);
}
inline double known_velocity(double fluid_share) {
    return rise(fluid_share, 0.45, 0.75);
}
inline double known_gradient(double fluid_share) {
    return rise(fluid_share, 0.25, 0.35);
}

template <class View, class P> inline constexpr bool spinning = std::is_same_v<View, SpinningWallView<P>>;

// Wall coordinates and weight of a fluid particle, seen from the wall point of a dummy.
template <class P> struct WallOffset { P along, across, weight; };

template <class P, class View> WallOffset<P> wall_offset(const Pair<P>& pair, const View& dummy) {
    const P across = -(pair.dx * dummy.normal_x() + pair.dy * dummy.normal_y());
    const P along = pair.dy * dummy.normal_x() - pair.dx * dummy.normal_y();
    const P remaining = positive_part(1 - (along * along + across * across) *
                                              Element<P>(1 / (wall_fit_support * wall_fit_support)));
    return {along, across - dummy.half_curvature() * along * along, remaining * remaining};
}

struct PressureFit {
    template <class P> struct Sums {
        NormalEquations<P, 3> equations; // of 1, s, n
        std::array<P, 3> right{};
    };
    template <class P, class View>
    static void add(Sums<P>& sums, const Pair<P>& pair, const View& dummy, const View& fluid) {
        const WallOffset<P> at = wall_offset(pair, dummy);
        const std::array<P, 3> functions{P{} + 1, at.along, at.across};
        const std::array<P, 3> weighted = sums.equations.add(at.weight, functions);
        for (std::size_t k = 0; k < 3; ++k) {
            sums.right[k] += weighted[k] * fluid.pressure();
        }
    }
    template <class P, class View, class Real>
    static void finish(const Sums<P>& sums, const View& dummy,
                       const ExtrapolationCoefficients<Real>& coefficients, Extrapolation<P>& result) {
        const auto& products = sums.equations.products;
        const FactoredEquations<P, 2> without_distance(
            NormalEquations<P, 2>{{products[0], products[1], products[2]}});
        const P mean_distance = without_distance.solve({products[3], products[4]})[0];
        result.pressure = without_distance.solve({sums.right[0], sums.right[1]})[0];
        result.pressure_lever = -(dummy.depth() + mean_distance);
        if constexpr (spinning<View, P>) { // else there are no discs
            result.pressure_gradient = FactoredEquations<P, 3>(sums.equations).solve(sums.right)[2];
        }
        result.fluid_share = fluid_share(sums, coefficients);
    }
    template <class P, class Real>
    static P fluid_share(const Sums<P>& sums, const ExtrapolationCoefficients<Real>& coefficients) {
        return coefficients.mass * sums.equations.products[3] * Real(1 / half_plane_moment);
    }
};

struct VelocityFit {
    template <class P> struct Sums {
        NormalEquations<P, 3> equations; // of n, n^2, n s
        std::array<P, 3> right_x{}, right_y{};
    };
    template <class P, class View>
    static void add(Sums<P>& sums, const Pair<P>& pair, const View& dummy, const View& fluid) {
        const WallOffset<P> at = wall_offset(pair, dummy);
        P velocity_x = fluid.velocity_x() - dummy.wall_velocity_x();
        P velocity_y = fluid.velocity_y() - dummy.wall_velocity_y();
        if constexpr (spinning<View, P>) { // the pair's offset points from the particle to the wall point
            velocity_x -= dummy.spin() * pair.dy;
            velocity_y += dummy.spin() * pair.dx;
        }
        const std::array<P, 3> functions{at.across, at.across * at.across, at.across * at.along};
        const std::array<P, 3> weighted = sums.equations.add(at.weight, functions);
        for (std::size_t k = 0; k < 3; ++k) {
            sums.right_x[k] += weighted[k] * velocity_x;
            sums.right_y[k] += weighted[k] * velocity_y;
        }
    }
    template <class AllSums, class View, class Real, class P>
    static void finish(const AllSums& all_sums, const View& dummy,
                       const ExtrapolationCoefficients<Real>& coefficients, Extrapolation<P>& result) {
        const Sums<P>& sums = all_sums;
        const FactoredEquations<P, 3> equations(sums.equations);
        const auto x = equations.solve(sums.right_x);
        const auto y = equations.solve(sums.right_y);
        const FactoredEquations<P, 1> line(NormalEquations<P, 1>{{sums.equations.products[0]}});
        const P full = moment_before_curve(dummy.half_curvature());
        const P known = known_curvature<P>(PressureFit::fluid_share<P>(all_sums, coefficients) / full);
        const P depth = dummy.depth();
        const auto continued = [&](const auto& parabola, const P& right) {
            return known * depth * (depth * parabola[1] - parabola[0]) -
                   (1 - known) * depth * line.solve({right})[0];
        };
        result.velocity_x = dummy.wall_velocity_x() + continued(x, sums.right_x[0]);
        result.velocity_y = dummy.wall_velocity_y() + continued(y, sums.right_y[0]);
        // Along the wall the velocity is n (b_0 + b_2 s + ...), so that div v = 0 asks for -b_2 n^2 / 2
        // across it.
        result.normal_curvature = y[2] * dummy.normal_x() - x[2] * dummy.normal_y();
        if constexpr (spinning<View, P>) {
            result.velocity_x += dummy.spin() * depth * dummy.normal_y();
            result.velocity_y -= dummy.spin() * depth * dummy.normal_x();
        }
    }
};

} // namespace slurry
