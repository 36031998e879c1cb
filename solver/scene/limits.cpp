#include "solver/scene/limits.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace slurry {
namespace {

std::string names() {
    std::string text;
    for (const NamedLimit& limit : named_limits) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", limit.name);
    }
    return text;
}

// Three digits, and not less than the number: what a message advises has to be enough.
double rounded_up(double number) {
    const double unit = std::pow(10, std::floor(std::log10(number)) - 2);
    return std::ceil(number / unit) * unit;
}

} // namespace

void set_limit(Limits& limits, const std::string& text) {
    const std::string place = fmt::format("--limit {}", printable(text));
    const std::size_t equals = text.find('=');
    const auto known =
        std::ranges::find(named_limits, std::string_view(text).substr(0, equals), &NamedLimit::name);
    if (equals == std::string::npos || known == named_limits.end()) {
        refuse(place, "no limit's name and '='", fmt::format("NAME=NUMBER with a NAME of {}", names()));
    }
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, value);
    if (error != std::errc{} || stop != end || !(value > 0) || !std::isfinite(value)) {
        refuse(place, fmt::format("\"{}\"", printable(text.substr(equals + 1))), "a number > 0");
    }
    limits.*(known->value) = value;
}

std::string limit_text(const Limits& limits, double Limits::*limit, double needed) {
    const auto named = std::ranges::find(named_limits, limit, &NamedLimit::value);
    return fmt::format("at most {:.4g}; --limit {}={:.3g} would allow it", limits.*limit, named->name,
                       rounded_up(needed));
}

} // namespace slurry
