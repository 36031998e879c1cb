#pragma once
// Rough walls that move at once through fluid that does not yet.
#include "solver/geometry/region.hpp"

#include <string>
#include <vector>

namespace slurry {

struct StartJump {
    std::string wall;     // its name; empty when none jumps
    double speed = 0;     // m/s: what the density suffers from, see start_jump()
    bool impulse = false; // of the fluid past the wall; else of the wall across its surface

    // Of the sound speed: up to here the density stays within 5 %, and the run does not stop.
    [[nodiscard]] double trusted_share() const;
    [[nodiscard]] double survived_share() const;
    // One clause.
    [[nodiscard]] std::string describe() const;
};

// The largest speed (m/s) of one of the scene's walls at time 0 across its surface, over its points and
// against the fluid there, which has start_velocity(). A flat wall that slides along itself does not jump.
[[nodiscard]] StartJump largest_jump_across(const Scene& scene, const std::vector<Wall>& walls);

// Of the wall that jumps most. With start.impulse it is the fluid's largest speed past that wall that
// matters, discs left out: its density falls by half the square of speed over sound speed (Bernoulli).
[[nodiscard]] StartJump start_jump(const Scene& scene, const Region& region);

// What to do about the jump of a wall of the scene, one clause: the sound speed that keeps the density within
// 5 %, and, where the same flow can be had with flat walls that move in place of the rough ones, their
// velocities.
[[nodiscard]] std::string start_jump_advice(const Scene& scene, const StartJump& jump);

// One line when the jump is more than what runs survive for certain, else none.
[[nodiscard]] std::vector<std::string> start_jump_warnings(const Scene& scene, const Region& region);

} // namespace slurry
