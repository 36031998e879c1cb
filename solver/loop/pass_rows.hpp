#pragma once
// The rows of each pass, made from the particles' state: fluid, dummies, their periodic copies, and the
// padding.
#include "solver/loop/periodic_rows.hpp"
#include "solver/loop/row.hpp"
#include "solver/loop/units.hpp"
#include "solver/terms/particle_volume.hpp"
#include "solver/terms/wall_fit.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace slurry {

// The fields' names are those of the views in solver/terms/views.hpp.
template <class Real> class PassRows {
  public:
    PassRows(const Scene& scene, const PeriodicRows& periodic)
        : units_(scene), wall_continuity_(scene.numerics.wall_continuity),
          particle_volume_(scene.numerics.particle_volume), reference_density_(scene.fluid.density),
          kinematic_viscosity_(std::max(scene.fluid.kinematic_viscosity(), 1e-300)), periodic_(periodic) {}

    [[nodiscard]] std::span<const Row<Real>> rows() const { return rows_; }
    [[nodiscard]] std::size_t bytes() const { return rows_.capacity() * sizeof(Row<Real>); }

    // Fluid and dummies, for RateView.
    void fill_rate(const Particles& particles) {
        const FluidParticles& fluid = particles.fluid;
        const DummyParticles& dummies = particles.dummies;
        const double mass = fluid.mass / units_.mass();
        const double per_density = 1 / units_.density;
        fill_fluid(particles, [&](std::size_t i) {
            const double density = fluid.density[i] * per_density;
            const double volume = mass / density;
            return row(x(fluid.x[i]), y(fluid.y[i]), velocity(fluid.velocity_x[i]),
                       velocity(fluid.velocity_y[i]), volume, density, volume, 0);
        });
        fill_dummies(particles, [&](std::size_t d) {
            const Vector moving = continuity_velocity(dummies, d);
            return row(x(dummies.x[d]), y(dummies.y[d]), velocity(moving.x()), velocity(moving.y()),
                       volume(dummies.volume[d]), 1 + pressure(dummies.pressure[d]), 0, 0);
        });
    }

    // Fluid and dummies, for VolumeView.
    void fill_volume(const Particles& particles, double particle_spacing) {
        const FluidParticles& fluid = particles.fluid;
        const DummyParticles& dummies = particles.dummies;
        const double cell = particle_spacing * particle_spacing;
        fill_fluid(particles,
                   [&](std::size_t i) { return row(x(fluid.x[i]), y(fluid.y[i]), 1, 0, 0, 0, 0, 0); });
        fill_dummies(particles, [&](std::size_t d) {
            return row(x(dummies.x[d]), y(dummies.y[d]), dummies.volume[d] / cell, 0, 0, 0, 0, 0);
        });
    }

    // The fluid's rows of all the full step's passes: ForceView, WallView and MeanView.
    void fill_full_step(const Particles& particles) {
        const FluidParticles& fluid = particles.fluid;
        const double per_momentum = 1 / (units_.density * units_.velocity);
        fill_fluid(particles, [&](std::size_t i) {
            const double shifted = fluid.density[i] * per_momentum;
            return row(x(fluid.x[i]), y(fluid.y[i]), velocity(fluid.velocity_x[i]),
                       velocity(fluid.velocity_y[i]), shifted * fluid.shift_x(i), shifted * fluid.shift_y(i),
                       volume(particle_volume(fluid, i, particle_volume_, reference_density_)),
                       pressure(fluid.pressure[i]));
        });
    }

    // The dummies' rows for ForceView.
    void fill_force_dummies(const Particles& particles) {
        const DummyParticles& dummies = particles.dummies;
        fill_dummies(particles, [&](std::size_t d) {
            return row(x(dummies.x[d]), y(dummies.y[d]), velocity(dummies.velocity_x[d]),
                       velocity(dummies.velocity_y[d]), 0, 0, volume(dummies.volume[d]),
                       pressure(dummies.pressure[d]));
        });
    }

    // For WallView, or SpinningWallView where there are discs: a dummy's row lies at its wall point.
    void fill_wall_dummies(const Particles& particles) {
        const DummyParticles& dummies = particles.dummies;
        const bool spins = !particles.discs.empty();
        fill_dummies(particles, [&](std::size_t d) {
            const Vector to_wall = dummies.depth[d] * Vector(dummies.normal_x[d], dummies.normal_y[d]);
            const double spin = dummies.of_disc(d) ? particles.discs[dummies.disc(d)].spin : 0;
            // As a vector the depth needs a direction, however small it is.
            const double depth = dummies.depth[d] * per_length_;
            const double scale = spins ? std::max(depth, 1e-6) : 1;
            return row(
                x(dummies.x[d] + to_wall.x()), y(dummies.y[d] + to_wall.y()), scale * dummies.normal_x[d],
                scale * dummies.normal_y[d], velocity(dummies.solid_velocity_x[d] - spin * to_wall.y()),
                velocity(dummies.solid_velocity_y[d] + spin * to_wall.x()),
                spins ? velocity(spin) * units_.length : depth, 0.5 * dummies.curvature[d] * units_.length);
        });
    }

    // For MeanView. `acceleration`: of the fluid by its body force, m/s2.
    void fill_mean_dummies(const Particles& particles, const Vector& acceleration) {
        const DummyParticles& dummies = particles.dummies;
        const double per_acceleration = 1 / units_.acceleration();
        fill_dummies(particles, [&](std::size_t d) {
            Vector force = per_acceleration * acceleration;
            if (dummies.of_disc(d)) {
                force -= per_acceleration * solid_acceleration(particles, d);
            }
            return row(x(dummies.x[d]), y(dummies.y[d]), force.x(), force.y(), 0, 0, 1, 0);
        });
    }

  private:
    [[nodiscard]] double x(double position) const { return (position - units_.origin.x()) * per_length_; }
    [[nodiscard]] double y(double position) const { return (position - units_.origin.y()) * per_length_; }
    [[nodiscard]] double velocity(double value) const { return value * per_velocity_; }
    [[nodiscard]] double volume(double value) const { return value * per_volume_; }
    [[nodiscard]] double pressure(double value) const { return value * per_pressure_; }

    static Row<Real> row(std::convertible_to<double> auto... values) { return {{Real(values)...}}; }

    [[nodiscard]] Vector continuity_velocity(const DummyParticles& dummies, std::size_t d) const {
        if (wall_continuity_ == WallContinuity::wall_velocity) {
            return {dummies.solid_velocity_x[d], dummies.solid_velocity_y[d]};
        }
        if (wall_continuity_ == WallContinuity::extrapolated) {
            return {dummies.velocity_x[d], dummies.velocity_y[d]};
        }
        const Vector own(dummies.solid_velocity_x[d], dummies.solid_velocity_y[d]);
        const Vector along(dummies.normal_y[d], -dummies.normal_x[d]);
        const double slip = along.dot(Vector(dummies.velocity_x[d], dummies.velocity_y[d]) - own);
        // Less of it where the boundary layer is thinner than the dummy is deep, and says nothing about it,
        // or a film between two solids is.
        const double reynolds = slip * dummies.depth[d] / kinematic_viscosity_;
        const double known = known_velocity(dummies.fluid_share[d]) / (1 + reynolds * reynolds);
        return own + known * (slip * along + dummies.normal_velocity[d] * left_of(along));
    }

    // Of a rigid body at one of its particles, m/s2.
    static Vector solid_acceleration(const Particles& particles, std::size_t d) {
        const DummyParticles& dummies = particles.dummies;
        const Disc& disc = particles.discs[dummies.disc(d)];
        const Vector arm =
            (disc.radius - dummies.depth[d]) * Vector(dummies.normal_x[d], dummies.normal_y[d]);
        return disc.acceleration() + disc.angular_acceleration() * left_of(arm) - disc.spin * disc.spin * arm;
    }

    template <class FluidRow> void fill_fluid(const Particles& particles, FluidRow&& fluid_row) {
        rows_.resize(periodic_.row_count());
        fill_rows(0, particles.fluid.size(), periodic_.fluid_copies(), fluid_row);
        // Beyond every kernel; the ones keep quotients of volumes finite.
        constexpr double far = 1e6;
        rows_.back() = row(far, far, 0, 0, 1, 1, 1, 0);
    }

    template <class DummyRow> void fill_dummies(const Particles& particles, DummyRow&& dummy_row) {
        fill_rows(particles.fluid.size(), particles.dummies.size(), periodic_.dummy_copies(), dummy_row);
    }

    // `count` rows from `first` on, then their copies.
    template <class MakeRow>
    void fill_rows(std::size_t first, std::size_t count, std::span<const PeriodicRows::Copy> copies,
                   MakeRow&& make_row) {
        const auto row_count = static_cast<std::ptrdiff_t>(count);
        const auto copy_count = static_cast<std::ptrdiff_t>(copies.size());
        Row<Real>* const to = rows_.data() + first;
        Row<Real>* const to_copies = rows_.data() + periodic_.row_of(copies);
#pragma omp parallel
        {
#pragma omp for schedule(static)
            for (std::ptrdiff_t k = 0; k < row_count; ++k) {
                to[k] = make_row(static_cast<std::size_t>(k));
            }
#pragma omp for schedule(static)
            for (std::ptrdiff_t k = 0; k < copy_count; ++k) {
                const PeriodicRows::Copy& of = copies[static_cast<std::size_t>(k)];
                to_copies[k] = rows_[of.source];
                to_copies[k].field[0] += static_cast<Real>(of.shift.x() * per_length_);
                to_copies[k].field[1] += static_cast<Real>(of.shift.y() * per_length_);
            }
        }
    }

    Units units_;
    WallContinuity wall_continuity_;
    ParticleVolume particle_volume_;
    double reference_density_;   // kg/m3
    double kinematic_viscosity_; // m2/s
    const PeriodicRows& periodic_;
    double per_length_ = 1 / units_.length;
    double per_velocity_ = 1 / units_.velocity;
    double per_volume_ = 1 / units_.volume();
    double per_pressure_ = 1 / units_.pressure();
    std::vector<Row<Real>> rows_;
};

} // namespace slurry
