#pragma once
// `--set` on the command line: values that replace or add to those of a scene file.
#include "solver/scene/document.hpp"

#include <string>

namespace slurry {

// Sets one `table.key=value` or `walls.NAME.key=value` in a document whose tables check_structure has
// accepted. Throws SceneError naming the override: no '=', an unknown path, no such wall, disc or probe, no
// TOML value.
void apply_override(Node& document, const std::string& text);

// Throws SceneError at an unknown table, or at one that is not a table or an array of tables as declared.
void check_structure(const Node& document);

} // namespace slurry
