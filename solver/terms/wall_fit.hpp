#pragma once
// Velocity and pressure of wall dummies by moving least squares about the nearest point of the wall, in place
// of the kernel means of Eqs. 2.16 and 2.17.
//
// A kernel mean of the fluid, reflected, has the slope of the fluid's velocity at the wall but the wrong sign
// of its curvature, so that the viscous force on the first row of particles is wrong wherever the velocity is
// not linear. The fits continue the polynomials of the fluid through the wall instead:
//   velocity - V_wall = n (b_0 + b_1 s + b_2 n)     no slip at n = 0, exactly (V_wall: the rigid motion)
//   pressure          = c_0 + c_1 s + c_2 n
// with n the distance from the (parabolic) wall and s the offset along it, and weights
// (1 - (r / 3h)^2)^2, wide enough for two rows of particles in a gap to decide on b_2.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

#include <type_traits>

namespace slurry {

inline constexpr double wall_fit_support = 3; // in smoothing lengths

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

struct VelocityFit {
    template <class P> struct Sums {
        P a00{}, a01{}, a02{}, a11{}, a12{}, a22{}; // normal equations of n, n s, n^2
        P x0{}, x1{}, x2{}, y0{}, y1{}, y2{};       // their right sides for both components
    };
    template <class P, class View>
    static void add(Sums<P>& sums, const Pair<P>& pair, const View& dummy, const View& fluid) {
        const WallOffset<P> at = wall_offset(pair, dummy);
        const P f0 = at.across;
        const P f1 = at.across * at.along;
        const P f2 = at.across * at.across;
        const P w0 = at.weight * f0;
        const P w1 = at.weight * f1;
        const P w2 = at.weight * f2;
        sums.a00 += w0 * f0;
        sums.a01 += w0 * f1;
        sums.a02 += w0 * f2;
        sums.a11 += w1 * f1;
        sums.a12 += w1 * f2;
        sums.a22 += w2 * f2;
        P velocity_x = fluid.velocity_x() - dummy.wall_velocity_x();
        P velocity_y = fluid.velocity_y() - dummy.wall_velocity_y();
        if constexpr (spinning<View, P>) { // the pair's offset points from the particle to the wall point
            velocity_x -= dummy.spin() * pair.dy;
            velocity_y += dummy.spin() * pair.dx;
        }
        sums.x0 += w0 * velocity_x;
        sums.x1 += w1 * velocity_x;
        sums.x2 += w2 * velocity_x;
        sums.y0 += w0 * velocity_y;
        sums.y1 += w1 * velocity_y;
        sums.y2 += w2 * velocity_y;
    }
    template <class P, class View, class Real>
    static void finish(const Sums<P>& s, const View& dummy, const ExtrapolationCoefficients<Real>& /*unused*/,
                       Extrapolation<P>& result) {
        const P zero{};
        // Cofactors of the rows for b_0 and b_2; too few particles for a parabola leave the straight line.
        const P c00 = s.a11 * s.a22 - s.a12 * s.a12;
        const P c01 = s.a02 * s.a12 - s.a01 * s.a22;
        const P c02 = s.a01 * s.a12 - s.a02 * s.a11;
        const P c12 = s.a01 * s.a02 - s.a00 * s.a12;
        const P c22 = s.a00 * s.a11 - s.a01 * s.a01;
        const P determinant = s.a00 * c00 + s.a01 * c01 + s.a02 * c02;
        const auto solvable = determinant > Real(1e-3) * s.a00 * s.a11 * s.a22;
        const P inverse = solvable ? 1 / determinant : zero;
        const P line = solvable ? zero : (s.a00 > zero ? 1 / s.a00 : zero);
        const P depth = dummy.depth();
        const auto continued = [&](const P& r0, const P& r1, const P& r2) {
            const P slope = (c00 * r0 + c01 * r1 + c02 * r2) * inverse + line * r0;
            const P bend = (c02 * r0 + c12 * r1 + c22 * r2) * inverse;
            return P(depth * (depth * bend - slope));
        };
        result.velocity_x = dummy.wall_velocity_x() + continued(s.x0, s.x1, s.x2);
        result.velocity_y = dummy.wall_velocity_y() + continued(s.y0, s.y1, s.y2);
        if constexpr (spinning<View, P>) {
            result.velocity_x += dummy.spin() * depth * dummy.normal_y();
            result.velocity_y -= dummy.spin() * depth * dummy.normal_x();
        }
    }
};

struct PressureFit {
    template <class P> struct Sums {
        P m0{}, ms{}, mn{}, mss{}, msn{}, mnn{}; // normal equations of 1, s, n
        P p0{}, ps{}, pn{};                      // their right side
    };
    template <class P, class View>
    static void add(Sums<P>& sums, const Pair<P>& pair, const View& dummy, const View& fluid) {
        const WallOffset<P> at = wall_offset(pair, dummy);
        const P ws = at.weight * at.along;
        const P wn = at.weight * at.across;
        sums.m0 += at.weight;
        sums.ms += ws;
        sums.mn += wn;
        sums.mss += ws * at.along;
        sums.msn += ws * at.across;
        sums.mnn += wn * at.across;
        sums.p0 += at.weight * fluid.pressure();
        sums.ps += ws * fluid.pressure();
        sums.pn += wn * fluid.pressure();
    }
    template <class P, class View, class Real>
    static void finish(const Sums<P>& s, const View& dummy, const ExtrapolationCoefficients<Real>& /*unused*/,
                       Extrapolation<P>& result) {
        const P zero{};
        const P c00 = s.mss * s.mnn - s.msn * s.msn;
        const P c01 = s.mn * s.msn - s.ms * s.mnn;
        const P c02 = s.ms * s.msn - s.mn * s.mss;
        const P c12 = s.ms * s.mn - s.m0 * s.msn;
        const P c22 = s.m0 * s.mss - s.ms * s.ms;
        const P determinant = s.m0 * c00 + s.ms * c01 + s.mn * c02;
        const auto solvable = determinant > Real(1e-3) * s.m0 * s.mss * s.mnn;
        const P inverse = solvable ? 1 / determinant : zero;
        const P mean = solvable ? zero : (s.m0 > zero ? s.p0 / s.m0 : zero);
        const P at_wall = (c00 * s.p0 + c01 * s.ps + c02 * s.pn) * inverse;
        const P slope = (c02 * s.p0 + c12 * s.ps + c22 * s.pn) * inverse;
        result.pressure = mean + at_wall - dummy.depth() * slope;
    }
};

} // namespace slurry
