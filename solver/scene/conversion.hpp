#pragma once
// From what was written to the value of a declared parameter.
#include "solver/scene/document.hpp"
#include "solver/scene/parameters.hpp"

#include <string>

namespace slurry {

// The value of the node. Throws SceneError at its place when the type or range is not the parameter's.
// `address` is what a message calls the parameter.
[[nodiscard]] Value to_value(const Parameter& parameter, const Node& node, const std::string& address);

} // namespace slurry
