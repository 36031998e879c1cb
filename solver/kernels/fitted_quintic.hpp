#pragma once
// The quintic spline (Eq. 2.4) without its square root: a polynomial in v = 1 - (r / 3h)^2, cut off at v = 0.
//   h^4 (dW/dr) / r = -v^5 (c_0 + c_1 v + ... + c_4 v^4),   h^2 W its integral
// The coefficients are a least-squares fit to the spline's force, sqrt(s) times the slope over s = (r/h)^2 in
// (0, 9), under three constraints. W integrates to one; and over rows of particles, spacing h between them,
// that have slid past one another, sum V (dW/dr) / r x^2 and y^2 are -1 as in the continuum, so that in a
// shear flow viscosity and pressure gradients keep their strength (the spline misses this by 9e-5, and by
// 8e-4 on a lattice; the fit by 2e-4 there).
#include "solver/loop/pack.hpp"

#include <array>

namespace slurry {

struct FittedQuintic {
    static constexpr double support = 3; // in smoothing lengths
    static constexpr std::array<double, 5> coefficients{
        0.47840900542022774, -1.6525328231500553, 3.371494465400916, -2.9340419077430506, 1.2927729186415602};

    // h^2 W, from s = (r/h)^2
    template <class P> static P value(const P& s) {
        using Real = Element<P>;
        constexpr auto& c = coefficients;
        const P v = remaining(s);
        return fifth(v) * v *
               (Real(4.5 / 6 * c[0]) +
                v * (Real(4.5 / 7 * c[1]) +
                     v * (Real(4.5 / 8 * c[2]) + v * (Real(4.5 / 9 * c[3]) + v * Real(4.5 / 10 * c[4])))));
    }
    // h^4 (dW/dr) / r
    template <class P> static P slope(const P& s) {
        using Real = Element<P>;
        constexpr auto& c = coefficients;
        const P v = remaining(s);
        const P square = v * v; // two short chains instead of a long one
        return fifth(v) * ((Real(-c[0]) + v * Real(-c[1])) +
                           square * ((Real(-c[2]) + v * Real(-c[3])) + square * Real(-c[4])));
    }

  private:
    template <class P> static P remaining(const P& s) { return positive_part(1 - Element<P>(1.0 / 9) * s); }
    template <class P> static P fifth(const P& x) {
        const P square = x * x;
        return square * square * x;
    }
};

} // namespace slurry
