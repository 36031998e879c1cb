#pragma once
// Quintic spline kernel, Eq. 2.4 [wang2014, morris1997].
#include "solver/loop/pack.hpp"

#include <array>
#include <numbers>

namespace slurry {

struct QuinticSpline {
    static constexpr double support = 3; // in smoothing lengths

    // lambda of Eq. 2.4 in 1, 2 and 3 dimensions. The paper prints 3/(359 pi) for 3D, which integrates
    // to 1.0028; 1/(120 pi) integrates to one.
    static constexpr std::array<double, 3> normalisation{1.0 / 120, 7 / (478 * std::numbers::pi),
                                                         1 / (120 * std::numbers::pi)};

    // h^2 W in two dimensions, from s = (r/h)^2. The powers of positive parts give the four cases of Eq. 2.4
    // without a branch.
    template <class P> static P value(const P& s) {
        using Real = Element<P>;
        const P q = s * inverse_square_root(s);
        return Real(normalisation[1]) * fifth(positive_part(3 - q)) -
               Real(6 * normalisation[1]) * fifth(positive_part(2 - q)) +
               Real(15 * normalisation[1]) * fifth(positive_part(1 - q));
    }
    // h^4 (dW/dr) / r
    template <class P> static P slope(const P& s) {
        using Real = Element<P>;
        const P inverse = inverse_square_root(s);
        const P q = s * inverse;
        return (Real(30 * normalisation[1]) * fourth(positive_part(2 - q)) -
                Real(5 * normalisation[1]) * fourth(positive_part(3 - q)) -
                Real(75 * normalisation[1]) * fourth(positive_part(1 - q))) *
               inverse;
    }

  private:
    template <class P> static P fourth(const P& x) { return (x * x) * (x * x); }
    template <class P> static P fifth(const P& x) { return fourth(x) * x; }
};

} // namespace slurry
