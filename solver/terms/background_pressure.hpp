#pragma once
// Background pressure of the transport velocity, Eq. 2.19 [wang2014, adami2013]:
// f_pb,i = -p_b / m_i sum_j (V_i^2 + V_j^2) grad W_ij. It moves particles towards even spacing, not the
// fluid.
#include "solver/scene/scene.hpp"
#include "solver/terms/pressure_force.hpp"

#include <algorithm>

namespace slurry {

// p_b / (rho0 c^2) as the scene has it, or as far as shifts do not overshoot. Eq. 2.30 moves a particle by
// half the square of the time step times the background acceleration; where (c dt / h)^2 p_b / (rho0 c^2) is
// about 1, that moves neighbours past even spacing, and the flow gains energy (verification/stability:
// vortices at Re 1000 are quiet at 0.84 and 0.93 and not at 1.04).
inline double stable_background_pressure_ratio(const Numerics& numerics, double time_step) {
    constexpr double largest = 0.85;
    const double step = numerics.sound_speed * time_step / numerics.smoothing_length();
    return std::min(numerics.background_pressure_ratio, largest / std::max(step * step, 1e-300));
}

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
