#include "solver/time/watchdog.hpp"

#include <fmt/format.h>

#include <cmath>

namespace slurry {

namespace {

[[noreturn]] void stop(const Particles& particles, std::size_t i, long step, const std::string& fault,
                       const char* advice) {
    const FluidParticles& fluid = particles.fluid;
    throw RunError(fmt::format("step {}, time {:.6g} s, particle {} at ({:.6g}, {:.6g}) m: {}; {}", step,
                               particles.time, fluid.identity[i], fluid.x[i], fluid.y[i], fault, advice));
}

} // namespace

void check_particles(const Particles& particles, const Region& region, double reference_density,
                     double particle_spacing, long step) {
    constexpr double largest_density_error = 0.1;
    const FluidParticles& fluid = particles.fluid;
    const auto count = static_cast<std::ptrdiff_t>(fluid.size());
    std::ptrdiff_t leaked = count;
#pragma omp parallel for schedule(static) reduction(min : leaked)
    for (std::ptrdiff_t signed_i = 0; signed_i < count; ++signed_i) {
        const auto i = static_cast<std::size_t>(signed_i);
        const Vector position(fluid.x[i], fluid.y[i]);
        if (position.allFinite() && region.distance(position, particles.time) < -0.5 * particle_spacing) {
            leaked = std::min(leaked, signed_i);
        }
    }
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double sum =
            fluid.x[i] + fluid.y[i] + fluid.velocity_x[i] + fluid.velocity_y[i] + fluid.density[i];
        if (!std::isfinite(sum)) {
            stop(particles, i, step, "its state is not a finite number",
                 "reduce numerics.acoustic_cfl, or check walls and start for particles that coincide");
        }
        if (std::abs(fluid.density[i] / reference_density - 1) > largest_density_error) {
            stop(particles, i, step,
                 fmt::format("its density is {:.6g} kg/m3, more than 10 % off", fluid.density[i]),
                 "raise numerics.sound_speed to 10 times the top speed or reduce numerics.acoustic_cfl");
        }
    }
    if (leaked < count) {
        stop(particles, static_cast<std::size_t>(leaked), step, "it is behind a wall",
             "reduce numerics.particle_spacing or numerics.acoustic_cfl");
    }
}

} // namespace slurry
