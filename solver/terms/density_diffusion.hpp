#pragma once
// Density diffusion between fluid particles: it removes the particle-to-particle noise that Eq. 2.14 leaves
// in the density. Two parts, of which a scene has its shares:
//   second order [molteni2009]: d rho_i / dt += delta h c sum_j psi_ij . grad W_ij V_j with
//     psi_ij = 2 (rho_j - rho_i) r_ji / r^2, a Laplacian: of steady pressure gradients, too;
//   fourth order: psi_ij (1 - m r^2 / h^2) in place of psi_ij. Its second moment vanishes over a lattice, so
//     that smooth fields do not feel it. Among disordered particles the moment is not quite zero and may be
//     negative: some diffusion of second order has to go with it.
#include "solver/loop/pair.hpp"
#include "solver/scene/scene.hpp"
#include "solver/terms/views.hpp"

#include <algorithm>

namespace slurry {

// delta, at most that of the scene. Viscosity damps the noise, too, and does all of it where c h / nu is of
// order one; the errors of the diffusion are largest there. So delta falls with the spacing, and they are of
// second order.
inline double effective_density_diffusion(const Fluid& fluid, const Numerics& numerics) {
    constexpr double unaided = 2.5; // c h / nu
    const double sound_reynolds =
        numerics.sound_speed * numerics.smoothing_length() / std::max(fluid.kinematic_viscosity(), 1e-300);
    return numerics.density_diffusion * std::min(sound_reynolds / unaided, 1.0);
}

// m: h^2 sum_j F r^2 / sum_j F r^4 over a lattice, F = (dW/dr) / r. The smoothing length h is
// `smoothing_ratio` times the spacing.
template <class Kernel> double lattice_moment_ratio(double smoothing_ratio) {
    const int reach = static_cast<int>(Kernel::support * smoothing_ratio);
    double second = 0;
    double fourth = 0;
    for (int column = -reach; column <= reach; ++column) {
        for (int row = -reach; row <= reach; ++row) {
            const double squared = (column * column + row * row) / (smoothing_ratio * smoothing_ratio);
            if (squared > 0 && squared < Kernel::support * Kernel::support) {
                second += Kernel::slope(squared) * squared;
                fourth += Kernel::slope(squared) * squared * squared;
            }
        }
    }
    return second / fourth;
}

struct DensityDiffusion {
    template <class P> struct Sums { P plain{}, squared{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& i, const RateView<P>& j) {
        const P flow = (i.density() - j.density()) * pair.slope * j.fluid_volume();
        sums.plain += flow;
        sums.squared += flow * pair.squared;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& /*unused*/,
                       const RateCoefficients<Real>& coefficients, Rate<P>& result) {
        result.density_rate +=
            2 * coefficients.diffusivity * (sums.plain - coefficients.diffusion_moment * sums.squared);
    }
};

// With a body force the fluid at rest has a density gradient rho0 f / c^2, which must not diffuse: at walls,
// where the sum is one-sided, it would drive the density away from equilibrium. Subtracts it [fourtakas2019,
// linearised].
struct HydrostaticDiffusion {
    template <class P> struct Sums { P plain_x{}, plain_y{}, squared_x{}, squared_y{}; };
    template <class P>
    static void add(Sums<P>& sums, const Pair<P>& pair, const RateView<P>& /*unused*/, const RateView<P>& j) {
        const P weight = pair.slope * j.fluid_volume();
        const P squared_weight = weight * pair.squared;
        sums.plain_x += weight * pair.dx;
        sums.plain_y += weight * pair.dy;
        sums.squared_x += squared_weight * pair.dx;
        sums.squared_y += squared_weight * pair.dy;
    }
    template <class P, class Real>
    static void finish(const Sums<P>& sums, const RateView<P>& /*unused*/,
                       const RateCoefficients<Real>& coefficients, Rate<P>& result) {
        const P offset_x = sums.plain_x - coefficients.diffusion_moment * sums.squared_x;
        const P offset_y = sums.plain_y - coefficients.diffusion_moment * sums.squared_y;
        result.density_rate -=
            2 * coefficients.diffusivity *
            (coefficients.density_slope_x * offset_x + coefficients.density_slope_y * offset_y);
    }
};

} // namespace slurry
