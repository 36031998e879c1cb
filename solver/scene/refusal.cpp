#include "solver/scene/refusal.hpp"

#include "solver/scene/read_scene.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace slurry {

void refuse(std::string_view place, std::string_view found, std::string_view allowed,
            std::string_view nearest) {
    std::string message = fmt::format("{}: found {}, allowed {}", place, found, allowed);
    if (!nearest.empty()) {
        message += fmt::format(", nearest known key {}", nearest);
    }
    throw SceneError(message);
}

namespace {

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char character) { return character < 0x20 || character == 0x7F; }, '?');
    return text;
}

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t longest = 80;
    std::string line(text.substr(0, longest));
    if (text.size() > longest) {
        // A UTF-8 character, which is not to be cut in two, has at most three bytes after the first.
        for (int k = 0; k < 3 && (static_cast<unsigned char>(line.back()) & 0xC0U) == 0x80U; ++k) {
            line.pop_back();
        }
        line.replace(line.size() - 1, 1, "...");
    }
    return one_line(std::move(line));
}

std::string printable_path(const std::filesystem::path& path) {
    return one_line(path.string());
}

std::size_t edit_distance(std::string_view left, std::string_view right) {
    std::vector<std::size_t> row(right.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < left.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < right.size(); ++j) {
            const std::size_t substituted = diagonal + (left[i] == right[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string_view compared = word.substr(0, 200); // bounds the cost for absurd words
    const auto best = std::ranges::min_element(
        candidates, {}, [&](const std::string& candidate) { return edit_distance(compared, candidate); });
    return best == candidates.end() ? std::string{} : *best;
}

} // namespace slurry
