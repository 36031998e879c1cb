#pragma once
// 9 / (pi R^2) (1 - (r / R)^2)^8, R = 2.947 h: an even polynomial close to the quintic spline, which itself
// is close to a Gaussian. It needs no square root. With this R the second moment of its gradient over a
// lattice of spacing h, sum V (dW/dr) / r x^2, is -1 as in the continuum, so that viscosity and pressure
// gradients keep their strength.
#include "solver/loop/pack.hpp"

#include <numbers>

namespace slurry {

struct CompactGaussian {
    static constexpr double support = 2.947; // in smoothing lengths
    static constexpr double normalisation = 9 / (std::numbers::pi * support * support);

    // h^2 W, from s = (r/h)^2
    template <class P> static P value(const P& s) {
        const P x = rest(s);
        return Element<P>(normalisation) * seventh(x) * x;
    }
    // h^4 (dW/dr) / r
    template <class P> static P slope(const P& s) {
        return Element<P>(-16 / (support * support) * normalisation) * seventh(rest(s));
    }

  private:
    template <class P> static P rest(const P& s) {
        return positive_part(1 - Element<P>(1 / (support * support)) * s);
    }
    template <class P> static P seventh(const P& x) {
        const P square = x * x;
        return (square * square) * (square * x);
    }
};

} // namespace slurry
