#pragma once
// Rough walls that move at once through fluid that does not yet.
#include "solver/geometry/region.hpp"

#include <string>
#include <vector>

namespace slurry {

// Of the sound speed: jumps up to here kept the density within 5 % in every run that largest_survived_jump
// (start_jump.cpp) is from, 0.035 did not over gaps of 2 and 3 um.
inline constexpr double largest_trusted_jump = 0.03;

struct StartJump {
    std::string wall; // its name; empty when none jumps
    double speed = 0; // m/s: the largest, over the wall's points, across the wall and against the fluid there
};

// The largest of the scene's walls at time 0, where the fluid has start_velocity(). A flat wall that slides
// along itself does not jump.
[[nodiscard]] StartJump largest_start_jump(const Scene& scene, const std::vector<Wall>& walls);

// What to do about the jump of a wall of the scene, one clause: the sound speed that keeps the density within
// 5 %, and, where the same flow can be had with flat walls that move in place of the rough ones, their
// velocities.
[[nodiscard]] std::string start_jump_advice(const Scene& scene, const StartJump& jump);

// One line when the largest jump is more than what runs survive for certain, else none. Throws GeometryError
// for a wall whose shape makes no sense.
[[nodiscard]] std::vector<std::string> start_jump_warnings(const Scene& scene);

} // namespace slurry
