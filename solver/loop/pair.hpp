#pragma once
// Geometry of one pair, as every term sees it.
#include "solver/loop/pack.hpp"

namespace slurry {

// d = r_i - r_j; grad_i W = slope * d, that is slope = (dW/dr) / r.
template <class P> struct Pair {
    P dx, dy;
    P squared_distance;
    P kernel;
    P slope;
};

// The kernel in two dimensions at one smoothing length.
template <class Real> struct KernelScale {
    Real inverse_smoothing_length;
    Real kernel_factor; // lambda / h^2
    Real slope_factor;  // lambda / h^3
    Real softening;     // m2, keeps coincident particles finite: 1e-12 h^2 is far below every real distance

    template <class Kernel> static KernelScale of(double smoothing_length) {
        const double h = smoothing_length;
        const double lambda = Kernel::normalisation[1];
        return {static_cast<Real>(1 / h), static_cast<Real>(lambda / (h * h)),
                static_cast<Real>(lambda / (h * h * h)), static_cast<Real>(1e-12 * h * h)};
    }
};

template <class Kernel, class P, class Real>
Pair<P> make_pair(const KernelScale<Real>& scale, const P& dx, const P& dy) {
    const P squared = dx * dx + dy * dy + scale.softening;
    const P inverse = inverse_square_root(squared);
    const P q = squared * inverse * scale.inverse_smoothing_length;
    return {dx, dy, squared, Kernel::shape(q) * scale.kernel_factor,
            Kernel::slope(q) * inverse * scale.slope_factor};
}

} // namespace slurry
