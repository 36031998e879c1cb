#pragma once
// Reads and validates a scene file. Every key is declared in solver/scene/parameters.cpp.
#include "solver/scene/scene.hpp"

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace slurry {

// A scene that is refused; what() is one line: `place: found ..., allowed ...[, nearest known key ...]`,
// where the place is file:line:column, file:line in a CSV file, or the `--set key=value` at fault.
class SceneError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Reads a scene (at most 1 MiB) and applies the overrides in their order. An override is `table.key=value`,
// or `walls.NAME.key=value` for a table of an array; the value is TOML, a bare word being a string. Throws
// SceneError on anything that is not declared, missing, out of range, contradictory or beyond the limits.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides = {},
                               const Limits& limits = {});

// The same for a text that `path` names in messages, and whose folder the files it names are relative to.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::filesystem::path& path,
                                std::span<const std::string> overrides = {}, const Limits& limits = {});

} // namespace slurry
