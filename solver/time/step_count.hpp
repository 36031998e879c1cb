#pragma once
// How many steps a run takes.
#include "solver/geometry/region.hpp"
#include "solver/particles/disc.hpp"

#include <span>

namespace slurry {

// Steps of equal length that end exactly at output.end_time, each of `time_step` (s) at most. Throws
// SceneError when they are beyond scene.limits.steps.
[[nodiscard]] long step_count(const Scene& scene, double time_step);

// The same with the largest time step for these discs. The region is the scene's.
[[nodiscard]] long step_count(const Scene& scene, const Region& region, std::span<const Disc> discs);

} // namespace slurry
