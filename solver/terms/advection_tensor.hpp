#pragma once
// Advection tensor, Eq. 2.20 [wang2014, adami2013]: dv_i/dt += 1/m_i sum_j (V_i^2 + V_j^2) (A_i + A_j)/2 .
// grad W_ij with A = rho v (x) (v~ - v), the momentum carried by the difference between advection velocity v~
// and velocity v.
#include "solver/terms/background_pressure.hpp"

namespace slurry {

// Goes with BackgroundPressure: what A_i adds is A_i . sum_j (V_i^2 + V_j^2) grad W_ij, whose sum is there
// already.
struct AdvectionTensor {
    template <class P> struct Sums { P advection_x{}, advection_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const ForceView<P>& i, const ForceView<P>& j) {
        const P flux =
            force_weight(pair, i, j) * (j.shift_momentum_x() * pair.dx + j.shift_momentum_y() * pair.dy);
        sums.advection_x += flux * j.velocity_x();
        sums.advection_y += flux * j.velocity_y();
    }
    template <class AllSums, class P, class Real>
    static void finish(const AllSums& sums, const ForceView<P>& i,
                       const ForceCoefficients<Real>& coefficients, Acceleration<P>& result) {
        const P own = i.shift_momentum_x() * sums.background_x + i.shift_momentum_y() * sums.background_y;
        const Real factor = Real{0.5} * coefficients.inverse_mass;
        result.x += factor * (sums.advection_x + own * i.velocity_x());
        result.y += factor * (sums.advection_y + own * i.velocity_y());
    }
};

} // namespace slurry
