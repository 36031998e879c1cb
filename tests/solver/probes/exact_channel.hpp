#pragma once
// An exact flow between a rough pad y = h(x) and a flat wafer y = top, with the rough channel's length
// scales, and disordered particles in it.
#include "solver/geometry/wall.hpp"
#include "solver/probes/particle_finder.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace slurry::test {

struct Particles {
    std::vector<double> x, y, velocity_x, velocity_y, pressure;

    [[nodiscard]] FluidView view() const { return {x, y, velocity_x, velocity_y, pressure}; }
};

// The stream function psi(x, y) = top_speed F^2/(2 H) + (6 flux/H - 3 top_speed) (F^2/(2 H) - F^3/(3 H^2)),
// with F = y - h(x) and H = top - h(x), has a parabola and a shear as u, no slip on pad (at rest) and wafer,
// and no divergence. It is a lubrication flow; that it solves no momentum equation is of no concern to a
// probe.
class ExactChannel {
  public:
    static constexpr double top = 1.5e-5;
    static constexpr double top_speed = 1;
    static constexpr double flux =
        3.85; // of a wafer over the cosine pad without mean pressure gradient, in 1e-6 m2/s

    // One period is `period` (m) long; a Gaussian must have come down to its base at both ends.
    ExactChannel(Shape pad, double period);

    [[nodiscard]] double length() const { return length_; }
    [[nodiscard]] Domain domain() const { return {Vector(0, 0), Vector(length_, top), {true, false}}; }
    [[nodiscard]] WallScene pad() const { return {"pad", pad_, FluidSide::above, Vector::Zero()}; }
    [[nodiscard]] WallScene wafer() const {
        return {"wafer", LineShape{{0, top}, {length_, top}}, FluidSide::below, Vector(top_speed, 0)};
    }

    [[nodiscard]] double height(double x) const { return height_(x); }
    [[nodiscard]] Vector velocity(const Vector& point) const;
    [[nodiscard]] double pressure(const Vector& point) const;
    // Traction of the wall on the fluid along the tangent with tangent.x > 0, per dynamic viscosity, 1/s.
    [[nodiscard]] double pad_shear_rate(double x) const;
    [[nodiscard]] double wafer_shear_rate(double x) const;

    // Cell centres displaced by up to jitter spacings along either axis, cut by both walls.
    [[nodiscard]] Particles sample(double spacing, double jitter, std::uint32_t seed = 1) const;

  private:
    Shape pad_;
    double length_;
    std::function<double(double)> height_, slope_;
};

inline ExactChannel::ExactChannel(Shape pad, double period) : pad_(std::move(pad)), length_(period) {
    if (const auto* cosine = std::get_if<CosineShape>(&pad_)) {
        const double wave_number = 2 * std::numbers::pi / cosine->wavelength;
        height_ = [c = *cosine, wave_number](double x) {
            return c.mean_height + c.amplitude * std::cos(wave_number * (x - c.crest));
        };
        slope_ = [c = *cosine, wave_number](double x) {
            return -wave_number * c.amplitude * std::sin(wave_number * (x - c.crest));
        };
    } else {
        const auto& bump = std::get<GaussianShape>(pad_);
        const auto rise = [bump](double x) {
            return bump.amplitude * std::exp(-std::pow((x - bump.centre) / bump.width, 2) / 2);
        };
        height_ = [bump, rise](double x) { return bump.base_height + rise(x); };
        slope_ = [bump, rise](double x) { return -rise(x) * (x - bump.centre) / (bump.width * bump.width); };
    }
}

inline Vector ExactChannel::velocity(const Vector& point) const {
    const double gap = top - height_(point.x());
    const double slope = slope_(point.x());
    const double part = (point.y() - height_(point.x())) / gap;
    const double bulge = 6 * flux * 1e-6 / gap - 3 * top_speed;
    const double bulge_slope = 6 * flux * 1e-6 / (gap * gap) * slope;
    const double part_slope = slope * (part - 1) / gap; // d(part)/dx
    const double u = top_speed * part + bulge * part * (1 - part);
    // psi = gap (top_speed part^2 / 2 + bulge (part^2 / 2 - part^3 / 3)), and d(gap)/dx = -slope.
    const double share = part * part / 2 - part * part * part / 3;
    const double psi_slope =
        -slope * (top_speed * part * part / 2 + bulge * share) + gap * (u * part_slope + bulge_slope * share);
    return {u, -psi_slope};
}

inline double ExactChannel::pressure(const Vector& point) const {
    const double wave_number = 2 * std::numbers::pi / length_;
    const double y = point.y() - top / 2;
    return 100 * std::cos(2 * wave_number * point.x()) * std::cosh(2 * wave_number * y) +
           50 * std::sin(wave_number * point.x()) * std::cosh(wave_number * y);
}

inline double ExactChannel::pad_shear_rate(double x) const {
    const double gap = top - height_(x);
    const double bulge = 6 * flux * 1e-6 / gap - 3 * top_speed;
    return -(top_speed + bulge) / gap * (1 + slope_(x) * slope_(x)); // dv_t/dn = |grad F|^2 du/dy
}

inline double ExactChannel::wafer_shear_rate(double x) const {
    const double gap = top - height_(x);
    const double bulge = 6 * flux * 1e-6 / gap - 3 * top_speed;
    return (top_speed - bulge) / gap; // dn = -dy
}

inline Particles ExactChannel::sample(double spacing, double jitter, std::uint32_t seed) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    const auto columns = std::lround(length_ / spacing);
    const auto rows = std::lround(top / spacing);
    Particles particles;
    for (long row = 0; row < rows; ++row) {
        for (long column = 0; column < columns; ++column) {
            double x = (static_cast<double>(column) + 0.5 + shift(generator)) * spacing;
            x -= length_ * std::floor(x / length_);
            const double y = (static_cast<double>(row) + 0.5 + shift(generator)) * spacing;
            const Vector point(x, y);
            if (y <= height_(x) || y >= top) {
                continue;
            }
            particles.x.push_back(x);
            particles.y.push_back(y);
            particles.velocity_x.push_back(velocity(point).x());
            particles.velocity_y.push_back(velocity(point).y());
            particles.pressure.push_back(pressure(point));
        }
    }
    return particles;
}

} // namespace slurry::test
