#pragma once
// The declared parameters of a scene: the one table that reading, overrides, the resolved text and the manual
// use. To add a key: give the struct in scene.hpp a member, and the table in parameters.cpp one row.
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace slurry {

enum class Kind : std::uint8_t { boolean, integer, number, text, file, choice, vector, counts, numbers };

// A value of any kind as the scene file has it: choices and files are strings, vectors, counts and lists are
// numbers.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

// What a value may be. The interval holds for each number of a vector, pair or list.
struct Allowed {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_excluded = false;
    bool identifier =
        false; // letters, digits, _ and - only: names are used in overrides and in the result file
    std::vector<std::string_view> choices{};

    [[nodiscard]] bool contains(double number) const; // false for NaN and infinities
    [[nodiscard]] std::string text() const;           // "> 0", "0 to 1", "\"a\" or \"b\"", "" for anything
};

// The value of a key that a scene leaves out; none at all when the scene has to say it.
struct Default {
    std::optional<Value> standard;
    std::optional<Value> wang2014;

    Default() = default;
    template <class T> Default(T value) : standard(std::in_place, std::move(value)), wang2014(standard) {}
    template <class T> static Default by_scheme(T standard, T wang2014) {
        Default value(std::move(standard));
        value.wang2014.emplace(std::move(wang2014));
        return value;
    }
    [[nodiscard]] const std::optional<Value>& of(Scheme scheme) const {
        return scheme == Scheme::wang2014 ? wang2014 : standard;
    }
};

// Access to the member of a scene that holds a key. The index is that of the wall, disc or probe, and
// unused elsewhere. A choice is its position among the choices here.
struct Binding {
    Kind kind;
    std::function<Value(const Scene&, std::size_t)> get;
    std::function<void(Scene&, std::size_t, const Value&)> set;
};

struct Parameter {
    std::string_view section;
    std::string_view variant; // the shape, placement or kind that has this key, empty when all have
    std::string_view key;
    Binding binding;
    std::string_view unit; // SI, empty for none
    Default fallback;
    Allowed allowed;
    std::string_view meaning;

    [[nodiscard]] Value get(const Scene& scene, std::size_t index) const;
    void set(Scene& scene, std::size_t index, const Value& value) const;
    [[nodiscard]] std::string address() const; // section.key
    // Type, range and unit in words: "a number > 0 (m)".
    [[nodiscard]] std::string allowed_text() const;
    [[nodiscard]] bool belongs_to(std::string_view chosen) const {
        return variant.empty() || variant == chosen;
    }
};

struct Section {
    std::string_view name;
    std::string_view selector; // the key whose choice says which other keys there are, empty for none
    std::size_t (*count)(const Scene&);
    void (*append)(Scene&); // null unless the section is an array of tables
    std::string_view meaning;

    [[nodiscard]] bool repeated() const { return append != nullptr; }
    [[nodiscard]] std::string heading() const; // [name] or [[name]]
    // The value of the selector of one table, empty when the section has none.
    [[nodiscard]] std::string chosen(const Scene& scene, std::size_t index) const;
};

// In the order of reading: a selector and the scheme come before what depends on them.
[[nodiscard]] const std::vector<Section>& sections();
[[nodiscard]] const std::vector<Parameter>& parameters();

[[nodiscard]] const Section* find_section(std::string_view name);
// The parameters of a section, in the table's order.
[[nodiscard]] std::vector<const Parameter*> parameters_of(std::string_view section);
// The parameter of that key, whatever its variant unless one is given; null when there is none.
[[nodiscard]] const Parameter* find_parameter(std::string_view section, std::string_view key,
                                              std::string_view chosen = {});
// The known section.key that an unknown one most likely meant; a key of the same section is preferred.
[[nodiscard]] std::string nearest_address(std::string_view section, std::string_view key,
                                          std::string_view chosen = {});

// A value as TOML.
[[nodiscard]] std::string to_toml(const Value& value, Kind kind);

} // namespace slurry
