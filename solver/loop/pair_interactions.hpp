#pragma once
// The passes of a time step over pairs of particles. Which terms are in a pass is a compile-time composition;
// the branches here choose among compositions once per pass.
#include "solver/loop/neighbourhood.hpp"
#include "solver/loop/pair_count.hpp"
#include "solver/loop/pass_rows.hpp"
#include "solver/loop/sweep.hpp"
#include "solver/terms/advection_tensor.hpp"
#include "solver/terms/background_pressure.hpp"
#include "solver/terms/continuity.hpp"
#include "solver/terms/density_diffusion.hpp"
#include "solver/terms/gradient_correction.hpp"
#include "solver/terms/number_density.hpp"
#include "solver/terms/plain_pressure_force.hpp"
#include "solver/terms/pressure_advection.hpp"
#include "solver/terms/pressure_force.hpp"
#include "solver/terms/selection.hpp"
#include "solver/terms/viscous_force.hpp"
#include "solver/terms/viscous_twist.hpp"
#include "solver/terms/wall_extrapolation.hpp"
#include "solver/terms/wall_fit.hpp"
#include "solver/terms/wall_pressure_gradient.hpp"

#include <type_traits>
#include <utility>

namespace slurry {

template <class P> double lane_of(const P& values, std::size_t lane) {
    if constexpr (std::is_arithmetic_v<P>) {
        return values;
    } else {
        return static_cast<double>(values[lane]);
    }
}

// Writes the lanes that belong to particles, in SI units.
template <class P> void store_lanes(std::vector<double>& to, std::size_t first, const P& from, double unit) {
    if constexpr (std::is_arithmetic_v<P>) {
        to[first] = unit * from;
    } else {
        constexpr std::size_t lanes = sizeof(P) / sizeof(from[0]);
        if (first + lanes <= to.size()) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                to[first + lane] = unit * static_cast<double>(from[lane]);
            }
            return;
        }
        for (std::size_t lane = 0; first + lane < to.size(); ++lane) {
            to[first + lane] = unit * static_cast<double>(from[lane]);
        }
    }
}

