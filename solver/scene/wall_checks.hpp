#pragma once
// What must hold between a wall's shape and the domain that it stands in.
#include "solver/scene/checks.hpp"

#include <string>
#include <vector>

namespace slurry {

// Throws SceneError when a shape is so wide that the domain holds nothing of it: a random profile with a
// correlation length, or a Gaussian bump in a periodic domain with a width, above the domain's width. Warns,
// one line each, where the domain holds too little of it for the shape that its name promises.
[[nodiscard]] std::vector<std::string> check_wall_shapes(const Scene& scene, const Places& places);

} // namespace slurry
