#pragma once
// The words in which a scene is refused.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace slurry {

// Throws SceneError "place: found ..., allowed ...[, nearest known key ...]".
[[noreturn]] void refuse(std::string_view place, std::string_view found, std::string_view allowed,
                         std::string_view nearest = {});

// The text on one line and at most 80 characters long, so that a message stays one line whatever a file
// holds.
[[nodiscard]] std::string printable(std::string_view text);

// The path on one line and whole: who looks for the file needs all of it.
[[nodiscard]] std::string printable_path(const std::filesystem::path& path);

// Number of insertions, deletions and substitutions from one word to the other (Levenshtein).
[[nodiscard]] std::size_t edit_distance(std::string_view left, std::string_view right);

// The candidate nearest to the word, empty when there is none.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

} // namespace slurry
