#pragma once
// Wendland's kernels C2 and C4 in two dimensions [wendland1995, dehnen2012], their support set to 3 h as the
// quintic spline's. Their Fourier transforms are positive, so that particles do not pair.
#include "solver/loop/pack.hpp"

#include <numbers>

namespace slurry {

// 7 / (9 pi h^2) (1 - u)^4 (1 + 4 u), u = r / 3h
struct WendlandC2 {
    static constexpr double support = 3; // in smoothing lengths
    static constexpr double normalisation = 7 / (9 * std::numbers::pi);

    // h^2 W, from s = (r/h)^2
    template <class P> static P value(const P& s) {
        using Real = Element<P>;
        const P u = Real(1.0 / 3) * s * inverse_square_root(s);
        const P rest = positive_part(1 - u);
        const P squared = rest * rest;
        return Real(normalisation) * squared * squared * (1 + 4 * u);
    }
    // h^4 (dW/dr) / r
    template <class P> static P slope(const P& s) {
        using Real = Element<P>;
        const P rest = positive_part(1 - Real(1.0 / 3) * s * inverse_square_root(s));
        return Real(-20.0 / 9 * normalisation) * rest * rest * rest;
    }
};

// 1 / (pi h^2) (1 - u)^6 (1 + 6 u + 35/3 u^2), u = r / 3h
struct WendlandC4 {
    static constexpr double support = 3; // in smoothing lengths
    static constexpr double normalisation = 1 / std::numbers::pi;

    // h^2 W, from s = (r/h)^2
    template <class P> static P value(const P& s) {
        using Real = Element<P>;
        const P u = Real(1.0 / 3) * s * inverse_square_root(s);
        const P rest = positive_part(1 - u);
        const P squared = rest * rest;
        return Real(normalisation) * squared * squared * squared * (1 + u * (6 + Real(35.0 / 3) * u));
    }
    // h^4 (dW/dr) / r
    template <class P> static P slope(const P& s) {
        using Real = Element<P>;
        const P u = Real(1.0 / 3) * s * inverse_square_root(s);
        const P rest = positive_part(1 - u);
        const P squared = rest * rest;
        return Real(-56.0 / 27 * normalisation) * squared * squared * rest * (1 + 5 * u);
    }
};

} // namespace slurry
