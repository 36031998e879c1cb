#pragma once
// The manual of the scene file, made from the declared parameters.
#include <string>

namespace slurry {

[[nodiscard]] std::string scene_manual();          // for a terminal: `slurry help scene`
[[nodiscard]] std::string scene_manual_markdown(); // for docs/scene.md

} // namespace slurry
