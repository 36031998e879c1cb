#include "solver/discs/disc_dummies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slurry {

namespace {

void append_ring(std::vector<DiscPoint>& points, double outer, double inner, double particle_spacing) {
    constexpr double turn = 2 * std::numbers::pi;
    const double radius = (outer + inner) / 2;
    const double area = std::numbers::pi * (outer * outer - inner * inner);
    const double count = std::max(1.0, std::round(area / (particle_spacing * particle_spacing)));
    for (int k = 0; k < static_cast<int>(count); ++k) {
        const double angle = turn * k / count;
        points.push_back(
            {count > 1 ? Vector(radius * Vector(std::cos(angle), std::sin(angle))) : Vector(Vector::Zero()),
             area / count});
    }
}

std::vector<DiscPoint> on_rings(double radius, double particle_spacing, int layers) {
    std::vector<DiscPoint> points;
    for (int layer = 0; layer < layers && radius - layer * particle_spacing > 0; ++layer) {
        const double outer = radius - layer * particle_spacing;
        // A rest of less than half a spacing at the centre belongs to the last ring.
        const double inner = outer < 1.5 * particle_spacing ? 0 : outer - particle_spacing;
        append_ring(points, outer, inner, particle_spacing);
        if (inner == 0) {
            break;
        }
    }
    return points;
}

// All that are in the disc.
std::vector<DiscPoint> on_a_lattice(double radius, double particle_spacing) {
    std::vector<DiscPoint> points;
    const int half = static_cast<int>(std::ceil(radius / particle_spacing));
    for (int row = -half; row < half; ++row) {
        for (int column = -half; column < half; ++column) {
            const Vector position = particle_spacing * Vector(column + 0.5, row + 0.5);
            if (position.norm() < radius) {
                points.push_back({position, particle_spacing * particle_spacing});
            }
        }
    }
    return points;
}

bool fills(const std::vector<DiscPoint>& lattice, double radius, double particle_spacing) {
    constexpr double tolerance = 0.1;
    const double area = static_cast<double>(lattice.size()) * particle_spacing * particle_spacing;
    return std::abs(area / (std::numbers::pi * radius * radius) - 1) <= tolerance;
}

} // namespace

std::vector<DiscPoint> disc_points(double radius, DiscDummies arrangement, double particle_spacing,
                                   int layers) {
    if (arrangement != DiscDummies::rings) {
        std::vector<DiscPoint> points = on_a_lattice(radius, particle_spacing);
        if (arrangement == DiscDummies::lattice || fills(points, radius, particle_spacing)) {
            std::erase_if(points, [&](const DiscPoint& point) {
                return radius - point.position.norm() >= layers * particle_spacing;
            });
            return points;
        }
    }
    return on_rings(radius, particle_spacing, layers);
}

void append_disc_dummies(Particles& particles, DiscDummies arrangement, double particle_spacing, int layers) {
    DummyParticles& dummies = particles.dummies;
    dummies.first_of_discs = dummies.size();
    for (std::size_t k = 0; k < particles.discs.size(); ++k) {
        const double radius = particles.discs[k].radius;
        const auto points = disc_points(radius, arrangement, particle_spacing, layers);
        std::size_t d = dummies.size();
        dummies.resize(d + points.size());
        for (const DiscPoint& point : points) {
            const double distance = point.position.norm();
            const Vector normal = distance > 0 ? Vector(point.position / distance) : Vector(1, 0);
            dummies.start_normal_x[d] = normal.x();
            dummies.start_normal_y[d] = normal.y();
            dummies.depth[d] = radius - distance;
            dummies.curvature[d] = -1 / radius;
            dummies.volume[d] = point.volume;
            dummies.wall[d] = static_cast<int>(dummies.wall_drift.size() + k);
            ++d;
        }
    }
    move_disc_dummies(particles);
}

void move_disc_dummies(Particles& particles) {
    DummyParticles& dummies = particles.dummies;
    for (std::size_t d = dummies.first_of_discs; d < dummies.size(); ++d) {
        const Disc& disc = particles.discs[dummies.disc(d)];
        const double cosine = std::cos(disc.angle);
        const double sine = std::sin(disc.angle);
        dummies.normal_x[d] = cosine * dummies.start_normal_x[d] - sine * dummies.start_normal_y[d];
        dummies.normal_y[d] = sine * dummies.start_normal_x[d] + cosine * dummies.start_normal_y[d];
        const double distance = disc.radius - dummies.depth[d];
        const Vector arm = distance * Vector(dummies.normal_x[d], dummies.normal_y[d]);
        dummies.x[d] = dummies.start_x[d] + disc.position.x() + arm.x();
        dummies.y[d] = dummies.start_y[d] + disc.position.y() + arm.y();
        dummies.solid_velocity_x[d] = disc.velocity.x() - disc.spin * arm.y();
        dummies.solid_velocity_y[d] = disc.velocity.y() + disc.spin * arm.x();
    }
}

} // namespace slurry
