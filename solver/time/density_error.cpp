#include "solver/time/density_error.hpp"

#include "solver/discs/nearest_image.hpp"
#include "solver/output/hdf5_reader.hpp"
#include "solver/scene/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slurry {
namespace {

// The equation of state keeps the density within 1 % up to here.
constexpr double largest_speed_share = 0.1; // of the sound speed
// Up to here the fluid's speed is good for 2 % of density, and an error of 5 or 10 % has another cause.
constexpr double telling_speed_share = 1.5 * largest_speed_share;
constexpr double fewest_across_a_gap =
    5; // spacings: they resolve a parabola (verification/stability/thin_gap)

// Of what the scene moves itself, m/s.
double driven_speed(const Scene& scene) {
    double speed = std::abs(scene.start.speed);
    for (const WallScene& wall : scene.walls) {
        speed = std::max(speed, wall.velocity.norm());
    }
    for (const DiscScene& disc : scene.discs) {
        speed = std::max(speed, disc.velocity.norm());
    }
    return speed;
}

std::string speed_advice(const char* who, double speed, double sound_speed) {
    return fmt::format("{} up to {:.4g} m/s, {:.3g} of numerics.sound_speed, allowed {}: raise "
                       "numerics.sound_speed to {:.4g}",
                       who, speed, speed / sound_speed, largest_speed_share, speed / largest_speed_share);
}

struct Side {
    double distance; // m
    Vector normal;   // unit, into the fluid
};

// Of the series of a result, the one with the largest density error.
struct Sample {
    double error;       // share of the density
    double time;        // s
    double fluid_speed; // m/s
};

Sample worst_sample(const std::filesystem::path& result) {
    const Hdf5Reader reader(result);
    const std::vector<double> errors = reader.table("/series/largest_density_error").values;
    const auto index = static_cast<std::size_t>(std::ranges::max_element(errors) - errors.begin());
    return {errors[index], reader.table("/series/time").values[index],
            reader.table("/series/largest_speed").values[index]};
}

} // namespace

std::string density_advice(const Scene& scene, const DensityFault& fault) {
    const Numerics& numerics = scene.numerics;
    const double sound_speed = numerics.sound_speed;
    const double limit = largest_speed_share * sound_speed * (1 + 1e-9);
    if (const double driven = driven_speed(scene); driven > limit) {
        return speed_advice("walls, discs or the start move at", driven, sound_speed);
    }
    const bool sound_still_crosses = fault.time * sound_speed < scene.domain.size().maxCoeff();
    if (sound_still_crosses && fault.jump.speed > fault.jump.trusted_share() * sound_speed) {
        return fmt::format("{}, {:.3g} of numerics.sound_speed, allowed {}: {}", fault.jump.describe(),
                           fault.jump.speed / sound_speed, fault.jump.trusted_share(),
                           start_jump_advice(scene, fault.jump));
    }
    if (numerics.background_pressure_ratio == 0) {
        return "particles clump where nothing spaces them: set numerics.background_pressure_ratio to 1, "
               "not 0";
    }
    // Fluid at the speed of sound shows that the run went wrong, not why.
    if (fault.fluid_speed > telling_speed_share * sound_speed && fault.fluid_speed < sound_speed) {
        return speed_advice("the fluid moves at", fault.fluid_speed, sound_speed);
    }
    if (const double across = fault.gap / numerics.particle_spacing; across < fewest_across_a_gap) {
        return fmt::format("it is in a gap of {:.3g} particle spacings, advised at least {}: reduce "
                           "numerics.particle_spacing to {:.4g}, or raise numerics.sound_speed",
                           across, fewest_across_a_gap, fault.gap / fewest_across_a_gap);
    }
    return "reduce numerics.acoustic_cfl, or raise numerics.sound_speed: a flow's density error falls "
           "with its square";
}

double gap_around(const Particles& particles, const Region& region, const Vector& place) {
    std::vector<Side> sides;
    for (const Wall& wall : region.walls()) {
        const NearestPoint nearest = wall.nearest(place - wall.displacement(particles.time));
        sides.push_back({nearest.distance, nearest.normal});
    }
    for (const Disc& disc : particles.discs) {
        const Vector from_centre = nearest_image(place - disc.position, region.domain());
        sides.push_back({from_centre.norm() - disc.radius, from_centre.normalized()});
    }
    if (sides.size() < 2) {
        return std::numeric_limits<double>::infinity();
    }
    std::ranges::nth_element(sides, sides.begin() + 1, {}, &Side::distance);
    return sides[0].normal.dot(sides[1].normal) < 0 ? sides[0].distance + sides[1].distance
                                                    : std::numeric_limits<double>::infinity();
}

std::string density_note(const std::filesystem::path& result, const Scene& scene) {
    constexpr double aim = 0.01; // what numerics.sound_speed is meant for
    const Sample worst = worst_sample(result);
    if (!(worst.error > aim) || worst.error > largest_trusted_density_error) {
        return {};
    }
    return fmt::format(
        "density up to {:.2g} % off, at {:.4g} s; numerics.sound_speed of about {:.3g} keeps that of "
        "a steady flow within {:g} %\n",
        100 * worst.error, worst.time, scene.numerics.sound_speed * std::sqrt(worst.error / aim), 100 * aim);
}

std::string density_warning(const std::filesystem::path& result, const Scene& scene, const Region& region,
                            double time_step) {
    const Sample worst = worst_sample(result);
    if (!(worst.error > largest_trusted_density_error)) {
        return {};
    }
    DensityFault fault;
    fault.time = worst.time;
    fault.fluid_speed = worst.fluid_speed;
    fault.jump = start_jump(scene, region);
    return fmt::format(
        "{}: the density was up to {:.3g} % off, at step {}, time {:.6g} s; allowed {:g} %: do not "
        "trust pressures and forces of around then; {}",
        printable_path(result), 100 * worst.error, std::lround(fault.time / time_step), fault.time,
        100 * largest_trusted_density_error, density_advice(scene, fault));
}

} // namespace slurry
