#pragma once
// Advection tensor, Eq. 2.20 [wang2014, adami2013]: dv_i/dt += 1/m_i sum_j (V_i^2 + V_j^2) (A_i + A_j)/2 .
// grad W_ij with A = rho v (x) (v~ - v), the momentum carried by the difference between advection velocity v~
// and velocity v.
#include "solver/terms/pressure_force.hpp"

namespace slurry {

struct AdvectionTensor {
    template <class P> struct Sums { P advection_x{}, advection_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P weight = force_weight(pair, i, j);
        const P flux_i = weight * (i.shift_momentum_x() * pair.dx + i.shift_momentum_y() * pair.dy);
        const P flux_j = weight * (j.shift_momentum_x() * pair.dx + j.shift_momentum_y() * pair.dy);
        sums.advection_x += flux_i * i.velocity_x() + flux_j * j.velocity_x();
        sums.advection_y += flux_i * i.velocity_y() + flux_j * j.velocity_y();
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        result.x += Real{0.5} * coefficients.inverse_mass * sums.advection_x;
        result.y += Real{0.5} * coefficients.inverse_mass * sums.advection_y;
    }
};

} // namespace slurry
