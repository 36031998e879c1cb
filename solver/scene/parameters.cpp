#include "solver/scene/parameters.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slurry {
namespace {

std::string type_text(const Parameter& parameter) {
    switch (parameter.binding.kind) {
    case Kind::boolean:
        return "true or false";
    case Kind::integer:
        return "an integer";
    case Kind::number:
        return "a number";
    case Kind::text:
        return parameter.allowed.identifier ? "a string of" : "one line of at most 1000 characters";
    case Kind::file:
        return "a file name";
    case Kind::choice:
        return "one of";
    case Kind::vector:
        return "two numbers [x, y]";
    case Kind::counts:
        return "two integers [x, y]";
    case Kind::numbers:
        return "a list of numbers";
    }
    return {};
}

std::string number_text(double number) {
    std::string text = fmt::format("{}", number);
    return text.find_first_of(".en") == std::string::npos ? text + ".0"
                                                          : text; // a TOML float, not an integer
}

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') {
            result += '\\';
        }
        result += character;
    }
    return result + '"';
}

} // namespace

bool Allowed::contains(double number) const {
    return std::isfinite(number) && number <= upper && (lower_excluded ? number > lower : number >= lower);
}

std::string Allowed::text() const {
    if (identifier) {
        return "letters, digits, _ and -";
    }
    if (!choices.empty()) {
        return fmt::format("\"{}\"", fmt::join(choices, "\", \""));
    }
    const bool bounded = std::isfinite(upper);
    if (!std::isfinite(lower)) {
        return bounded ? fmt::format("<= {}", upper) : "";
    }
    const std::string from = fmt::format("{} {}", lower_excluded ? ">" : ">=", lower);
    return bounded ? fmt::format("{} and <= {:.8g}", from, upper) : from;
}

Value Parameter::get(const Scene& scene, std::size_t index) const {
    Value value = binding.get(scene, index);
    if (binding.kind == Kind::choice) {
        return std::string(allowed.choices.at(static_cast<std::size_t>(std::get<std::int64_t>(value))));
    }
    return value;
}

void Parameter::set(Scene& scene, std::size_t index, const Value& value) const {
    if (binding.kind == Kind::choice) {
        const auto choice = std::ranges::find(allowed.choices, std::get<std::string>(value));
        binding.set(scene, index, std::int64_t{choice - allowed.choices.begin()});
    } else {
        binding.set(scene, index, value);
    }
}

std::string Parameter::address() const {
    return fmt::format("{}.{}", section, key);
}

std::string Parameter::allowed_text() const {
    std::string text = type_text(*this);
    if (const std::string range = allowed.text(); !range.empty()) {
        text += " " + range;
    }
    return unit.empty() ? text : fmt::format("{} ({})", text, unit);
}

std::string Section::heading() const {
    return repeated() ? fmt::format("[[{}]]", name) : fmt::format("[{}]", name);
}

std::string Section::chosen(const Scene& scene, std::size_t index) const {
    return selector.empty() ? "" : std::get<std::string>(find_parameter(name, selector)->get(scene, index));
}

const Section* find_section(std::string_view name) {
    const auto section = std::ranges::find(sections(), name, &Section::name);
    return section == sections().end() ? nullptr : &*section;
}

std::vector<const Parameter*> parameters_of(std::string_view section) {
    std::vector<const Parameter*> result;
    for (const Parameter& parameter : parameters()) {
        if (parameter.section == section) {
            result.push_back(&parameter);
        }
    }
    return result;
}

const Parameter* find_parameter(std::string_view section, std::string_view key, std::string_view chosen) {
    const auto found = std::ranges::find_if(parameters(), [&](const Parameter& parameter) {
        return parameter.section == section && parameter.key == key &&
               (chosen.empty() || parameter.belongs_to(chosen));
    });
    return found == parameters().end() ? nullptr : &*found;
}

std::string nearest_address(std::string_view section, std::string_view key, std::string_view chosen) {
    constexpr std::size_t longest = 200; // bounds the cost for absurd keys
    const auto distance = [&](const Parameter& parameter) {
        const bool near = parameter.section == section && (chosen.empty() || parameter.belongs_to(chosen));
        return 2 * edit_distance(key.substr(0, longest), parameter.key) + (near ? 0U : 1U);
    };
    const Parameter& best = *std::ranges::min_element(parameters(), {}, distance);
    if (best.section != section || chosen.empty() || best.belongs_to(chosen)) {
        return best.address();
    }
    return fmt::format("{} of {} = \"{}\"", best.address(), find_section(section)->selector, best.variant);
}

std::string to_toml(const Value& value, Kind kind) {
    struct Writer {
        Kind kind;
        std::string operator()(bool flag) const { return flag ? "true" : "false"; }
        std::string operator()(std::int64_t integer) const { return fmt::format("{}", integer); }
        std::string operator()(double number) const { return number_text(number); }
        std::string operator()(const std::string& text) const { return toml_string(text); }
        std::string operator()(const std::vector<double>& numbers) const {
            std::vector<std::string> words;
            words.reserve(numbers.size());
            for (const double number : numbers) {
                words.push_back(kind == Kind::counts ? fmt::format("{:.0f}", number) : number_text(number));
            }
            return fmt::format("[{}]", fmt::join(words, ", "));
        }
    };
    return std::visit(Writer{kind}, value);
}

} // namespace slurry
