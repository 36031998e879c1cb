#include "solver/probes/point_probe.hpp"

#include "solver/discs/clearance.hpp"
#include "solver/probes/local_fit.hpp"

#include <limits>

namespace slurry {

namespace {

// Narrower than the wall probe's: with particles all around, a parabola is as good as a cubic, and noise is
// averaged rather than extrapolated.
constexpr double weight_width = 1.5;        // particle spacings
constexpr double point_search_radius = 3.5; // particle spacings
constexpr int point_degree = 2;

} // namespace

PointValues probe_point(const ParticleFinder& particles, const Region& region, const Vector& position,
                        double time, std::span<const Disc> discs) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    if (!(region.distance(position, time) > 0 && clearance(discs, region.domain(), position) > 0)) {
        return {nothing, nothing, nothing};
    }
    const double spacing = particles.particle_spacing();
    const auto near = particles.near(position, point_search_radius * spacing);
    LocalSamples samples(static_cast<Eigen::Index>(near.size()));
    for (Eigen::Index k = 0; k < samples.along.size(); ++k) {
        const Vector offset = near[static_cast<std::size_t>(k)].offset / spacing;
        samples.along[k] = offset.x();
        samples.across[k] = offset.y();
        samples.distance[k] = offset.norm();
    }
    const auto stencil = value_stencil(samples, point_degree, weight_width);
    if (!stencil) {
        return {nothing, nothing, nothing};
    }
    PointValues values{0, 0, 0};
    for (std::size_t k = 0; k < near.size(); ++k) {
        const double share = (*stencil)[static_cast<Eigen::Index>(k)];
        values.pressure += share * particles.fluid().pressure[near[k].index];
        values.velocity_x += share * particles.fluid().velocity_x[near[k].index];
        values.velocity_y += share * particles.fluid().velocity_y[near[k].index];
    }
    return values;
}

} // namespace slurry
