#include "solver/probes/wall_probe.hpp"

#include "solver/probes/local_fit.hpp"

#include <limits>

namespace slurry {

namespace {

// The compromise of truncation error and noise, from wall_probe_test.cpp with other constants: L2 errors in %
// along the rough channel's pad at 0.25 um, of exact values at jittered particles, then of the same with 1 %
// of white noise (of the rms pressure, of the wafer's speed):
//   degree, width, radius    pressure  shear    noisy pressure  noisy shear
//   2, 1.5, 3.5              0.12      0.69     0.91            14
//   2, 2.5, 5                0.34      1.60     0.57             6
//   3, 1.5, 3.5              0.04      0.04     1.26            33
//   3, 2, 5                  0.04      0.09     0.94            18
//   3, 2.5, 5                0.07      0.14     0.84            14
//   3, 3, 6.5                0.14      0.25     0.65             9
// At equal noise the cubic's truncation error is a fifth of the parabola's. The pressure gets the wider
// weight, since particles carry more noise in it. The parabola remains for gaps of too few particles to
// determine a cubic.
constexpr double pressure_width = 2.5; // particle spacings
constexpr double shear_width = 2;      // particle spacings
constexpr double search_radius = 5;    // particle spacings
constexpr int degree = 3;
constexpr int degree_in_narrow_gaps = 2;

using StencilFunction = std::optional<Stencil> (*)(const LocalSamples&, int, double);

double fitted(StencilFunction stencil_of, const LocalSamples& samples, double weight_width,
              const Eigen::VectorXd& values) {
    for (const int tried : {degree, degree_in_narrow_gaps}) {
        if (const auto stencil = stencil_of(samples, tried, weight_width)) {
            return stencil->dot(values);
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

struct WallPointValues {
    double pressure;
    double shear_rate; // 1/s, d(tangential velocity)/d(normal)
};

WallPointValues probe_wall_point(const ParticleFinder& particles, const Wall& wall, const WallPoint& point,
                                 double time) {
    const double spacing = particles.particle_spacing();
    const FluidView& fluid = particles.fluid();
    const auto near = particles.near(point.position + wall.displacement(time), search_radius * spacing);

    const auto count = static_cast<Eigen::Index>(near.size());
    LocalSamples samples(count);
    Eigen::VectorXd pressure(count);
    Eigen::VectorXd slip(count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const auto& [index, offset] = near[static_cast<std::size_t>(k)];
        // Seen from the wall, which stands where it stood at time 0.
        const NearestPoint foot = wall.nearest(point.position + offset);
        samples.along[k] = offset.dot(point.tangent) / spacing;
        samples.across[k] = foot.distance / spacing;
        samples.distance[k] = offset.norm() / spacing;
        pressure[k] = fluid.pressure[index];
        slip[k] =
            (Vector(fluid.velocity_x[index], fluid.velocity_y[index]) - wall.velocity()).dot(foot.tangent);
    }
    return {fitted(value_stencil, samples, pressure_width, pressure),
            fitted(slope_stencil, samples, shear_width, slip) / spacing};
}

} // namespace

// Why the shear is -eta d(v_t)/dn on a curved wall too. Along a wall that translates, the velocity is
// constant, so on it grad v = a n^T with a = dv/dn, and n (into the fluid) the only direction in which v
// changes. The traction of the wall on the fluid, whose outward normal is -n, is -eta (a n^T + n a^T) n + p
// n; its part along t is -eta a.t. The curvature enters only where v along the wall changes: a wall that
// turns, or one that slips. Nor does it matter that t is taken at each particle's own foot: t changes along
// the wall only, and v - v_wall vanishes there.
WallValues probe_wall(const ParticleFinder& particles, const Wall& wall, std::span<const WallPoint> points,
                      double time, double dynamic_viscosity) {
    WallValues values;
    values.pressure.reserve(points.size());
    values.shear.reserve(points.size());
    for (const WallPoint& point : points) {
        const auto [pressure, shear_rate] = probe_wall_point(particles, wall, point, time);
        values.pressure.push_back(pressure);
        values.shear.push_back(-dynamic_viscosity * shear_rate);
    }
    return values;
}

} // namespace slurry
