#include "solver/geometry/start_jump.hpp"

#include "solver/scene/refusal.hpp"
#include "solver/scene/start_velocity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace slurry {
namespace {

// Of the sound speed c: what every start survived, the watchdog looking every second step. Tried were pads
// that jump in verification/rough_channel (spacings 0.25, 0.5 and 1 um) and verification/gaussian_asperity
// (sigma 2, 4 and 6 um, gaps of 2 to 7 um, spacings 0.2 and 0.4 um), at 0.03 to 0.1. In the first 10 to 50
// steps the density is off by 1.2 to 1.4 times speed / c, and by up to 1.7 times when the sound has come to a
// gap of 2 um. At 0.055 that is up to 9.3 %; 0.06 stopped over the gap of 2 um, 0.065 also over 3 um, 0.07
// also in the rough channel at 0.5 um, 0.08 wherever the spacing was 0.25 um or more. A smaller time step
// does not help.
constexpr double largest_survived_jump = 0.055;

double jump_speed(const Scene& scene, const Wall& wall) {
    constexpr double fewest_points = 1000;
    const double points = std::max(fewest_points, wall.length() / scene.numerics.particle_spacing);
    double speed = 0;
    for (const WallPoint& point : wall.sample(static_cast<int>(points))) {
        const Vector against_fluid = wall.velocity() - start_velocity(scene, point.position);
        speed = std::max(speed, std::abs(against_fluid.dot(point.normal)));
    }
    return speed;
}

} // namespace

StartJump largest_start_jump(const Scene& scene, const std::vector<Wall>& walls) {
    StartJump largest;
    for (const Wall& wall : walls) {
        if (const double speed = jump_speed(scene, wall); speed > largest.speed) {
            largest = {wall.name(), speed};
        }
    }
    return largest;
}

std::string start_jump_advice(const Scene& scene, const StartJump& jump) {
    std::string advice =
        fmt::format("raise numerics.sound_speed to {:.4g}", jump.speed / largest_trusted_jump);
    const Vector velocity = std::ranges::find(scene.walls, jump.wall, &WallScene::name)->velocity;
    const auto held = [](const DiscScene& disc) { return disc.motion != DiscMotion::free; };
    if (velocity == Vector::Zero() || std::ranges::any_of(scene.discs, held)) {
        return advice;
    }
    std::vector<std::string> flat;
    for (const WallScene& wall : scene.walls) {
        if (std::holds_alternative<LineShape>(wall.shape)) {
            const Vector instead = wall.velocity - velocity;
            flat.push_back(
                fmt::format("walls.{}.velocity=[{:g}, {:g}]", wall.name, instead.x(), instead.y()));
        }
    }
    if (!flat.empty()) {
        advice += fmt::format(", or let it stand and set {}, which ends in the same flow",
                              fmt::join(flat, " and "));
    }
    return advice;
}

std::vector<std::string> start_jump_warnings(const Scene& scene) {
    std::vector<Wall> walls;
    for (const WallScene& wall : scene.walls) {
        walls.emplace_back(wall, scene.domain);
    }
    const StartJump jump = largest_start_jump(scene, walls);
    const double share = jump.speed / scene.numerics.sound_speed;
    if (scene.start.arrangement == Arrangement::empty || !(share > largest_survived_jump * (1 + 1e-9))) {
        return {};
    }
    return {
        fmt::format("{}: found the wall '{}' that starts at once at {:.4g} (m/s) across its surface, {:.3g} "
                    "of numerics.sound_speed, advised at most {}: the start compresses the fluid before it, "
                    "and the run may stop; {}",
                    printable_path(scene.path), jump.wall, jump.speed, share, largest_survived_jump,
                    start_jump_advice(scene, jump))};
}

} // namespace slurry
