#pragma once
// Background pressure of the transport velocity, Eq. 2.19 [wang2014, adami2013]:
// f_pb,i = -p_b / m_i sum_j (V_i^2 + V_j^2) grad W_ij. It moves particles towards even spacing, not the
// fluid.
#include "solver/terms/pressure_force.hpp"

namespace slurry {

struct BackgroundPressure {
    template <class P> struct Sums { P background_x{}, background_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P weight = force_weight(pair, i, j);
        sums.background_x += weight * pair.dx;
        sums.background_y += weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        const Real factor = coefficients.background_pressure * coefficients.inverse_mass;
        result.background_x -= factor * sums.background_x;
        result.background_y -= factor * sums.background_y;
    }
};

} // namespace slurry
