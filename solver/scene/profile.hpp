#pragma once
// Measured data that a scene names: CSV files of wall profiles and of radii.
#include "solver/vector.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace slurry {

// The bytes of a regular file. Throws SceneError naming `place` when it cannot be read or is larger than the
// limit.
[[nodiscard]] std::string read_bounded_file(const std::filesystem::path& path, std::size_t limit,
                                            const std::string& place);

// All leave blank lines and # comments out, and throw SceneError at the file and line at fault, or at `place`
// (the scene's mention of it) if it holds too little, cannot be read or is larger than 64 MiB. The parsers
// read a text that messages call `name`.

// Points x, y (m): one `x, y` a line, x ascending.
[[nodiscard]] std::vector<Vector> read_profile(const std::filesystem::path& path, const std::string& place);
[[nodiscard]] std::vector<Vector> parse_profile(std::string_view text, const std::string& name,
                                                const std::string& place);

// Radii (m): one a line, at least one, all positive.
[[nodiscard]] std::vector<double> read_radii(const std::filesystem::path& path, const std::string& place);
[[nodiscard]] std::vector<double> parse_radii(std::string_view text, const std::string& name,
                                              const std::string& place);

} // namespace slurry
