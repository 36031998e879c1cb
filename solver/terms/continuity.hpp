#pragma once
// Continuity, Eq. 2.14 [wang2014]: d rho_i / dt = rho_i sum_j V_j v_ij . grad W_ij, with V_j = m_j / rho_j.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

struct Continuity {
    template <class P> struct Sums { P compression{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        const P approach =
            (i.velocity_x() - j.velocity_x()) * pair.dx + (i.velocity_y() - j.velocity_y()) * pair.dy;
        sums.compression += j.volume() * pair.slope * approach;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& i, const RateCoefficients<Real>& /*unused*/,
                       Rate<P>& result) {
        result.density_rate += i.density() * sums.compression;
    }
};

} // namespace slurry
