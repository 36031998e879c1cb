#include "solver/scene/document.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

// toml++ takes a level of stack for each level of nesting; a scene needs three.
#define TOML_MAX_NESTED_VALUES 8
#include <toml++/toml.h>

namespace slurry {
namespace {

// Names the place of a region of the source.
using Placer = std::function<std::string(const toml::source_region&)>;

Node convert(const toml::node& source, const Placer& placer) {
    Node node{placer(source.source()), Node::Date{}};
    if (const toml::table* table = source.as_table()) {
        NodeTable entries;
        for (const auto& [key, value] : *table) {
            entries.push_back({std::string(key.str()), placer(key.source()), convert(value, placer)});
        }
        node.value = std::move(entries);
    } else if (const toml::array* array = source.as_array()) {
        std::vector<Node> nodes;
        for (const toml::node& element : *array) {
            nodes.push_back(convert(element, placer));
        }
        node.value = std::move(nodes);
    } else if (source.is_boolean()) {
        node.value = source.as_boolean()->get();
    } else if (source.is_integer()) {
        node.value = source.as_integer()->get();
    } else if (source.is_floating_point()) {
        node.value = source.as_floating_point()->get();
    } else if (source.is_string()) {
        node.value = source.as_string()->get();
    }
    return node;
}

// The same for dotted keys, whose depth toml++ does not limit. Dots of strings and comments count, too, which
// is the reason for the generous limit.
void check_depth(std::string_view text, const std::string& place) {
    constexpr int most_dots = 250;
    int dots = 0;
    for (const char character : text) {
        if (std::string_view("\n,=[]{}").find(character) != std::string_view::npos) {
            dots = 0;
        } else if (character == '.' && ++dots > most_dots) {
            refuse(place, fmt::format("more than {} dots in a row", most_dots), "keys of at most two parts");
        }
    }
}

bool is_bare_word(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char character) {
        return std::isalnum(character) != 0 ||
               std::string_view("_./+- ").find(static_cast<char>(character)) != std::string_view::npos;
    });
}

} // namespace

Node parse_document(std::string_view text, const std::string& file) {
    const Placer placer = [&](const toml::source_region& region) {
        return fmt::format("{}:{}:{}", file, std::max(region.begin.line, 1U),
                           std::max(region.begin.column, 1U));
    };
    check_depth(text, file);
    try {
        return convert(toml::parse(text), placer);
    } catch (const toml::parse_error& error) {
        refuse(placer(error.source()), fmt::format("no TOML ({})", printable(error.description())),
               "TOML 1.0, see `slurry help scene`");
    }
}

Node parse_override_value(std::string_view text, const std::string& place) {
    const Placer placer = [&](const toml::source_region&) { return place; };
    check_depth(text, place);
    try {
        const toml::table table = toml::parse(fmt::format("value = {}", text));
        if (table.size() == 1) {
            return convert(*table.get("value"), placer);
        }
    } catch (const toml::parse_error&) {
        if (is_bare_word(text)) {
            return {place, std::string(text)};
        }
    }
    refuse(place, fmt::format("the value {}", printable(text)), "one TOML value, or a bare word");
}

const Entry* find(const NodeTable& table, std::string_view key) {
    const auto entry = std::ranges::find(table, key, &Entry::key);
    return entry == table.end() ? nullptr : &*entry;
}

Entry* find(NodeTable& table, std::string_view key) {
    const auto entry = std::ranges::find(table, key, &Entry::key);
    return entry == table.end() ? nullptr : &*entry;
}

std::string describe(const Node& node) {
    struct Describer {
        std::string operator()(Node::Date) const { return "a date or time"; }
        std::string operator()(bool value) const { return fmt::format("the boolean {}", value); }
        std::string operator()(std::int64_t value) const { return fmt::format("the integer {}", value); }
        std::string operator()(double value) const { return fmt::format("the number {}", value); }
        std::string operator()(const std::string& value) const {
            return fmt::format("the string \"{}\"", printable(value));
        }
        std::string operator()(const std::vector<Node>& value) const {
            return fmt::format("an array of {}", value.size());
        }
        std::string operator()(const NodeTable&) const { return "a table"; }
    };
    return std::visit(Describer{}, node.value);
}

} // namespace slurry
