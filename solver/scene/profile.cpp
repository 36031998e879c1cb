#include "solver/scene/profile.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <string_view>

namespace slurry {
namespace {

constexpr std::size_t largest_file = std::size_t{64} << 20U;
constexpr std::string_view blanks = " \t\r";

std::string_view without_blanks(std::string_view text) {
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

template <std::size_t Columns> std::optional<std::array<double, Columns>> numbers_of(std::string_view line) {
    std::array<double, Columns> numbers{};
    for (std::size_t column = 0; column < Columns; ++column) {
        const bool last = column + 1 == Columns;
        const std::size_t comma = last ? line.size() : line.find(',');
        const auto number = comma == std::string_view::npos
                                ? std::nullopt
                                : finite_number(without_blanks(line.substr(0, comma)));
        if (!number) {
            return std::nullopt;
        }
        numbers[column] = *number;
        line.remove_prefix(last ? comma : comma + 1);
    }
    return numbers;
}

// Calls take(numbers, here) for each line that is not blank; here() names the line.
template <std::size_t Columns, class Take>
void for_each_row(std::string_view text, const std::string& name, std::string_view allowed, Take take) {
    std::string_view rest = text;
    if (rest.starts_with("\xEF\xBB\xBF")) { // spreadsheets begin UTF-8 files with this mark
        rest.remove_prefix(3);
    }
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::string_view whole = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(whole.size() + 1, rest.size()));
        const std::string_view line = without_blanks(whole.substr(0, whole.find('#')));
        if (line.empty()) {
            continue;
        }
        const auto here = [&] { return fmt::format("{}:{}", name, number); };
        const auto numbers = numbers_of<Columns>(line);
        if (!numbers) {
            refuse(here(), fmt::format("\"{}\"", printable(line)), allowed);
        }
        take(*numbers, here);
    }
}

} // namespace

std::string read_bounded_file(const std::filesystem::path& path, std::size_t limit,
                              const std::string& place) {
    const std::string name = printable_path(path);
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

std::vector<Vector> parse_profile(std::string_view text, const std::string& name, const std::string& place) {
    std::vector<Vector> points;
    const auto take = [&](const std::array<double, 2>& point, const auto& here) {
        if (!points.empty() && point[0] <= points.back().x()) {
            refuse(here(), fmt::format("x = {} after {}", point[0], points.back().x()), "ascending x");
        }
        points.emplace_back(point[0], point[1]);
    };
    for_each_row<2>(text, name, "two finite numbers x, y (m), or # before a comment", take);
    if (points.size() < 2) {
        refuse(place, fmt::format("{} with {} points", name, points.size()), "at least 2");
    }
    return points;
}

std::vector<double> parse_radii(std::string_view text, const std::string& name, const std::string& place) {
    std::vector<double> radii;
    const auto take = [&](const std::array<double, 1>& radius, const auto& here) {
        if (!(radius[0] > 0)) {
            refuse(here(), fmt::format("the radius {}", radius[0]), "a number > 0 (m)");
        }
        radii.push_back(radius[0]);
    };
    for_each_row<1>(text, name, "one finite number, a radius (m), or # before a comment", take);
    if (radii.empty()) {
        refuse(place, fmt::format("{} without radii", name), "at least one");
    }
    return radii;
}

std::vector<Vector> read_profile(const std::filesystem::path& path, const std::string& place) {
    return parse_profile(read_bounded_file(path, largest_file, place), printable_path(path), place);
}

std::vector<double> read_radii(const std::filesystem::path& path, const std::string& place) {
    return parse_radii(read_bounded_file(path, largest_file, place), printable_path(path), place);
}

} // namespace slurry
