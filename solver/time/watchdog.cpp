#include "solver/time/watchdog.hpp"

#include "solver/discs/clearance.hpp"
#include "solver/time/density_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slurry {

namespace {

[[noreturn]] void stop(const Particles& particles, std::size_t i, long step, const std::string& fault,
                       const std::string& advice) {
    const FluidParticles& fluid = particles.fluid;
    throw RunError(fmt::format("step {}, time {:.6g} s, particle {} at ({:.6g}, {:.6g}) m: {}; {}", step,
                               particles.time, fluid.identity[i], fluid.x[i], fluid.y[i], fault, advice));
}

// The first particle more than `tolerance` behind a wall; the fluid's size if there is none. A distance
// holds, less the way to them, for the particles around, and those next in memory are near: most need no
// search of their own.
std::size_t first_leak(const FluidParticles& fluid, const Region& region, double time, double tolerance) {
    constexpr std::ptrdiff_t chunk = 512;
    const auto count = static_cast<std::ptrdiff_t>(fluid.size());
    std::ptrdiff_t leaked = count;
#pragma omp parallel for schedule(static) reduction(min : leaked)
    for (std::ptrdiff_t first = 0; first < count; first += chunk) {
        Vector centre = Vector::Zero();
        double clear = -1; // no wall is nearer to the centre
        for (std::ptrdiff_t signed_i = first; signed_i < std::min(first + chunk, count); ++signed_i) {
            const auto i = static_cast<std::size_t>(signed_i);
            const Vector position(fluid.x[i], fluid.y[i]);
            if ((position - centre).norm() < clear || !position.allFinite()) {
                continue;
            }
            centre = position;
            clear = region.distance(position, time);
            if (clear < -tolerance) {
                leaked = std::min(leaked, signed_i);
            }
        }
    }
    return static_cast<std::size_t>(leaked);
}

// Where a fluid particle is in a disc, deeper than `tolerance`; the fluid's size if there is none.
std::size_t first_in_disc(const Particles& particles, const Domain& domain, double tolerance) {
    const FluidParticles& fluid = particles.fluid;
    std::size_t first = fluid.size();
    for (std::size_t i = 0; i < first && !particles.discs.empty(); ++i) {
        if (clearance(particles.discs, domain, {fluid.x[i], fluid.y[i]}) < -tolerance) {
            first = i;
        }
    }
    return first;
}

double fastest(const FluidParticles& fluid) {
    double speed = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        speed = std::max(speed, std::hypot(fluid.velocity_x[i], fluid.velocity_y[i]));
    }
    return speed;
}

[[noreturn]] void stop_for_density(const Particles& particles, const Region& region, const Scene& scene,
                                   std::size_t i, long step) {
    const FluidParticles& fluid = particles.fluid;
    const DensityFault fault{particles.time, fastest(fluid),
                             gap_around(particles, region, {fluid.x[i], fluid.y[i]}),
                             start_jump(scene, region)};
    stop(particles, i, step, fmt::format("its density is {:.6g} kg/m3, more than 10 % off", fluid.density[i]),
         density_advice(scene, fault));
}

void check_discs(const Particles& particles, long step) {
    for (const Disc& disc : particles.discs) {
        if (!disc.position.allFinite() || !disc.velocity.allFinite() || !std::isfinite(disc.spin)) {
            throw RunError(
                fmt::format("step {}, time {:.6g} s, disc '{}': its state is not a finite number; reduce "
                            "numerics.acoustic_cfl",
                            step, particles.time, disc.name));
        }
    }
}

} // namespace

void check_particles(const Particles& particles, const Region& region, const Scene& scene, long step) {
    constexpr double largest_density_error = 0.1;
    const double particle_spacing = scene.numerics.particle_spacing;
    const FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double sum =
            fluid.x[i] + fluid.y[i] + fluid.velocity_x[i] + fluid.velocity_y[i] + fluid.density[i];
        if (!std::isfinite(sum)) {
            stop(particles, i, step, "its state is not a finite number",
                 "reduce numerics.acoustic_cfl, or check walls and start for particles that coincide");
        }
        if (std::abs(fluid.density[i] / scene.fluid.density - 1) > largest_density_error) {
            stop_for_density(particles, region, scene, i, step);
        }
    }
    check_discs(particles, step);
    const std::size_t swallowed = first_in_disc(particles, region.domain(), 0.5 * particle_spacing);
    if (swallowed < fluid.size()) {
        stop(particles, swallowed, step, "it is in a disc",
             "reduce numerics.particle_spacing or numerics.acoustic_cfl");
    }
    const std::size_t leaked = first_leak(fluid, region, particles.time, 0.5 * particle_spacing);
    if (leaked < fluid.size()) {
        stop(particles, leaked, step, "it is behind a wall",
             "reduce numerics.particle_spacing or numerics.acoustic_cfl");
    }
}

} // namespace slurry