template <class Kernel, class Real, int W> class PairInteractions final : public Interactions {
  public:
    explicit PairInteractions(const Scene& scene)
        : fluid_(scene.fluid), numerics_(scene.numerics), terms_(select_terms(scene)), units_(scene),
          rate_coefficients_(rate_coefficients(scene, units_)),
          neighbourhood_(scene, Kernel::support, wall_support(scene), W, sizeof(Row<Real>)),
          rows_(scene, neighbourhood_.periodic()) {}

    void refresh_neighbours(Particles& particles) override {
        full_step_rows_ = false;
        neighbourhood_.refresh(particles);
    }

    [[nodiscard]] ListOrigin list_origin() const override { return neighbourhood_.origin(); }

    void restore_lists(const Particles& particles, const ListOrigin& origin) override {
        neighbourhood_.restore(particles, origin);
    }

    void compute_density_rate(Particles& particles) override {
        full_step_rows_ = false;
        rows_.fill_rate(particles);
        if (terms_.gradient_correction) {
            rate_with<CorrectedContinuity>(particles.fluid);
        } else {
            rate_with<Continuity>(particles.fluid);
        }
    }

    void compute_volumes(Particles& particles) override {
        FluidParticles& fluid = particles.fluid;
        if (numerics_.particle_volume != ParticleVolume::number_density) {
            return;
        }
        full_step_rows_ = false;
        rows_.fill_volume(particles, numerics_.particle_spacing);
        const VolumeCoefficients<Real> coefficients{make_pair<Kernel>(Real{0}, Real{0}).kernel};
        fluid.number_density_volume.resize(fluid.size());
        sweep<Real, W, Kernel, VolumeView, Volume>(
            Composition<NumberDensity>{}, neighbourhood_.of_fluid(), rows_.rows(), coefficients,
            [&](std::size_t first, const Volume<P>& result) {
                store_lanes(fluid.number_density_volume, first, result.volume, units_.volume());
            });
    }

    void extrapolate_to_walls(Particles& particles) override {
        if (!terms_.walls) {
            return;
        }
        rows_.fill_full_step(particles);
        full_step_rows_ = true;
        if (numerics_.wall_extrapolation == WallExtrapolation::fit) {
            rows_.fill_wall_dummies(particles);
            if (terms_.discs) {
                sweep_walls<SpinningWallView>(Composition<VelocityFit, PressureFit>{}, particles);
            } else {
                sweep_walls<WallView>(Composition<VelocityFit, PressureFit>{}, particles);
            }
            return;
        }
        rows_.fill_mean_dummies(particles, fluid_.acceleration());
        sweep_walls<MeanView>(Composition<VelocityExtrapolation, PressureExtrapolation>{}, particles);
        DummyParticles& dummies = particles.dummies;
        for (std::size_t d = 0; d < dummies.size(); ++d) { // Eq. 2.16
            dummies.velocity_x[d] = 2 * dummies.solid_velocity_x[d] - dummies.velocity_x[d];
            dummies.velocity_y[d] = 2 * dummies.solid_velocity_y[d] - dummies.velocity_y[d];
        }
    }

    void compute_forces(Particles& particles) override {
        if (!std::exchange(full_step_rows_, false)) {
            rows_.fill_full_step(particles);
        }
        rows_.fill_force_dummies(particles);
        if (terms_.density_weighted_pressure) {
            forces_from<PressureForce>(particles);
            react_to<PressureForce>(particles);
        } else {
            forces_from<PlainPressureForce>(particles);
            react_to<PlainPressureForce>(particles);
        }
    }

    [[nodiscard]] ListStatistics list_statistics(const Particles& particles) const override {
        ListStatistics statistics = neighbourhood_.statistics();
        statistics.bytes += rows_.bytes();
        if (rows_.rows().size() == neighbourhood_.periodic().row_count()) {
            statistics.useful = count_pairs<Real, W, Kernel, ForceView>(
                neighbourhood_.of_fluid(), rows_.rows().data(), particles.fluid.size());
        }
        return statistics;
    }

  private:
    using P = Pack<Real, W>;

    static double wall_support(const Scene& scene) {
        return scene.numerics.wall_extrapolation == WallExtrapolation::fit ? wall_fit_support
                                                                           : Kernel::support;
    }

    template <template <class> class View, class Terms> void sweep_walls(Terms terms, Particles& particles) {
        DummyParticles& dummies = particles.dummies;
        const ExtrapolationCoefficients<Real> coefficients{
            static_cast<Real>(particles.fluid.mass / units_.mass())};
        sweep<Real, W, Kernel, View, Extrapolation>(
            terms, neighbourhood_.of_dummies(), rows_.rows(), coefficients,
            [&](std::size_t first, const Extrapolation<P>& result) {
                store_lanes(dummies.velocity_x, first, result.velocity_x, units_.velocity);
                store_lanes(dummies.velocity_y, first, result.velocity_y, units_.velocity);
                store_lanes(dummies.pressure, first, result.pressure, units_.pressure());
                store_lanes(dummies.fluid_share, first, result.fluid_share, 1);
                if (numerics_.wall_extrapolation == WallExtrapolation::fit) {
                    continue_across_walls(particles, first, result);
                }
            });
    }

    // What a fit leaves to do: the velocity across the wall and the pressure's gradient.
    void continue_across_walls(Particles& particles, std::size_t first,
                               const Extrapolation<P>& result) const {
        DummyParticles& dummies = particles.dummies;
        const double per_length_and_time = units_.velocity / (units_.length * units_.length);
        const std::size_t end = std::min(first + static_cast<std::size_t>(W), dummies.size());
        for (std::size_t d = first; d < end; ++d) {
            const double curvature = per_length_and_time * lane_of(result.normal_curvature, d - first);
            dummies.normal_velocity[d] = 0.5 * curvature * dummies.depth[d] * dummies.depth[d];
            const Vector normal{dummies.normal_x[d], dummies.normal_y[d]};
            const double gradient = dummies.of_disc(d)
                                        ? known_gradient(dummies.fluid_share[d]) * units_.pressure() /
                                              units_.length * lane_of(result.pressure_gradient, d - first)
                                        : wall_pressure_gradient(fluid_, normal, curvature);
            dummies.pressure[d] += units_.length * lane_of(result.pressure_lever, d - first) * gradient;
        }
    }

    template <class Divergence> void rate_with(FluidParticles& fluid) {
        if (terms_.hydrostatic_diffusion) {
            sweep_rate<Divergence, DensityDiffusion, HydrostaticDiffusion>(fluid);
        } else if (terms_.density_diffusion) {
            sweep_rate<Divergence, DensityDiffusion>(fluid);
        } else {
            sweep_rate<Divergence>(fluid);
        }
    }

    template <class... Terms> void sweep_rate(FluidParticles& fluid) {
        if (terms_.pressure_frame) {
            sweep_rate_of(Composition<Terms..., PressureAdvection>{}, fluid);
        } else {
            sweep_rate_of(Composition<Terms...>{}, fluid);
        }
    }

    template <class Terms> void sweep_rate_of(Terms terms, FluidParticles& fluid) {
        sweep<Real, W, Kernel, RateView, Rate>(
            terms, neighbourhood_.of_fluid(), rows_.rows(), rate_coefficients_,
            [&](std::size_t first, const Rate<P>& result) {
                store_lanes(fluid.density_rate, first, result.density_rate, units_.density_rate());
                if (terms_.pressure_frame) {
                    advect_pressure(fluid, first, result);
                }
            });
    }

    // The part of the density rate that PressureAdvection left to do: (v~ - U) . grad rho.
    void advect_pressure(FluidParticles& fluid, std::size_t first, const Rate<P>& result) const {
        const double unit = units_.density / units_.length;
        const Vector frame = *terms_.pressure_frame;
        const std::size_t end = std::min(first + static_cast<std::size_t>(W), fluid.size());
        for (std::size_t i = first; i < end; ++i) {
            fluid.density_rate[i] += unit * ((fluid.velocity_x[i] + fluid.shift_x(i) - frame.x()) *
                                                 lane_of(result.gradient_x, i - first) +
                                             (fluid.velocity_y[i] + fluid.shift_y(i) - frame.y()) *
                                                 lane_of(result.gradient_y, i - first));
        }
    }

    template <class Pressure> void forces_from(Particles& particles) {
        if (terms_.viscosity) {
            forces_with<Pressure, ViscousForce>(particles);
        } else {
            forces_with<Pressure>(particles);
        }
    }

    template <class... Forces> void forces_with(Particles& particles) {
        if (terms_.advection_tensor) {
            sweep_forces<Forces..., BackgroundPressure, AdvectionTensor>(particles);
        } else if (terms_.transport_velocity) {
            sweep_forces<Forces..., BackgroundPressure>(particles);
        } else {
            sweep_forces<Forces...>(particles);
        }
    }

    static RateCoefficients<Real> rate_coefficients(const Scene& scene, const Units& units) {
        const Numerics& numerics = scene.numerics;
        const Vector slope = scene.fluid.acceleration() / units.acceleration();
        return {static_cast<Real>(effective_density_diffusion(scene.fluid, numerics)),
                static_cast<Real>(numerics.fourth_order_diffusion_share *
                                  lattice_moment_ratio<Kernel>(numerics.smoothing_ratio)),
                static_cast<Real>(slope.x()), static_cast<Real>(slope.y())};
    }

    [[nodiscard]] ForceCoefficients<Real> force_coefficients(const Particles& particles) const {
        const double time_step = 2 * particles.fluid.shift_time;
        return {static_cast<Real>(units_.mass() / particles.fluid.mass),
                static_cast<Real>(fluid_.dynamic_viscosity / units_.dynamic_viscosity()),
                static_cast<Real>(stable_background_pressure_ratio(numerics_, time_step))};
    }

    template <class... Forces> void sweep_forces(Particles& particles) {
        FluidParticles& fluid = particles.fluid;
        const double unit = units_.acceleration();
        sweep<Real, W, Kernel, ForceView, Acceleration>(
            Composition<Forces...>{}, neighbourhood_.of_fluid(), rows_.rows(), force_coefficients(particles),
            [&](std::size_t first, const Acceleration<P>& result) {
                store_lanes(fluid.acceleration_x, first, result.x, unit);
                store_lanes(fluid.acceleration_y, first, result.y, unit);
                store_lanes(fluid.background_x, first, result.background_x, unit);
                store_lanes(fluid.background_y, first, result.background_y, unit);
            });
    }

    template <class Pressure> void react_to(Particles& particles) {
        if (terms_.discs && terms_.advection_tensor) {
            react<Pressure, ViscousForce, ViscousTwist, BackgroundPressure, AdvectionTensor>(particles);
        } else if (terms_.discs) {
            react<Pressure, ViscousForce, ViscousTwist>(particles);
        }
    }

    // Eq. 2.23: the same sums over the fluid near the particles of the discs. By the terms' symmetry the
    // forces are those on the fluid, reversed.
    template <class... Forces> void react(Particles& particles) {
        DummyParticles& dummies = particles.dummies;
        const double unit = particles.fluid.mass * units_.acceleration();
        const std::size_t count = dummies.size() - dummies.first_of_discs;
        for (auto* array : {&dummies.force_x, &dummies.force_y, &dummies.twist}) {
            array->resize(count);
        }
        sweep<Real, W, Kernel, ForceView, Acceleration>(
            Composition<Forces...>{}, neighbourhood_.of_discs(), rows_.rows(), force_coefficients(particles),
            [&](std::size_t first, const Acceleration<P>& result) {
                store_lanes(dummies.force_x, first, result.x, unit);
                store_lanes(dummies.force_y, first, result.y, unit);
                store_lanes(dummies.twist, first, result.twist, unit * units_.length);
            });
    }

    Fluid fluid_;
    Numerics numerics_;
    TermSelection terms_;
    Units units_;
    RateCoefficients<Real> rate_coefficients_;
    Neighbourhood neighbourhood_;
    PassRows<Real> rows_;
    bool full_step_rows_ = false; // the fluid's rows are those of the last extrapolation to walls
};

