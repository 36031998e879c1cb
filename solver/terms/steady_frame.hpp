#pragma once
// The frame of reference in which the flow of a scene may become steady.
#include "solver/scene/scene.hpp"

#include <optional>

namespace slurry {

// Its velocity, m/s: that of the walls that are not straight, or rest where all are. None where rough walls
// move relative to each other, or where discs alone disturb the flow.
std::optional<Vector> steady_frame(const Scene& scene);

} // namespace slurry
