#pragma once
// What a run accepts although it is unlikely to be meant, and only the geometry tells.
#include "solver/geometry/region.hpp"

#include <string>
#include <vector>

namespace slurry {

// One line each, with the scene's file: point probes behind a wall at the start, whose samples are NaN, and
// films between a disc at a chosen place and walls: of fewer than 3 particle spacings at two walls, or of
// less than one at one. The region is the scene's.
[[nodiscard]] std::vector<std::string> start_warnings(const Scene& scene, const Region& region);

} // namespace slurry