// As wide as the machine's vectors, or with plain numbers.
template <class Kernel>
std::unique_ptr<Interactions> make_pair_interactions(const Scene& scene, LoopWidth width) {
    if (width == LoopWidth::plain) {
        return std::make_unique<PairInteractions<Kernel, double, 1>>(scene);
    }
    if (scene.numerics.pair_arithmetic == PairArithmetic::double_precision) {
        return std::make_unique<PairInteractions<Kernel, double, native_lanes<double>>>(scene);
    }
    return std::make_unique<PairInteractions<Kernel, float, native_lanes<float>>>(scene);
}

// Each in a file of its own, solver/loop/with_<kernel>.cpp: they are long to compile.
extern template std::unique_ptr<Interactions> make_pair_interactions<struct QuinticSpline>(const Scene&,
                                                                                           LoopWidth);
extern template std::unique_ptr<Interactions> make_pair_interactions<struct WendlandC2>(const Scene&,
                                                                                        LoopWidth);
extern template std::unique_ptr<Interactions> make_pair_interactions<struct WendlandC4>(const Scene&,
                                                                                        LoopWidth);
extern template std::unique_ptr<Interactions> make_pair_interactions<struct FittedQuintic>(const Scene&,
                                                                                           LoopWidth);

} // namespace slurry
