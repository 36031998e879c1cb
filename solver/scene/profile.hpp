#pragma once
// Measured data that a scene names: CSV files of wall profiles and of radii.
#include "solver/vector.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace slurry {

// The bytes of a regular file. Throws SceneError naming `place` when it cannot be read or is larger than the
// limit.
[[nodiscard]] std::string read_bounded_file(const std::filesystem::path& path, std::size_t limit,
                                            const std::string& place);

// Both take files of at most 64 MiB, blank lines and # comments left out, and throw SceneError at the file
// and line at fault, or at `place` (the scene's mention of it) if it cannot be read or holds too little.

// Points x, y (m): one `x, y` a line, x ascending.
[[nodiscard]] std::vector<Vector> read_profile(const std::filesystem::path& path, const std::string& place);

// Radii (m): one a line, at least one, all positive.
[[nodiscard]] std::vector<double> read_radii(const std::filesystem::path& path, const std::string& place);

} // namespace slurry
