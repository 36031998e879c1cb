#include "solver/scene/profile.hpp"

#include "solver/scene/refusal.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <string_view>

namespace slurry {
namespace {

constexpr std::size_t largest_profile = std::size_t{64} << 20U;
constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(blanks);
    return begin == std::string_view::npos ? ""
                                           : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

std::optional<double> finite_number(std::string_view text) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && stop == end && std::isfinite(number) ? std::optional(number)
                                                                        : std::nullopt;
}

std::optional<Vector> point(std::string_view line) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) {
        return std::nullopt;
    }
    const auto x = finite_number(trimmed(line.substr(0, comma)));
    const auto y = finite_number(trimmed(line.substr(comma + 1)));
    return x && y ? std::optional<Vector>(Vector(*x, *y)) : std::nullopt;
}

} // namespace

std::string read_bounded_file(const std::filesystem::path& path, std::size_t limit,
                              const std::string& place) {
    const std::string name = printable(path.string());
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        refuse(place, fmt::format("no regular file {}", name), "one that exists");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > limit) {
        refuse(place, fmt::format("{} of {} bytes", name, size), fmt::format("at most {}", limit));
    }
    std::string text(error ? 0 : size, '\0');
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream.read(text.data(), static_cast<std::streamsize>(text.size()))) {
        refuse(place, fmt::format("{}, which cannot be read", name), "a readable file");
    }
    return text;
}

std::vector<Vector> read_profile(const std::filesystem::path& path, const std::string& place) {
    const std::string text = read_bounded_file(path, largest_profile, place);
    const std::string name = printable(path.string());
    std::vector<Vector> points;
    std::string_view rest = text;
    if (rest.starts_with("\xEF\xBB\xBF")) { // spreadsheets begin UTF-8 files with this mark
        rest.remove_prefix(3);
    }
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::string_view whole = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(whole.size() + 1, rest.size()));
        const std::string_view line = trimmed(whole.substr(0, whole.find('#')));
        if (line.empty()) {
            continue;
        }
        const std::optional<Vector> next = point(line);
        if (!next) {
            refuse(fmt::format("{}:{}", name, number), fmt::format("\"{}\"", printable(line)),
                   "two finite numbers x, y (m), or # before a comment");
        }
        if (!points.empty() && next->x() <= points.back().x()) {
            refuse(fmt::format("{}:{}", name, number),
                   fmt::format("x = {} after {}", next->x(), points.back().x()), "ascending x");
        }
        points.push_back(*next);
    }
    if (points.size() < 2) {
        refuse(place, fmt::format("{} with {} points", name, points.size()), "at least 2");
    }
    return points;
}

} // namespace slurry
