#pragma once
// Particle volume V_i = 1 / sum_j W_ij (Sec. 2.1, below Eq. 2.8) [wang2014, hu2006], the particle itself
// included.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

struct NumberDensity {
    template <class P> struct Sums { P kernel{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const VolumeView<P>& /*unused*/,
                    const VolumeView<P>& j) {
        sums.kernel += pair.kernel * j.weight();
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const VolumeView<P>& /*unused*/,
                       const VolumeCoefficients<Real>& coefficients, Volume<P>& result) {
        result.volume = 1 / (sums.kernel + coefficients.self_kernel);
    }
};

} // namespace slurry
