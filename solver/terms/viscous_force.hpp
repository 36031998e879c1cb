#pragma once
// Viscous force, second term of Eq. 2.15 [wang2014, morris1997]:
// dv_i/dt = 1/m_i sum_j (V_i^2 + V_j^2) eta v_ij (dW/dr) / r. The harmonic mean of Eq. 2.15 is eta itself in
// one fluid.
#include "solver/terms/pressure_force.hpp"

namespace slurry {

struct ViscousForce {
    template <class P> struct Sums { P viscous_x{}, viscous_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P weight = force_weight(pair, i, j);
        sums.viscous_x += weight * (i.velocity_x() - j.velocity_x());
        sums.viscous_y += weight * (i.velocity_y() - j.velocity_y());
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const ForceView<P>& /*unused*/,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        const Real factor = coefficients.dynamic_viscosity * coefficients.inverse_mass;
        result.x += factor * sums.viscous_x;
        result.y += factor * sums.viscous_y;
    }
};

} // namespace slurry
