#pragma once
// Continuity with the kernel gradient correction of Eqs. 2.21 and 2.22 [wang2014, bonet1999].
//
// L_i is the same for all pairs of i, so sum_j V_j v_ij . (L_i grad W_ij) = L_i : sum_j V_j v_ij (x) grad
// W_ij. Both sums fit in one sweep and are contracted afterwards; L needs no pass of its own.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

struct CorrectedContinuity {
    template <class P> struct Sums {
        P gradient_xx{}, gradient_xy{}, gradient_yx{}, gradient_yy{}; // sum V v_ij (x) grad W
        P moment_xx{}, moment_xy{}, moment_yy{};                      // -sum V grad W (x) r_ij
    };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        const P weight_x = j.volume() * pair.slope * pair.dx;
        const P weight_y = j.volume() * pair.slope * pair.dy;
        const P velocity_x = i.velocity_x() - j.velocity_x();
        const P velocity_y = i.velocity_y() - j.velocity_y();
        sums.gradient_xx += velocity_x * weight_x;
        sums.gradient_xy += velocity_x * weight_y;
        sums.gradient_yx += velocity_y * weight_x;
        sums.gradient_yy += velocity_y * weight_y;
        sums.moment_xx -= weight_x * pair.dx;
        sums.moment_xy -= weight_x * pair.dy;
        sums.moment_yy -= weight_y * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& i, const RateCoefficients<Real>& /*unused*/,
                       Rate<P>& result) {
        const P determinant = sums.moment_xx * sums.moment_yy - sums.moment_xy * sums.moment_xy;
        // det M is 1 with full support; a particle with next to no neighbours has no L and keeps the plain
        // gradient.
        const P plain = sums.gradient_xx + sums.gradient_yy;
        const P adjugate = sums.moment_yy * sums.gradient_xx + sums.moment_xx * sums.gradient_yy -
                           sums.moment_xy * (sums.gradient_xy + sums.gradient_yx);
        const P compression = determinant > Real(0.1) ? adjugate / determinant : plain;
        result.density_rate += i.density() * compression;
    }
};

} // namespace slurry
