#pragma once
// What the fluid near a wall hands to the wall's dummies, Eqs. 2.16 and 2.17 [wang2014, adami2012].
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

// Less, at the very edge of the support, is no weight: its reciprocal may be beyond the range of a float.
inline constexpr double least_weight = 1e-30; // h^2 W

// sum_f v_f W_df / sum_f W_df; the caller reflects it about the wall's velocity (Eq. 2.16).
struct VelocityExtrapolation {
    template <class P> struct Sums { P kernel{}, velocity_x{}, velocity_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const MeanView<P>& /*unused*/,
                    const MeanView<P>& fluid) {
        sums.kernel += pair.kernel;
        sums.velocity_x += pair.kernel * fluid.velocity_x();
        sums.velocity_y += pair.kernel * fluid.velocity_y();
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const MeanView<P>& /*unused*/,
                       const ExtrapolationCoefficients<Real>& /*unused*/, Extrapolation<P>& result) {
        const P zero{};
        const P inverse = sums.kernel > zero + Real(least_weight) ? 1 / sums.kernel : zero;
        result.velocity_x = sums.velocity_x * inverse;
        result.velocity_y = sums.velocity_y * inverse;
    }
};

// Eq. 2.17: (sum_f p_f W_df + (f - a_wall) . sum_f rho_f r_df W_df) / sum_f W_df
struct PressureExtrapolation {
    template <class P> struct Sums { P weight{}, pressure{}, lever_x{}, lever_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const MeanView<P>& /*unused*/,
                    const MeanView<P>& fluid) {
        const P number_weight = pair.kernel / fluid.volume();
        sums.weight += pair.kernel;
        sums.pressure += pair.kernel * fluid.pressure();
        sums.lever_x += number_weight * pair.dx;
        sums.lever_y += number_weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const MeanView<P>& dummy,
                       const ExtrapolationCoefficients<Real>& coefficients, Extrapolation<P>& result) {
        const P zero{};
        const P total = sums.pressure +
                        coefficients.mass * (dummy.force_x() * sums.lever_x + dummy.force_y() * sums.lever_y);
        result.pressure = sums.weight > zero + Real(least_weight) ? total / sums.weight : zero;
    }
};

} // namespace slurry
