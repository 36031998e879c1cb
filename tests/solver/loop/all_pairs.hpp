#pragma once
// Eqs. 2.14 to 2.22 as they are written, and the wall fits as least squares, particle by particle over all
// particles and all their periodic images: no neighbour lists, no fused sums, no vectors. What the pair loops
// are held against.
#include "solver/loop/pass_rows.hpp"
#include "solver/particles/particles.hpp"
#include "solver/scene/scene.hpp"
#include "solver/terms/selection.hpp"
#include "solver/terms/wall_fit.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>
#include <numbers>
#include <vector>

namespace slurry::testing {

class AllPairs {
  public:
    AllPairs(const Scene& scene, Particles& particles)
        : scene_(scene), fluid_(particles.fluid), dummies_(particles.dummies), discs_(particles.discs),
          h_(scene.numerics.smoothing_length()) {
        find_pairs();
        for (std::size_t i = 0; i < fluid_.size(); ++i) {
            shift_.emplace_back(fluid_.shift_x(i), fluid_.shift_y(i));
        }
    }

    // Every pass of a time step, into the particles.
    void evaluate() {
        compute_volumes();
        if (scene_.numerics.wall_extrapolation == WallExtrapolation::fit) {
            fit_to_walls();
        } else {
            extrapolate_to_walls();
        }
        compute_density_rate();
        compute_forces();
    }

  private:
    void compute_volumes() { // of any kind
        fluid_.number_density_volume.resize(fluid_.size());
        for (std::size_t i = 0; i < fluid_.size(); ++i) {
            double sum = kernel(0);
            visit(i, [&](std::size_t j, const Vector& r) {
                sum += kernel(r.norm()) *
                       (is_fluid(j) ? 1 : volume(j) / std::pow(scene_.numerics.particle_spacing, 2));
            });
            const bool constant = scene_.numerics.particle_volume == ParticleVolume::constant;
            const double density = constant ? scene_.fluid.density : fluid_.density[i];
            fluid_.number_density_volume[i] =
                scene_.numerics.particle_volume == ParticleVolume::number_density ? 1 / sum
                                                                                  : fluid_.mass / density;
        }
    }

    // Eqs. 2.16 and 2.17
    void extrapolate_to_walls() {
        for (std::size_t d = 0; d < dummies_.size(); ++d) {
            double weight = 0;
            double pressure = 0;
            Vector velocity = Vector::Zero();
            Vector lever = Vector::Zero();
            visit(fluid_.size() + d, [&](std::size_t f, const Vector& r) {
                if (is_fluid(f)) {
                    const double w = kernel(r.norm());
                    weight += w;
                    velocity += velocity_of(f) * w;
                    pressure += fluid_.pressure[f] * w;
                    lever += fluid_.mass / fluid_.number_density_volume[f] * w * r;
                }
            });
            const double inverse = weight > 0 ? 1 / weight : 0;
            const Vector reflected = 2 * wall_velocity(d) - velocity * inverse;
            dummies_.velocity_x[d] = reflected.x();
            dummies_.velocity_y[d] = reflected.y();
            dummies_.pressure[d] =
                (pressure + (scene_.fluid.body_force - spin_acceleration(d)).dot(lever)) * inverse;
        }
    }

