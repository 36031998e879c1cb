#include "solver/particles/start_jump.hpp"

#include "solver/particles/wall_impulse.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/scene/start_velocity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace slurry {
namespace {

// Shares of the sound speed c. Tried were pads that jump in verification/rough_channel (spacings 0.25, 0.5
// and 1 um) and verification/gaussian_asperity (sigma 2, 4 and 6 um, gaps of 2 to 7 um, spacings 0.2 and 0.4
// um). Without the impulse, jumps of 0.03 to 0.1: the density is off by 1.2 to 1.4 times speed / c in the
// first 10 to 50 steps, and by up to 1.7 times when the sound has come to a gap of 2 um. At 0.03 it stayed
// within 5 %, at 0.035 not; at 0.055 within 9.3 %, and from 0.06 on some runs stopped.
constexpr double trusted_jump = 0.03;
constexpr double survived_jump = 0.055;
// With the impulse, speeds past the wall of 0.13 to 0.55: 0.7 to 1.6 times (speed / c)^2 / 2, and twice that
// over a gap of 2 um beneath an asperity as narrow; at 0.3 within 5 %; that one stopped at 0.39, others from
// 0.47 on.
constexpr double trusted_flow = 0.3;
constexpr double survived_flow = 0.38;

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

double StartJump::trusted_share() const {
    return impulse ? trusted_flow : trusted_jump;
}

double StartJump::survived_share() const {
    return impulse ? survived_flow : survived_jump;
}

std::string StartJump::describe() const {
    return impulse
               ? fmt::format("the wall '{}' starts at once, and the fluid passes it at {:.4g} m/s", wall,
                             speed)
               : fmt::format("the wall '{}' starts at once at {:.4g} m/s across its surface", wall, speed);
}

StartJump largest_jump_across(const Scene& scene, const std::vector<Wall>& walls) {
    StartJump largest;
    for (const Wall& wall : walls) {
        if (const double speed = jump_speed(scene, wall); speed > largest.speed) {
            largest = {wall.name(), speed};
        }
    }
    return largest;
}

StartJump start_jump(const Scene& scene, const Region& region) {
    StartJump jump = largest_jump_across(scene, region.walls());
    const WallImpulse impulse(scene, region, {});
    if (impulse.none()) {
        return jump;
    }
    const Vector wall = std::ranges::find(scene.walls, jump.wall, &WallScene::name)->velocity;
    jump = {jump.wall, 0, true};
    for (const Vector& point : region.lattice_points(scene.numerics.particle_spacing)) {
        const Vector past = start_velocity(scene, point) + impulse.velocity(point) - wall;
        jump.speed = std::max(jump.speed, past.norm());
    }
    return jump;
}

std::string start_jump_advice(const Scene& scene, const StartJump& jump) {
    std::string advice =
        fmt::format("raise numerics.sound_speed to {:.4g}", jump.speed / jump.trusted_share());
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

std::vector<std::string> start_jump_warnings(const Scene& scene, const Region& region) {
    const StartJump jump = start_jump(scene, region);
    const double share = jump.speed / scene.numerics.sound_speed;
    if (scene.start.arrangement == Arrangement::empty || !(share > jump.survived_share() * (1 + 1e-9))) {
        return {};
    }
    return {fmt::format("{}: {}, {:.3g} of numerics.sound_speed, advised at most {}: the start changes the "
                        "fluid's density there, and the run may stop; {}",
                        printable_path(scene.path), jump.describe(), share, jump.survived_share(),
                        start_jump_advice(scene, jump))};
}

} // namespace slurry
