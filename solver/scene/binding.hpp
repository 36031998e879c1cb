#pragma once
// Makes the Binding of a member of a scene from a pointer to it, whatever its type.
#include "solver/scene/parameters.hpp"

#include <concepts>
#include <type_traits>

namespace slurry {

template <class T, class Variant> inline constexpr bool is_alternative = false;
template <class T, class... Alternatives>
inline constexpr bool is_alternative<T, std::variant<Alternatives...>> = (std::is_same_v<T, Alternatives> ||
                                                                          ...);

// The part of a scene that is of type Part.
template <class Part, class AnyScene> auto& part_of(AnyScene& scene, [[maybe_unused]] std::size_t index) {
    if constexpr (std::is_same_v<Part, Scene>) {
        return scene;
    } else if constexpr (std::is_same_v<Part, Domain>) {
        return scene.domain;
    } else if constexpr (std::is_same_v<Part, Fluid>) {
        return scene.fluid;
    } else if constexpr (std::is_same_v<Part, Numerics>) {
        return scene.numerics;
    } else if constexpr (std::is_same_v<Part, Start>) {
        return scene.start;
    } else if constexpr (std::is_same_v<Part, Output>) {
        return scene.output;
    } else if constexpr (std::is_same_v<Part, WallScene>) {
        return scene.walls[index];
    } else if constexpr (std::is_same_v<Part, DiscScene>) {
        return scene.discs[index];
    } else if constexpr (std::is_same_v<Part, Contact>) {
        return scene.contact;
    } else if constexpr (std::is_same_v<Part, ProbeScene>) {
        return scene.probes[index];
    } else if constexpr (is_alternative<Part, Shape>) {
        return std::get<Part>(scene.walls[index].shape);
    } else if constexpr (is_alternative<Part, decltype(DiscScene::placement)>) {
        return std::get<Part>(scene.discs[index].placement);
    } else {
        return std::get<Part>(scene.probes[index].kind);
    }
}

// How a type of member is read and written as a Value.
template <class T> struct Conversion;

template <> struct Conversion<bool> {
    static constexpr Kind kind = Kind::boolean;
    static Value get(bool member) { return member; }
    static void set(bool& member, const Value& value) { member = std::get<bool>(value); }
};

template <std::integral T> struct Conversion<T> {
    static constexpr Kind kind = Kind::integer;
    static Value get(T member) { return static_cast<std::int64_t>(member); }
    static void set(T& member, const Value& value) { member = static_cast<T>(std::get<std::int64_t>(value)); }
};

template <> struct Conversion<double> {
    static constexpr Kind kind = Kind::number;
    static Value get(double member) { return member; }
    static void set(double& member, const Value& value) { member = std::get<double>(value); }
};

template <> struct Conversion<std::string> {
    static constexpr Kind kind = Kind::text;
    static Value get(const std::string& member) { return member; }
    static void set(std::string& member, const Value& value) { member = std::get<std::string>(value); }
};

template <> struct Conversion<std::filesystem::path> {
    static constexpr Kind kind = Kind::file;
    static Value get(const std::filesystem::path& member) { return member.string(); }
    static void set(std::filesystem::path& member, const Value& value) {
        member = std::get<std::string>(value);
    }
};

template <> struct Conversion<Vector> {
    static constexpr Kind kind = Kind::vector;
    static Value get(const Vector& member) { return std::vector{member.x(), member.y()}; }
    static void set(Vector& member, const Value& value) {
        const auto& numbers = std::get<std::vector<double>>(value);
        member = Vector(numbers.at(0), numbers.at(1));
    }
};

template <> struct Conversion<std::array<int, 2>> {
    static constexpr Kind kind = Kind::counts;
    static Value get(const std::array<int, 2>& member) {
        return std::vector<double>{static_cast<double>(member[0]), static_cast<double>(member[1])};
    }
    static void set(std::array<int, 2>& member, const Value& value) {
        const auto& numbers = std::get<std::vector<double>>(value);
        member = {static_cast<int>(numbers.at(0)), static_cast<int>(numbers.at(1))};
    }
};

template <> struct Conversion<std::vector<double>> {
    static constexpr Kind kind = Kind::numbers;
    static Value get(const std::vector<double>& member) { return member; }
    static void set(std::vector<double>& member, const Value& value) {
        member = std::get<std::vector<double>>(value);
    }
};

// Choices, as positions: an enumeration in its order, the alternatives of a variant, periodic axes as two
// bits.
template <class T>
requires std::is_enum_v<T>
struct Conversion<T> {
    static constexpr Kind kind = Kind::choice;
    static Value get(T member) { return static_cast<std::int64_t>(member); }
    static void set(T& member, const Value& value) { member = static_cast<T>(std::get<std::int64_t>(value)); }
};

template <> struct Conversion<std::array<bool, 2>> {
    static constexpr Kind kind = Kind::choice;
    static Value get(const std::array<bool, 2>& member) {
        return std::int64_t{member[0] ? 1 : 0} + std::int64_t{member[1] ? 2 : 0};
    }
    static void set(std::array<bool, 2>& member, const Value& value) {
        const auto bits = static_cast<std::uint64_t>(std::get<std::int64_t>(value));
        member = {(bits & 1U) != 0, (bits & 2U) != 0};
    }
};

template <class... Alternatives> struct Conversion<std::variant<Alternatives...>> {
    using Member = std::variant<Alternatives...>;
    static constexpr Kind kind = Kind::choice;
    static Value get(const Member& member) { return static_cast<std::int64_t>(member.index()); }
    static void set(Member& member, const Value& value) {
        std::int64_t position = std::get<std::int64_t>(value);
        ((position-- == 0 ? static_cast<void>(member.template emplace<Alternatives>())
                          : static_cast<void>(0)),
         ...);
    }
};

template <class Part, class T> Binding member(T Part::*pointer) {
    return {Conversion<T>::kind,
            [pointer](const Scene& scene, std::size_t index) {
                return Conversion<T>::get(part_of<Part>(scene, index).*pointer);
            },
            [pointer](Scene& scene, std::size_t index, const Value& value) {
                Conversion<T>::set(part_of<Part>(scene, index).*pointer, value);
            }};
}

} // namespace slurry
