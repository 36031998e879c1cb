#pragma once
// A TOML document as a tree in which everything knows where it was written. Keeps toml++ inside document.cpp.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace slurry {

struct Entry;
using NodeTable = std::vector<Entry>;

struct Node {
    struct Date {};    // dates and times: TOML has them, scenes do not
    std::string place; // for messages: file:line:column, or the override
    std::variant<Date, bool, std::int64_t, double, std::string, std::vector<Node>, NodeTable> value;
};

struct Entry {
    std::string key;
    std::string place; // of the key
    Node node;
};

// Throws SceneError at the place of a syntax error. The root's value is a NodeTable.
[[nodiscard]] Node parse_document(std::string_view text, const std::string& file);

// The value of an override: TOML, or a bare word (letters, digits, space and _ . / + -) as a string. Throws
// SceneError.
[[nodiscard]] Node parse_override_value(std::string_view text, const std::string& place);

// The entry of a table, null when there is none.
[[nodiscard]] const Entry* find(const NodeTable& table, std::string_view key);
[[nodiscard]] Entry* find(NodeTable& table, std::string_view key);

// What a node holds, in the words of a message: `the string "water"`, `the number 3.5`, `an array of 3`.
[[nodiscard]] std::string describe(const Node& node);

} // namespace slurry
