// The passes of a time step over pairs of particles. Which terms are in a pass is a compile-time composition;
// the branches here choose among compositions once per pass.
#include "solver/kernels/quintic_spline.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/loop/periodic_rows.hpp"
#include "solver/loop/sweep.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/terms/advection_tensor.hpp"
#include "solver/terms/background_pressure.hpp"
#include "solver/terms/continuity.hpp"
#include "solver/terms/density_diffusion.hpp"
#include "solver/terms/gradient_correction.hpp"
#include "solver/terms/number_density.hpp"
#include "solver/terms/pressure_force.hpp"
#include "solver/terms/selection.hpp"
#include "solver/terms/viscous_force.hpp"
#include "solver/terms/wall_extrapolation.hpp"
#include "solver/terms/wall_fit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace slurry {

namespace {

// Extra reach of the neighbour lists, in particle spacings: a longer skin means fewer rebuilds and longer
// lists.
constexpr double skin_ratio = 0.35;

template <class P> void store_lanes(std::vector<double>& to, std::size_t first, const P& from) {
    if constexpr (std::is_floating_point_v<P>) {
        to[first] = from;
    } else {
        constexpr std::size_t lanes = sizeof(P) / sizeof(from[0]);
        for (std::size_t lane = 0; lane < lanes && first + lane < to.size(); ++lane) {
            to[first + lane] = from[lane];
        }
    }
}

template <class Real, int W> class PairInteractions final : public Interactions {
  public:
    explicit PairInteractions(const Scene& scene)
        : domain_(scene.domain), fluid_(scene.fluid), numerics_(scene.numerics), terms_(select_terms(scene)),
          scale_(KernelScale<Real>::template of<Kernel>(scene.numerics.smoothing_length())), fluid_list_(W),
          dummy_list_(W) {}

    void refresh_neighbours(Particles& particles) override {
        const double skin = skin_ratio * numerics_.particle_spacing;
        if (rebuilds_ > 0) {
            const double displacement = periodic_.relative_displacement(particles);
            if (displacement < skin) {
                return;
            }
            refuse_flight(particles, displacement);
        }
        const double reach = Kernel::support * numerics_.smoothing_length() + skin;
        // The wall point of a dummy beside a periodic side may lie beyond it, by as much as the dummy is
        // deep.
        const auto& depths = particles.dummies.depth;
        const bool fits = terms_.walls && numerics_.wall_extrapolation == WallExtrapolation::fit;
        const double deepest = fits && !depths.empty() ? *std::max_element(depths.begin(), depths.end()) : 0;
        periodic_.rebuild(particles, domain_, reach, deepest);
        const auto x = periodic_.x();
        const auto y = periodic_.y();
        const CellGrid all(x, y, periodic_.all_rows(), reach);
        fluid_list_.build(x, y, all, 0, periodic_.fluid_count(), periodic_.padding(), reach);
        if (terms_.walls) {
            const CellGrid fluid(x, y, periodic_.fluid_rows(), reach);
            std::vector<double> target_x(x.begin(), x.end());
            std::vector<double> target_y(y.begin(), y.end());
            if (numerics_.wall_extrapolation == WallExtrapolation::fit) {
                move_to_wall_points(particles.dummies, target_x, target_y);
            }
            dummy_list_.build(target_x, target_y, fluid, periodic_.fluid_count(), periodic_.particle_count(),
                              periodic_.padding(), reach);
        }
        rows_.resize(periodic_.row_count());
        ++rebuilds_;
    }

    void compute_density_rate(Particles& particles) override {
        FluidParticles& fluid = particles.fluid;
        const DummyParticles& dummies = particles.dummies;
        fill_rows(
            particles,
            [&](std::size_t i) {
                const double volume = fluid.mass / fluid.density[i];
                return make_row(fluid.x[i], fluid.y[i], fluid.velocity_x[i], fluid.velocity_y[i], volume,
                                fluid.density[i], volume, 0);
            },
            [&](std::size_t d) {
                const Vector velocity = continuity_velocity(dummies, d);
                return make_row(dummies.x[d], dummies.y[d], velocity.x(), velocity.y(), dummies.volume[d],
                                fluid_.density, 0, 0);
            });
        if (terms_.gradient_correction) {
            rate_with<CorrectedContinuity>(fluid);
        } else {
            rate_with<Continuity>(fluid);
        }
    }

    void compute_volumes(Particles& particles) override {
        const DummyParticles& dummies = particles.dummies;
        FluidParticles& fluid = particles.fluid;
        if (numerics_.particle_volume == ParticleVolume::mass_over_density) {
            std::transform(fluid.density.begin(), fluid.density.end(), fluid.volume.begin(),
                           [&](double density) { return fluid.mass / density; });
            return;
        }
        const double cell = numerics_.particle_spacing * numerics_.particle_spacing;
        fill_rows(
            particles, [&](std::size_t i) { return make_row(fluid.x[i], fluid.y[i], 1, 0, 0, 0, 0, 0); },
            [&](std::size_t d) {
                return make_row(dummies.x[d], dummies.y[d], dummies.volume[d] / cell, 0, 0, 0, 0, 0);
            });
        const VolumeCoefficients<Real> coefficients{Kernel::shape(Real{0}) * scale_.kernel_factor};
        sweep<Real, W, Kernel, VolumeView, Volume>(Composition<NumberDensity>{}, fluid_list_, rows(), scale_,
                                                   coefficients,
                                                   [&](std::size_t first, const Volume<P>& result) {
                                                       store_lanes(fluid.volume, first, result.volume);
                                                   });
    }

    void extrapolate_to_walls(Particles& particles) override {
        if (!terms_.walls) {
            return;
        }
        if (numerics_.wall_extrapolation == WallExtrapolation::fit) {
            fill_wall_rows(particles);
            sweep_walls<WallView>(Composition<VelocityFit, PressureFit>{}, particles);
            return;
        }
        fill_force_rows(particles);
        sweep_walls<ForceView>(Composition<VelocityExtrapolation, PressureExtrapolation>{}, particles);
        DummyParticles& dummies = particles.dummies;
        for (std::size_t d = 0; d < dummies.size(); ++d) { // Eq. 2.16
            const Vector& wall_velocity = dummies.wall_velocity[static_cast<std::size_t>(dummies.wall[d])];
            dummies.velocity_x[d] = 2 * wall_velocity.x() - dummies.velocity_x[d];
            dummies.velocity_y[d] = 2 * wall_velocity.y() - dummies.velocity_y[d];
        }
    }

    void compute_forces(Particles& particles) override {
        fill_force_rows(particles);
        FluidParticles& fluid = particles.fluid;
        if (terms_.viscosity) {
            forces_with<PressureForce, ViscousForce>(fluid);
        } else {
            forces_with<PressureForce>(fluid);
        }
    }

    [[nodiscard]] long rebuilds() const override { return rebuilds_; }

  private:
    using P = Pack<Real, W>;
    using Kernel = QuinticSpline;

    [[nodiscard]] std::span<const Row<Real>> rows() const { return rows_; }

    // Lists are looked at twice a step: whoever has left its neighbours behind since then is not simulated
    // any more.
    void refuse_flight(const Particles& particles, double displacement) const {
        if (displacement > 5 * numerics_.particle_spacing) {
            throw RunError(fmt::format("time {:.6g} s: {}; reduce numerics.acoustic_cfl, or raise "
                                       "numerics.sound_speed to 10 times the top speed",
                                       particles.time, periodic_.farthest_moved(particles)));
        }
    }

    [[nodiscard]] Vector continuity_velocity(const DummyParticles& dummies, std::size_t d) const {
        return numerics_.wall_continuity == WallContinuity::wall_velocity
                   ? dummies.wall_velocity[static_cast<std::size_t>(dummies.wall[d])]
                   : Vector(dummies.velocity_x[d], dummies.velocity_y[d]);
    }

    static Row<Real> make_row(std::convertible_to<double> auto... values) { return {{Real(values)...}}; }

    // Writes the rows of a pass: fluid_row(i), dummy_row(d), their periodic copies, and the padding.
    template <class FluidRow, class DummyRow>
    void fill_rows(const Particles& particles, FluidRow&& fluid_row, DummyRow&& dummy_row) {
        const auto fluid_count = static_cast<std::ptrdiff_t>(particles.fluid.size());
        const auto dummy_count = static_cast<std::ptrdiff_t>(particles.dummies.size());
        Row<Real>* rows = rows_.data();
#pragma omp parallel for schedule(static)
        for (std::ptrdiff_t i = 0; i < fluid_count; ++i) {
            rows[i] = fluid_row(static_cast<std::size_t>(i));
        }
        for (std::ptrdiff_t d = 0; d < dummy_count; ++d) {
            rows[fluid_count + d] = dummy_row(static_cast<std::size_t>(d));
        }
        Row<Real>* copy = rows + fluid_count + dummy_count;
        for (const PeriodicRows::Copy& of : periodic_.copies()) {
            *copy = rows[of.source];
            copy->field[0] += static_cast<Real>(of.shift.x());
            copy->field[1] += static_cast<Real>(of.shift.y());
            ++copy;
        }
        // Beyond every kernel; the ones keep quotients of volumes finite.
        constexpr double far = 1e9; // m
        *copy = make_row(far, far, 0, 0, 1, 1, 1, 0);
    }

    void fill_force_rows(const Particles& particles) {
        const FluidParticles& fluid = particles.fluid;
        const DummyParticles& dummies = particles.dummies;
        fill_rows(
            particles,
            [&](std::size_t i) {
                return make_row(fluid.x[i], fluid.y[i], fluid.velocity_x[i], fluid.velocity_y[i],
                                fluid.density[i] * fluid.shift_x[i], fluid.density[i] * fluid.shift_y[i],
                                fluid.volume[i], fluid.volume[i] * fluid.pressure[i]);
            },
            [&](std::size_t d) {
                return make_row(dummies.x[d], dummies.y[d], dummies.velocity_x[d], dummies.velocity_y[d], 0,
                                0, dummies.volume[d], dummies.volume[d] * dummies.pressure[d]);
            });
    }

    // A fit asks for the fluid around the wall point of a dummy, a mean for that around the dummy.
    void move_to_wall_points(const DummyParticles& dummies, std::vector<double>& x,
                             std::vector<double>& y) const {
        for (std::size_t d = 0; d < dummies.size(); ++d) {
            x[periodic_.fluid_count() + d] += dummies.depth[d] * dummies.normal_x[d];
            y[periodic_.fluid_count() + d] += dummies.depth[d] * dummies.normal_y[d];
        }
    }

    void fill_wall_rows(const Particles& particles) {
        const FluidParticles& fluid = particles.fluid;
        const DummyParticles& dummies = particles.dummies;
        const double h = numerics_.smoothing_length();
        fill_rows(
            particles,
            [&](std::size_t i) {
                return make_row(fluid.x[i], fluid.y[i], fluid.velocity_x[i], fluid.velocity_y[i],
                                fluid.pressure[i], 0, 0, 0);
            },
            [&](std::size_t d) {
                const Vector& velocity = dummies.wall_velocity[static_cast<std::size_t>(dummies.wall[d])];
                return make_row(dummies.x[d] + dummies.depth[d] * dummies.normal_x[d],
                                dummies.y[d] + dummies.depth[d] * dummies.normal_y[d],
                                dummies.normal_x[d] / h, dummies.normal_y[d] / h, velocity.x(), velocity.y(),
                                dummies.depth[d] / h, 0.5 * dummies.curvature[d] * h);
            });
    }

    template <template <class> class View, class Terms> void sweep_walls(Terms terms, Particles& particles) {
        DummyParticles& dummies = particles.dummies;
        const ExtrapolationCoefficients<Real> coefficients{static_cast<Real>(particles.fluid.mass),
                                                           static_cast<Real>(fluid_.body_force.x()),
                                                           static_cast<Real>(fluid_.body_force.y())};
        sweep<Real, W, Kernel, View, Extrapolation>(
            terms, dummy_list_, rows(), scale_, coefficients,
            [&](std::size_t first, const Extrapolation<P>& result) {
                store_lanes(dummies.velocity_x, first, result.velocity_x);
                store_lanes(dummies.velocity_y, first, result.velocity_y);
                store_lanes(dummies.pressure, first, result.pressure);
            });
    }

    template <class Divergence> void rate_with(FluidParticles& fluid) {
        if (terms_.hydrostatic_diffusion) {
            sweep_rate(Composition<Divergence, DensityDiffusion, HydrostaticDiffusion>{}, fluid);
        } else if (terms_.density_diffusion) {
            sweep_rate(Composition<Divergence, DensityDiffusion>{}, fluid);
        } else {
            sweep_rate(Composition<Divergence>{}, fluid);
        }
    }

    template <class Terms> void sweep_rate(Terms terms, FluidParticles& fluid) {
        const double c = numerics_.sound_speed;
        const Vector slope = fluid_.density / (c * c) * fluid_.body_force;
        const RateCoefficients<Real> coefficients{
            static_cast<Real>(numerics_.density_diffusion * numerics_.smoothing_length() * c),
            static_cast<Real>(slope.x()), static_cast<Real>(slope.y())};
        sweep<Real, W, Kernel, RateView, Rate>(
            terms, fluid_list_, rows(), scale_, coefficients, [&](std::size_t first, const Rate<P>& result) {
                store_lanes(fluid.density_rate, first, result.density_rate);
            });
    }

    template <class... Forces> void forces_with(FluidParticles& fluid) {
        if (terms_.advection_tensor) {
            sweep_forces(Composition<Forces..., BackgroundPressure, AdvectionTensor>{}, fluid);
        } else if (terms_.transport_velocity) {
            sweep_forces(Composition<Forces..., BackgroundPressure>{}, fluid);
        } else {
            sweep_forces(Composition<Forces...>{}, fluid);
        }
    }

    template <class Terms> void sweep_forces(Terms terms, FluidParticles& fluid) {
        const double c = numerics_.sound_speed;
        const ForceCoefficients<Real> coefficients{
            static_cast<Real>(1 / fluid.mass), static_cast<Real>(fluid_.dynamic_viscosity),
            static_cast<Real>(numerics_.background_pressure_ratio * fluid_.density * c * c)};
        sweep<Real, W, Kernel, ForceView, Acceleration>(
            terms, fluid_list_, rows(), scale_, coefficients,
            [&](std::size_t first, const Acceleration<P>& result) {
                store_lanes(fluid.acceleration_x, first, result.x);
                store_lanes(fluid.acceleration_y, first, result.y);
                store_lanes(fluid.background_x, first, result.background_x);
                store_lanes(fluid.background_y, first, result.background_y);
            });
    }

    Domain domain_;
    Fluid fluid_;
    Numerics numerics_;
    TermSelection terms_;
    KernelScale<Real> scale_;
    PeriodicRows periodic_;
    NeighbourList fluid_list_, dummy_list_;
    std::vector<Row<Real>> rows_;
    long rebuilds_ = 0;
};

} // namespace

std::unique_ptr<Interactions> make_interactions(const Scene& scene, LoopWidth width) {
    if (width == LoopWidth::plain) {
        return std::make_unique<PairInteractions<double, 1>>(scene);
    }
    return std::make_unique<PairInteractions<double, native_lanes<double>>>(scene);
}

} // namespace slurry
