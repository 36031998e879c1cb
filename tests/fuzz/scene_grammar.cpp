#include "tests/fuzz/scene_grammar.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace slurry::fuzz {
namespace {

using Words = std::vector<std::string>;

constexpr std::array<const char*, 14> edges{"0",
                                            "-0.0",
                                            "-1",
                                            "1",
                                            "4.9e-324",
                                            "1e-320",
                                            "1e308",
                                            "1e999",
                                            "inf",
                                            "-inf",
                                            "nan",
                                            "2147483648",
                                            "9223372036854775807",
                                            "-9223372036854775808"};
constexpr std::array<const char*, 12> other_types{"true",       "\"\"",       "[]",      "{}",
                                                  "[[1]]",      "1979-05-27", "\"a\"",   "[1, 2]",
                                                  "[nan, inf]", "''",         "{a = 1}", "\"\\u0000\""};
constexpr std::array<const char*, 6> names{"a", "b", "pad", "wafer", "a_1", "x-y"};
constexpr std::array<const char*, 7> files{
    "profile.csv", "radii.csv", "missing.csv", "../profile.csv", "/dev/zero", "a/../radii.csv", "."};

std::string in_quotes(std::string_view text) {
    return fmt::format("\"{}\"", text);
}

std::string allowed_number(const Allowed& allowed, bool whole, RandomSource& random) {
    const double lower = std::max(allowed.lower, -1e3);
    const double upper = std::min(allowed.upper, 1e3);
    const double number = allowed.lower >= 0 && upper > 0
                              ? random.logarithmic(std::max(lower, 1e-6 * upper), upper)
                              : random.uniform(lower, upper);
    return whole ? fmt::format("{:.0f}", std::ceil(number)) : fmt::format("{:.6g}", number);
}

std::string list_of(std::size_t count, const Allowed& allowed, bool whole, RandomSource& random) {
    Words numbers(count);
    std::ranges::generate(numbers, [&] { return allowed_number(allowed, whole, random); });
    return fmt::format("[{}]", fmt::join(numbers, ", "));
}

Words lines_of(const std::string& text) {
    Words lines{""};
    for (const char character : text) {
        if (character == '\n') {
            lines.emplace_back();
        } else {
            lines.back() += character;
        }
    }
    return lines;
}

// The parameter that a line `key = value` most likely sets; any if the key is unknown.
const Parameter& parameter_of(const std::string& line, RandomSource& random) {
    const std::string key = line.substr(0, line.find_first_of(" ="));
    const auto found = std::ranges::find(parameters(), key, &Parameter::key);
    return found == parameters().end() ? random.pick(std::span(parameters())) : *found;
}

std::string line_of(const Parameter& parameter, RandomSource& random) {
    return fmt::format("{} = {}", parameter.key,
                       random.chance(0.7) ? allowed_value(parameter, random) : any_value(parameter, random));
}

} // namespace

std::string allowed_value(const Parameter& parameter, RandomSource& random) {
    const Allowed& allowed = parameter.allowed;
    switch (parameter.binding.kind) {
    case Kind::boolean:
        return random.chance(0.5) ? "true" : "false";
    case Kind::integer:
        return allowed_number(allowed, true, random);
    case Kind::number:
        return allowed_number(allowed, false, random);
    case Kind::text:
        return in_quotes(names[random.below(names.size())]);
    case Kind::file:
        return in_quotes(files[random.below(files.size())]);
    case Kind::choice:
        return in_quotes(random.pick(std::span(allowed.choices)));
    case Kind::vector:
        return list_of(2, allowed, false, random);
    case Kind::counts:
        return list_of(2, allowed, true, random);
    case Kind::numbers:
        return list_of(random.below(4), allowed, false, random);
    }
    return {};
}

std::string any_value(const Parameter& parameter, RandomSource& random) {
    switch (random.below(5)) {
    case 0:
        return allowed_value(parameter, random);
    case 1:
        return edges[random.below(edges.size())];
    case 2:
        return fmt::format("[{}, {}]", edges[random.below(edges.size())], edges[random.below(edges.size())]);
    case 3:
        return fmt::format("{}", random.chance(0.5) ? parameter.allowed.lower : parameter.allowed.upper);
    default:
        return other_types[random.below(other_types.size())];
    }
}

std::string random_table(RandomSource& random) {
    const Section& section = random.pick(std::span(sections()));
    std::string text = section.heading() + "\n";
    std::string chosen;
    for (const Parameter* parameter : parameters_of(section.name)) {
        if (parameter->key == section.selector) {
            chosen = random.pick(std::span(parameter->allowed.choices));
            text += fmt::format("{} = {}\n", parameter->key, in_quotes(chosen));
        } else if ((chosen.empty() || parameter->belongs_to(chosen)) &&
                   random.chance(parameter->fallback.standard ? 0.3 : 0.98)) {
            text += line_of(*parameter, random) + "\n";
        }
    }
    return text;
}

std::string changed_scene(const std::string& text, RandomSource& random) {
    Words lines = lines_of(text);
    const std::size_t at = random.below(lines.size());
    const auto place = lines.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(6)) {
    case 0:
    case 1:
        *place = line_of(parameter_of(lines[at], random), random);
        break;
    case 2:
        lines.insert(place, line_of(random.pick(std::span(parameters())), random));
        break;
    case 3:
        lines.erase(place);
        break;
    case 4:
        lines.insert(place, lines[random.below(lines.size())]);
        break;
    default:
        lines.push_back(random_table(random));
        break;
    }
    return fmt::format("{}", fmt::join(lines, "\n"));
}

} // namespace slurry::fuzz
