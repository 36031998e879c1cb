#pragma once
#include "solver/scene/scene.hpp"

#include <string>

namespace slurry {

// The scene as TOML with every key that it has, in the table's order; reads back as the same scene.
[[nodiscard]] std::string resolved_text(const Scene& scene);

} // namespace slurry
