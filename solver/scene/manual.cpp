#include "solver/scene/manual.hpp"

#include "solver/scene/parameters.hpp"

#include <fmt/format.h>

namespace slurry {
namespace {

constexpr std::string_view introduction = "A scene is a TOML file in SI units. Keys without a default are "
                                          "required; an unknown key, a wrong type or a value\n"
                                          "out of range is refused. On the command line `--set "
                                          "table.key=value` sets a key, and in arrays of tables\n"
                                          "`--set walls.NAME.key=value`.\n";

std::string fallback_text(const Parameter& parameter) {
    if (!parameter.fallback.standard) {
        return "required";
    }
    const Kind kind = parameter.binding.kind;
    const std::string standard = to_toml(*parameter.fallback.standard, kind);
    const std::string wang2014 = to_toml(*parameter.fallback.wang2014, kind);
    return standard == wang2014 ? standard : fmt::format("{} (scheme wang2014: {})", standard, wang2014);
}

// "shape = "cosine": " before the meaning of a key that not every table of the section has.
std::string condition(const Section& section, const Parameter& parameter) {
    return parameter.variant.empty() ? "" : fmt::format("{} = \"{}\": ", section.selector, parameter.variant);
}

} // namespace

std::string scene_manual() {
    std::string text(introduction);
    for (const Section& section : sections()) {
        text += fmt::format("\n{}  {}\n", section.heading(), section.meaning);
        for (const Parameter* parameter : parameters_of(section.name)) {
            text += fmt::format("  {:<26} {}; {}\n{:29}{}{}\n", parameter->key, parameter->allowed_text(),
                                fallback_text(*parameter), "", condition(section, *parameter),
                                parameter->meaning);
        }
    }
    return text;
}

std::string scene_manual_markdown() {
    std::string text = fmt::format("# Scene files\n\nMade from the declared parameters in "
                                   "`solver/scene/parameter_table.cpp`: do not edit.\n\n{}",
                                   introduction);
    for (const Section& section : sections()) {
        text +=
            fmt::format("\n## `{}`: {}\n\n| key | allowed (unit) | default | meaning |\n|---|---|---|---|\n",
                        section.heading(), section.meaning);
        for (const Parameter* parameter : parameters_of(section.name)) {
            text +=
                fmt::format("| `{}` | {} | {} | {}{} |\n", parameter->key, parameter->allowed_text(),
                            fallback_text(*parameter), condition(section, *parameter), parameter->meaning);
        }
    }
    return text;
}

} // namespace slurry
