#pragma once
// Pressure force, first term of Eq. 2.15 [wang2014, hu2006]:
// dv_i/dt = -1/m_i sum_j (V_i^2 + V_j^2) p~_ij grad W_ij with the density-weighted p~ = (p_i rho_j + p_j
// rho_i) / (rho_i + rho_j). The density in the weights is the one that belongs to V (rho = m / V), so that p~
// = (V_i p_i + V_j p_j) / (V_i + V_j).
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

// (V_i^2 + V_j^2) (dW/dr) / r, which all forces between particles share.
template <class P> P force_weight(const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
    return (i.volume() * i.volume() + j.volume() * j.volume()) * pair.slope;
}

struct PressureForce {
    template <class P> struct Sums { P pressure_x{}, pressure_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P mean_pressure =
            (i.volume() * i.pressure() + j.volume() * j.pressure()) * reciprocal(P(i.volume() + j.volume()));
        const P weight = force_weight(pair, i, j) * mean_pressure;
        sums.pressure_x += weight * pair.dx;
        sums.pressure_y += weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        result.x -= coefficients.inverse_mass * sums.pressure_x;
        result.y -= coefficients.inverse_mass * sums.pressure_y;
    }
};

} // namespace slurry
