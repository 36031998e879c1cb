#include "solver/scene/document.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <functional>

// toml++ takes a level of stack for each level of nesting; a scene needs three. Its assertions abort on
// faulty keys that it reports properly without them.
#define TOML_MAX_NESTED_VALUES 8
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

namespace slurry {
namespace {

// Names the place of a line and column.
using Placer = std::function<std::string(std::size_t line, std::size_t column)>;

Node convert(const toml::node& source, const Placer& placer) {
    const auto place = [&](const toml::source_region& region) {
        return placer(region.begin.line, region.begin.column);
    };
    Node node{place(source.source()), Node::Date{}};
    if (const toml::table* table = source.as_table()) {
        NodeTable entries;
        for (const auto& [key, value] : *table) {
            entries.push_back({std::string(key.str()), place(key.source()), convert(value, placer)});
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

// Refuses what toml++ 3.3 does not survive: characters beyond ASCII outside strings and comments (undefined
// behaviour) and dotted keys of any depth (the stack). Strings of several lines are refused to keep strings
// easy to recognise.
void check_lexically(std::string_view text, const Placer& placer) {
    constexpr int most_dots = 16;
    std::size_t line = 1;
    std::size_t line_begin = 0;
    int dots = 0;
    char until = '\0'; // the end of the string or comment that we are in
    for (std::size_t i = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < text.size(); ++i) {
        const char character = text[i];
        if (character == '\n') {
            ++line;
            line_begin = i + 1;
            dots = 0;
            until = '\0';
        } else if (until != '\0') {
            i += until == '"' && character == '\\' ? 1 : 0;
            until = character == until ? '\0' : until;
        } else if (character == '#') {
            until = '\n';
        } else if (character == '"' || character == '\'') {
            until = character;
            if (text.substr(i, 3) == std::string(3, character)) {
                refuse(placer(line, i + 1 - line_begin), "a string of several lines", "strings of one line");
            }
        } else if (static_cast<unsigned char>(character) >= 0x80) {
            refuse(placer(line, i + 1 - line_begin), "a character beyond ASCII",
                   "those in strings and comments");
        } else if (std::string_view(",=[]{}").find(character) != std::string_view::npos) {
            dots = 0;
        } else if (character == '.' && ++dots > most_dots) {
            refuse(placer(line, i + 1 - line_begin), "a key of many parts", "keys of at most two");
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
    const Placer placer = [&](std::size_t line, std::size_t column) {
        return fmt::format("{}:{}:{}", file, std::max<std::size_t>(line, 1),
                           std::max<std::size_t>(column, 1));
    };
    check_lexically(text, placer);
    try {
        return convert(toml::parse(text), placer);
    } catch (const toml::parse_error& error) {
        refuse(placer(error.source().begin.line, error.source().begin.column),
               fmt::format("no TOML ({})", printable(error.description())),
               "TOML 1.0, see `slurry help scene`");
    }
}

Node parse_override_value(std::string_view text, const std::string& place) {
    const Placer placer = [&](std::size_t, std::size_t) { return place; };
    check_lexically(text, placer);
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