    // The fits of solver/terms/wall_fit.hpp, lengths in smoothing lengths. Functions that the particles in
    // reach cannot tell from those before them are left out.
    void fit_to_walls() {
        for (std::size_t d = 0; d < dummies_.size(); ++d) {
            const std::vector<Seen> fluid = fluid_seen_from(d);
            const auto count = static_cast<Eigen::Index>(fluid.size());
            Eigen::MatrixXd no_slip(count, 3);
            Eigen::MatrixXd linear(count, 3);
            Eigen::MatrixXd velocity(count, 2);
            Eigen::MatrixXd pressure(count, 1);
            for (Eigen::Index k = 0; k < count; ++k) {
                const auto& [f, s, n, weight] = fluid[static_cast<std::size_t>(k)];
                const double root = std::sqrt(weight);
                no_slip.row(k) = root * Eigen::RowVector3d(n, n * n, n * s);
                linear.row(k) = root * Eigen::RowVector3d(1, s, n);
                velocity.row(k) = root * (velocity_of(f) - rigid_velocity(d, s, n)).transpose();
                pressure(k, 0) = root * fluid_.pressure[f];
            }
            double moment = 0;
            for (const auto& near : fluid) {
                moment += near.weight * near.n;
            }
            dummies_.fluid_share[d] = moment * fluid_.mass / (scene_.fluid.density * h_ * h_) /
                                      (16 * std::pow(wall_fit_support, 3) / 105);
            const double n = -dummies_.depth[d] / h_;
            Eigen::MatrixXd b = least_squares(no_slip, velocity);
            const Eigen::MatrixXd line = least_squares(no_slip.leftCols(1), velocity);
            const double full = moment_before_curve(dummies_.curvature[d] * h_ / 2);
            const double known = known_curvature(dummies_.fluid_share[d] / full);
            b.row(0) = known * b.row(0) + (1 - known) * line;
            b.row(1) *= known;
            const Vector continued = rigid_velocity(d, 0, n) + n * (b.row(0) + n * b.row(1)).transpose();
            const Vector along(dummies_.normal_y[d], -dummies_.normal_x[d]);
            const double curvature = -b.row(2).dot(along); // of v . n, in 1 / h^2
            dummies_.normal_velocity[d] = 0.5 * n * n * curvature;
            const Vector normal(dummies_.normal_x[d], dummies_.normal_y[d]);
            const Eigen::MatrixXd c = least_squares(linear, pressure);
            const Eigen::MatrixXd without_distance = least_squares(
                linear.leftCols(2), (Eigen::MatrixXd(count, 2) << pressure, linear.col(2)).finished());
            const double gradient =
                dummies_.of_disc(d) ? known_gradient(dummies_.fluid_share[d]) * c(2, 0)
                                    : h_ * scene_.fluid.density * scene_.fluid.acceleration().dot(normal) +
                                          scene_.fluid.dynamic_viscosity * curvature / h_;
            dummies_.velocity_x[d] = continued.x();
            dummies_.velocity_y[d] = continued.y();
            dummies_.pressure[d] = without_distance(0, 0) + (n - without_distance(0, 1)) * gradient;
        }
    }

    // Eq. 2.14 with 2.21 and 2.22, and the density diffusion [molteni2009, fourtakas2019]
    void compute_density_rate() {
        const Numerics& numerics = scene_.numerics;
        const Vector density_slope =
            scene_.fluid.density / (numerics.sound_speed * numerics.sound_speed) * scene_.fluid.body_force;
        const std::optional<Vector> frame = select_terms(scene_).pressure_frame;
        const double viscosity = scene_.fluid.kinematic_viscosity();
        const double diffusion =
            viscosity > 0
                ? numerics.density_diffusion * std::min(1.0, numerics.sound_speed * h_ / (2.5 * viscosity))
                : numerics.density_diffusion;
        const double fourth_order = numerics.fourth_order_diffusion_share * lattice_moment_ratio();
        for (std::size_t i = 0; i < fluid_.size(); ++i) {
            const Matrix correction =
                numerics.gradient_correction ? correction_matrix(i) : Matrix::Identity();
            const Vector carried =
                frame ? Vector(velocity_of(i) + advection_shift(i) - *frame) : Vector(0, 0);
            double rate = 0;
            visit(i, [&](std::size_t j, const Vector& r) {
                const double volume_j = is_fluid(j) ? fluid_.mass / fluid_.density[j] : volume(j);
                const Vector gradient = kernel_slope(r.norm()) * r.normalized();
                const Vector velocity = velocity_of(i) - continuity_velocity(j);
                rate += fluid_.density[i] * volume_j * velocity.dot(correction * gradient);
                rate += volume_j * (continuity_density(j) - fluid_.density[i]) * gradient.dot(carried);
                if (is_fluid(j)) {
                    const double difference = fluid_.density[j] - fluid_.density[i] + density_slope.dot(r);
                    const Vector psi = 2 * difference / r.squaredNorm() * -r;
                    rate += diffusion * h_ * numerics.sound_speed * psi.dot(gradient) * volume_j *
                            (1 - fourth_order * r.squaredNorm());
                }
            });
            fluid_.density_rate[i] = rate;
        }
    }

