#pragma once
// Takes out of the continuity equation the compression by a pressure field that is steady in a frame of
// velocity U.
//
// Eq. 2.14 is c^2 d rho / dt = dp/dt along a particle's path, so that a steady flow has div v = -(v - U) .
// grad p / (rho c^2) in place of 0: an error of order (v / c)^2. With d rho / dt += (v~ - U) . grad rho it is
// the change of pressure at a place fixed in that frame which compresses [chorin1967], and none is left once
// the flow is steady.
//
// What it adds is small, and so it may be of first order: the gradient is the plain one (Eq. 2.8), of the
// densities at the start of the step.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

struct PressureAdvection {
    template <class P> struct Sums { P gradient_x{}, gradient_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        const P difference = j.density() - i.density();
        sums.gradient_x += difference * (j.volume() * pair.slope * pair.dx);
        sums.gradient_y += difference * (j.volume() * pair.slope * pair.dy);
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& /*unused*/,
                       const RateCoefficients<Real>& /*unused*/, Rate<P>& result) {
        result.gradient_x += sums.gradient_x;
        result.gradient_y += sums.gradient_y;
    }
};

} // namespace slurry
