#pragma once
// Geometry of one pair, as every term sees it.
#include "solver/loop/pack.hpp"

namespace slurry {

// d = r_i - r_j; grad_i W = slope * d, that is slope = (dW/dr) / r. Lengths in smoothing lengths.
template <class P> struct Pair {
    P dx, dy;
    P squared; // of the distance
    P kernel;
    P slope;
};

template <class Kernel, class P> Pair<P> make_pair(const P& dx, const P& dy) {
    // Keeps coincident particles finite, and is far below every real distance.
    constexpr auto softening = static_cast<Element<P>>(1e-12);
    const P squared = dx * dx + (dy * dy + softening);
    return {dx, dy, squared, Kernel::value(squared), Kernel::slope(squared)};
}

} // namespace slurry