    // sum F r^2 / sum F r^4 over a lattice, F = (dW/dr) / r.
    [[nodiscard]] double lattice_moment_ratio() const {
        double second = 0;
        double fourth = 0;
        for (int column = -6; column <= 6; ++column) {
            for (int row = -6; row <= 6; ++row) {
                const double r = std::hypot(column, row) * scene_.numerics.particle_spacing;
                second += kernel_slope(r) * r;
                fourth += kernel_slope(r) * r * r * r;
            }
        }
        return second / fourth;
    }

    // Eqs. 2.15, 2.19 and 2.20
    void compute_forces() {
        const double ratio = scene_.numerics.background_pressure_ratio;
        const double background = ratio * scene_.fluid.density * std::pow(scene_.numerics.sound_speed, 2);
        const bool tensor = ratio > 0 && scene_.numerics.advection_tensor;
        for (std::size_t i = 0; i < fluid_.size(); ++i) {
            Vector force = Vector::Zero();
            Vector shift = Vector::Zero();
            visit(i, [&](std::size_t j, const Vector& r) {
                const double squares = std::pow(volume(i), 2) + std::pow(volume(j), 2);
                const double slope = kernel_slope(r.norm());
                const Vector gradient = slope * r.normalized();
                const double rho_i = weighting_density(i);
                const double rho_j = weighting_density(j);
                const double mean_pressure = (pressure(i) * rho_j + pressure(j) * rho_i) / (rho_i + rho_j);
                force -= squares * mean_pressure * gradient;
                force += squares * scene_.fluid.dynamic_viscosity * (velocity_of(i) - velocity_of(j)) /
                         r.norm() * slope;
                if (tensor) {
                    force += squares * (advection(i) + advection(j)) / 2 * gradient;
                }
                shift -= squares * background * gradient;
            });
            fluid_.acceleration_x[i] = force.x() / fluid_.mass;
            fluid_.acceleration_y[i] = force.y() / fluid_.mass;
            fluid_.background_x[i] = shift.x() / fluid_.mass;
            fluid_.background_y[i] = shift.y() / fluid_.mass;
        }
    }

    // A fluid particle from the wall point of a dummy: offsets along the wall and from it, and the weight.
    struct Seen {
        std::size_t f;
        double s, n, weight;
    };

    [[nodiscard]] std::vector<Seen> fluid_seen_from(std::size_t d) const {
        const Vector normal(dummies_.normal_x[d], dummies_.normal_y[d]);
        const Vector tangent(normal.y(), -normal.x());
        const Vector wall_point = position(fluid_.size() + d) + dummies_.depth[d] * normal;
        std::vector<Seen> seen;
        for (std::size_t f = 0; f < fluid_.size(); ++f) {
            visit_images([&](const Vector& shift) {
                const Vector offset = (position(f) + shift - wall_point) / h_;
                if (offset.norm() < 3) {
                    const double s = offset.dot(tangent);
                    const double wall_height = dummies_.curvature[d] * h_ * s * s / 2;
                    seen.push_back({f, s, offset.dot(normal) - wall_height,
                                    std::pow(1 - std::pow(offset.norm() / 3, 2), 2)});
                }
            });
        }
        return seen;
    }

