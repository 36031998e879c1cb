#pragma once
// Pressure force with the plain mean (p_i + p_j) / 2: the density-weighted one of Eq. 2.15 where all
// particles count with the same density, as with volumes that do not change, and one division a pair less.
#include "solver/terms/pressure_force.hpp"

namespace slurry {

struct PlainPressureForce {
    template <class P> struct Sums { P pressure_x{}, pressure_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P weight = force_weight(pair, i, j) * (i.pressure() + j.pressure());
        sums.pressure_x += weight * pair.dx;
        sums.pressure_y += weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        result.x -= Real{0.5} * coefficients.inverse_mass * sums.pressure_x;
        result.y -= Real{0.5} * coefficients.inverse_mass * sums.pressure_y;
    }
};

} // namespace slurry
