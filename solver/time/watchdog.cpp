#include "solver/time/watchdog.hpp"

#include "solver/discs/crowd.hpp"
#include "solver/discs/nearest_image.hpp"
#include "solver/time/density_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace slurry {

namespace {

[[noreturn]] void stop(const Particles& particles, std::size_t i, long step, const std::string& fault,
                       const std::string& advice) {
    const FluidParticles& fluid = particles.fluid;
    throw RunError(fmt::format("step {}, time {:.6g} s, particle {} at ({:.6g}, {:.6g}) m: {}; {}", step,
                               particles.time, fluid.identity[i], fluid.x[i], fluid.y[i], fault, advice));
}

// The first fluid particle for which `bad` says so; the fluid's size if there is none.
template <class Bad> std::size_t first_where(const FluidParticles& fluid, Bad&& bad) {
    const auto count = static_cast<std::ptrdiff_t>(fluid.size());
    std::ptrdiff_t first = count;
#pragma omp parallel for schedule(static) reduction(min : first)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        if (bad(static_cast<std::size_t>(i))) {
            first = std::min(first, i);
        }
    }
    return static_cast<std::size_t>(first);
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
        double clear = -1; // as far from the centre nothing is deeper behind a wall than it may be
        for (std::ptrdiff_t signed_i = first; signed_i < std::min(first + chunk, count); ++signed_i) {
            const auto i = static_cast<std::size_t>(signed_i);
            const Vector position(fluid.x[i], fluid.y[i]);
            if ((position - centre).norm() < clear || !position.allFinite()) {
                continue;
            }
            centre = position;
            clear = region.distance(position, time) + tolerance;
            if (clear < 0) {
                leaked = std::min(leaked, signed_i);
            }
        }
    }
    return static_cast<std::size_t>(leaked);
}

// The discs, to be asked whether a point is more than `tolerance` behind a rim.
Crowd crowd_of(const std::vector<Disc>& discs, const Domain& domain, double tolerance) {
    double largest_radius = 0;
    for (const Disc& disc : discs) {
        largest_radius = std::max(largest_radius, disc.radius);
    }
    Crowd crowd(domain, largest_radius, 0);
    for (const Disc& disc : discs) {
        crowd.add({wrapped(disc.position, domain), disc.radius, -tolerance});
    }
    return crowd;
}

// Where a fluid particle is in a disc, deeper than `tolerance`; the fluid's size if there is none.
std::size_t first_in_disc(const Particles& particles, const Domain& domain, double tolerance) {
    const FluidParticles& fluid = particles.fluid;
    if (particles.discs.empty()) {
        return fluid.size();
    }
    const Crowd crowd = crowd_of(particles.discs, domain, tolerance);
    return first_where(fluid, [&](std::size_t i) {
        return crowd.too_near({{fluid.x[i], fluid.y[i]}, 0, -tolerance}).has_value();
    });
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

bool is_finite(const FluidParticles& fluid, std::size_t i) {
    return std::isfinite(fluid.x[i] + fluid.y[i] + fluid.velocity_x[i] + fluid.velocity_y[i] +
                         fluid.density[i]);
}

void check_fluid(const Particles& particles, const Region& region, const Scene& scene, long step) {
    constexpr double largest_density_error = 0.1;
    const FluidParticles& fluid = particles.fluid;
    const std::size_t i = first_where(fluid, [&](std::size_t k) {
        return !is_finite(fluid, k) ||
               std::abs(fluid.density[k] / scene.fluid.density - 1) > largest_density_error;
    });
    if (i == fluid.size()) {
        return;
    }
    if (!is_finite(fluid, i)) {
        stop(particles, i, step, "its state is not a finite number",
             "reduce numerics.acoustic_cfl, or check walls and start for particles that coincide");
    }
    stop_for_density(particles, region, scene, i, step);
}

void check_states(const Particles& particles, const Region& region, const Scene& scene, long step) {
    check_fluid(particles, region, scene, step);
    check_discs(particles, step);
}

} // namespace

void check_particles(const Particles& particles, const Region& region, const Scene& scene, long step) {
    check_states(particles, region, scene, step);
    const FluidParticles& fluid = particles.fluid;
    const double tolerance = 0.5 * scene.numerics.particle_spacing;
    const std::string advice = "reduce numerics.particle_spacing or numerics.acoustic_cfl";
    const std::size_t swallowed = first_in_disc(particles, region.domain(), tolerance);
    if (swallowed < fluid.size()) {
        stop(particles, swallowed, step, "it is in a disc", advice);
    }
    const std::size_t leaked = first_leak(fluid, region, particles.time, tolerance);
    if (leaked < fluid.size()) {
        stop(particles, leaked, step, "it is behind a wall", advice);
    }
}

// All of it takes up to half a step, states a fiftieth of one. `make counts` holds the share in a run below
// 0.5 % and finds this function by its name: it must not vanish into another.
[[gnu::noinline]] void watch(const Particles& particles, const Region& region, const Scene& scene, long step,
                             long steps) {
    constexpr long steps_between_places = 200;
    constexpr long steps_between_states = 20;
    if (step % steps_between_places == 0 || step == steps) {
        check_particles(particles, region, scene, step);
    } else if (step % steps_between_states == 0 || std::has_single_bit(static_cast<unsigned long>(step))) {
        check_states(particles, region, scene, step);
    }
}

} // namespace slurry