    [[nodiscard]] static Eigen::MatrixXd least_squares(const Eigen::MatrixXd& basis,
                                                       const Eigen::MatrixXd& values) {
        std::vector<Eigen::Index> kept;
        Eigen::MatrixXd fitted = Eigen::MatrixXd::Zero(0, values.cols());
        for (Eigen::Index k = 0; k < basis.cols(); ++k) {
            const Eigen::VectorXd column = basis.col(k);
            Eigen::VectorXd rest = column;
            if (!kept.empty()) {
                const Eigen::MatrixXd before = basis(Eigen::all, kept);
                rest -= before * before.colPivHouseholderQr().solve(column);
            }
            if (rest.squaredNorm() > 1e-3 * column.squaredNorm()) {
                kept.push_back(k);
                fitted = basis(Eigen::all, kept).colPivHouseholderQr().solve(values);
            }
        }
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(basis.cols(), values.cols());
        for (std::size_t k = 0; k < kept.size(); ++k) {
            result.row(kept[k]) = fitted.row(static_cast<Eigen::Index>(k));
        }
        return result;
    }

    struct Other {
        std::size_t j;
        Vector r; // r_ij
    };

    void find_pairs() {
        const std::size_t count = fluid_.size() + dummies_.size();
        others_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                visit_images([&](const Vector& shift) {
                    const Vector r = position(i) - position(j) - shift;
                    if (r.norm() < 3 * h_ && (i != j || !shift.isZero())) {
                        others_[i].push_back({j, r});
                    }
                });
            }
        }
    }

    // Calls visit(shift) for the domain itself and its periodic neighbours.
    template <class Visit> void visit_images(Visit&& visit) const {
        const Vector length = scene_.domain.size();
        const int columns = scene_.domain.periodic[0] ? 1 : 0;
        const int rows = scene_.domain.periodic[1] ? 1 : 0;
        for (int column = -columns; column <= columns; ++column) {
            for (int row = -rows; row <= rows; ++row) {
                visit(Vector(column * length.x(), row * length.y()));
            }
        }
    }

    // Calls visit(j, r_ij) for every particle and image in reach of particle i, itself excepted.
    template <class Visit> void visit(std::size_t i, Visit&& visit) const {
        for (const Other& other : others_[i]) {
            visit(other.j, other.r);
        }
    }

    // Eq. 2.4 in two dimensions, and its derivative
    [[nodiscard]] double kernel(double r) const { return branches(r / h_, 5) / (h_ * h_); }
    [[nodiscard]] double kernel_slope(double r) const { return -5 * branches(r / h_, 4) / (h_ * h_ * h_); }
    [[nodiscard]] static double branches(double q, int power) {
        const double lambda = 7 / (478 * std::numbers::pi);
        double sum = q < 3 ? std::pow(3 - q, power) : 0;
        sum -= q < 2 ? 6 * std::pow(2 - q, power) : 0;
        sum += q < 1 ? 15 * std::pow(1 - q, power) : 0;
        return lambda * sum;
    }

    [[nodiscard]] Matrix correction_matrix(std::size_t i) const {
        Matrix moment = Matrix::Zero();
        visit(i, [&](std::size_t j, const Vector& r) {
            const double volume_j = is_fluid(j) ? fluid_.mass / fluid_.density[j] : volume(j);
            moment -= volume_j * kernel_slope(r.norm()) * r.normalized() * r.transpose();
        });
        return moment.inverse();
    }

    [[nodiscard]] bool is_fluid(std::size_t j) const { return j < fluid_.size(); }
    [[nodiscard]] Vector position(std::size_t j) const {
        return pick(j, fluid_.x, fluid_.y, dummies_.x, dummies_.y);
    }
    [[nodiscard]] Vector velocity_of(std::size_t j) const {
        return pick(j, fluid_.velocity_x, fluid_.velocity_y, dummies_.velocity_x, dummies_.velocity_y);
    }
    [[nodiscard]] Vector advection_shift(std::size_t i) const { return shift_[i]; }
    [[nodiscard]] double continuity_density(std::size_t j) const {
        const double c = scene_.numerics.sound_speed;
        return is_fluid(j) ? fluid_.density[j] : scene_.fluid.density + pressure(j) / (c * c);
    }
    [[nodiscard]] Vector wall_velocity(std::size_t d) const {
        return {dummies_.solid_velocity_x[d], dummies_.solid_velocity_y[d]};
    }
    [[nodiscard]] Vector continuity_velocity(std::size_t j) const {
        if (is_fluid(j) || scene_.numerics.wall_continuity == WallContinuity::extrapolated) {
            return velocity_of(j);
        }
        const std::size_t d = j - fluid_.size();
        if (scene_.numerics.wall_continuity == WallContinuity::wall_velocity) {
            return wall_velocity(d);
        }
        const Vector normal(dummies_.normal_x[d], dummies_.normal_y[d]);
        const Vector relative = velocity_of(j) - wall_velocity(d);
        const Vector slip = relative - relative.dot(normal) * normal;
        const double reynolds =
            slip.norm() * dummies_.depth[d] / std::max(scene_.fluid.kinematic_viscosity(), 1e-300);
        return wall_velocity(d) + known_velocity(dummies_.fluid_share[d]) *
                                      (slip + dummies_.normal_velocity[d] * normal) /
                                      (1 + reynolds * reynolds);
    }
    // Of a disc that nothing but its spin accelerates.
    [[nodiscard]] Vector spin_acceleration(std::size_t d) const {
        if (!dummies_.of_disc(d)) {
            return Vector::Zero();
        }
        const Disc& disc = discs_[dummies_.disc(d)];
        return -disc.spin * disc.spin * (disc.radius - dummies_.depth[d]) *
               Vector(dummies_.normal_x[d], dummies_.normal_y[d]);
    }
    // Of the wall or disc of a dummy, at wall coordinates in smoothing lengths.
    [[nodiscard]] Vector rigid_velocity(std::size_t d, double s, double n) const {
        if (!dummies_.of_disc(d)) {
            return wall_velocity(d);
        }
        const Disc& disc = discs_[dummies_.disc(d)];
        const Vector normal(dummies_.normal_x[d], dummies_.normal_y[d]);
        const Vector along(normal.y(), -normal.x());
        const double across = n + dummies_.curvature[d] * h_ * s * s / 2;
        const Vector arm = disc.radius * normal + h_ * (across * normal + s * along);
        return disc.velocity + disc.spin * left_of(arm);
    }
    [[nodiscard]] double weighting_density(std::size_t j) const {
        return scene_.numerics.particle_volume == ParticleVolume::constant ? scene_.fluid.density
                                                                           : fluid_.mass / volume(j);
    }
    [[nodiscard]] double volume(std::size_t j) const {
        return is_fluid(j) ? fluid_.number_density_volume[j] : dummies_.volume[j - fluid_.size()];
    }
    [[nodiscard]] double pressure(std::size_t j) const {
        return is_fluid(j) ? fluid_.pressure[j] : dummies_.pressure[j - fluid_.size()];
    }
    [[nodiscard]] Matrix advection(std::size_t j) const {
        return is_fluid(j) ? Matrix(fluid_.density[j] * velocity_of(j) * shift_[j].transpose())
                           : Matrix(Matrix::Zero());
    }
    [[nodiscard]] Vector pick(std::size_t j, const std::vector<double>& fluid_x,
                              const std::vector<double>& fluid_y, const std::vector<double>& dummy_x,
                              const std::vector<double>& dummy_y) const {
        const std::size_t d = j - fluid_.size();
        return is_fluid(j) ? Vector(fluid_x[j], fluid_y[j]) : Vector(dummy_x[d], dummy_y[d]);
    }

    const Scene& scene_;
    std::vector<Vector> shift_; // of the step before: the forces put a new one in its place
    FluidParticles& fluid_;
    DummyParticles& dummies_;
    const std::vector<Disc>& discs_;
    double h_;
    std::vector<std::vector<Other>> others_; // per particle
};

} // namespace slurry::testing
