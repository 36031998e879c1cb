#pragma once
// Density diffusion between fluid particles [molteni2009]: d rho_i / dt += delta h c sum_j psi_ij . grad W_ij
// V_j with psi_ij = 2 (rho_j - rho_i) r_ji / r^2. It removes the particle-to-particle noise that Eq. 2.14
// leaves in the density.
#include "solver/loop/pair.hpp"
#include "solver/terms/views.hpp"

namespace slurry {

struct DensityDiffusion {
    template <class P> struct Sums { P diffusion{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        sums.diffusion += (i.density() - j.density()) * pair.slope * j.fluid_volume();
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& /*unused*/,
                       const RateCoefficients<Real>& coefficients, Rate<P>& result) {
        result.density_rate += 2 * coefficients.diffusivity * sums.diffusion;
    }
};

// With a body force the fluid at rest has a density gradient rho0 f / c^2, which must not diffuse: at walls,
// where the sum is one-sided, it would drive the density away from equilibrium. Subtracts it [fourtakas2019,
// linearised].
struct HydrostaticDiffusion {
    template <class P> struct Sums { P offset_x{}, offset_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& /*unused*/, const RateView<P>& j) {
        const P weight = pair.slope * j.fluid_volume();
        sums.offset_x += weight * pair.dx;
        sums.offset_y += weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& /*unused*/,
                       const RateCoefficients<Real>& coefficients, Rate<P>& result) {
        result.density_rate -=
            2 * coefficients.diffusivity *
            (coefficients.density_slope_x * sums.offset_x + coefficients.density_slope_y * sums.offset_y);
    }
};

} // namespace slurry
