#pragma once
// Measured wall profiles: CSV files of two columns.
#include "solver/vector.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace slurry {

// The bytes of a regular file. Throws SceneError naming `place` when it cannot be read or is larger than the
// limit.
[[nodiscard]] std::string read_bounded_file(const std::filesystem::path& path, std::size_t limit,
                                            const std::string& place);

// Points x, y (m) of a file of at most 64 MiB: one `x, y` a line, x ascending, blank lines and # comments
// left out. Throws SceneError at the file and line at fault, or at `place` (the scene's mention of it) if it
// cannot be read.
[[nodiscard]] std::vector<Vector> read_profile(const std::filesystem::path& path, const std::string& place);

} // namespace slurry
