#include "solver/scene/conversion.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace slurry {
namespace {

constexpr std::size_t longest_text = 1000;
constexpr std::size_t longest_list = 10'000;

// Converts one node; everything that is not as declared ends in fail().
class Converter {
  public:
    Converter(const Parameter& parameter, const Node& node, const std::string& address)
        : parameter_(parameter), node_(node), address_(address) {}

    [[nodiscard]] Value value() const {
        switch (parameter_.binding.kind) {
        case Kind::boolean:
            return get<bool>();
        case Kind::integer:
            return integer();
        case Kind::number:
            return number(node_, false);
        case Kind::text:
        case Kind::file:
        case Kind::choice:
            return text();
        case Kind::vector:
            return numbers(2, 2, false);
        case Kind::counts:
            return numbers(2, 2, true);
        case Kind::numbers:
            return numbers(0, longest_list, false);
        }
        fail(describe(node_));
    }

  private:
    [[noreturn]] void fail(const std::string& found) const {
        const bool word =
            parameter_.binding.kind == Kind::choice && std::holds_alternative<std::string>(node_.value);
        refuse(node_.place, fmt::format("{} = {}", address_, found), parameter_.allowed_text(),
               word ? nearest(std::get<std::string>(node_.value),
                              {parameter_.allowed.choices.begin(), parameter_.allowed.choices.end()})
                    : "");
    }

    template <class T> [[nodiscard]] const T& get() const {
        const T* value = std::get_if<T>(&node_.value);
        return value != nullptr ? *value : (fail(describe(node_)), *value);
    }

    [[nodiscard]] std::int64_t integer() const {
        const auto value = get<std::int64_t>();
        if (!parameter_.allowed.contains(static_cast<double>(value))) {
            fail(describe(node_));
        }
        return value;
    }

    [[nodiscard]] double number(const Node& node, bool whole) const {
        const auto* integer = std::get_if<std::int64_t>(&node.value);
        const auto* real = whole ? nullptr : std::get_if<double>(&node.value);
        const double value = integer != nullptr ? static_cast<double>(*integer)
                             : real != nullptr  ? *real
                                                : std::nan("");
        if (!parameter_.allowed.contains(value)) {
            fail(describe(node));
        }
        return value;
    }

    [[nodiscard]] Value numbers(std::size_t fewest, std::size_t most, bool whole) const {
        const auto& nodes = get<std::vector<Node>>();
        if (nodes.size() < fewest || nodes.size() > most) {
            fail(describe(node_));
        }
        std::vector<double> values;
        std::ranges::transform(nodes, std::back_inserter(values),
                               [&](const Node& node) { return number(node, whole); });
        return values;
    }

    [[nodiscard]] std::string text() const {
        const auto& value = get<std::string>();
        const auto control = [](unsigned char character) { return character < 0x20 || character == 0x7F; };
        const auto plain = [](unsigned char character) {
            return std::isalnum(character) != 0 || character == '_' || character == '-';
        };
        const Allowed& allowed = parameter_.allowed;
        const bool fits = value.size() <= longest_text && std::ranges::none_of(value, control) &&
                          (!allowed.identifier || (!value.empty() && std::ranges::all_of(value, plain))) &&
                          (allowed.choices.empty() || std::ranges::count(allowed.choices, value) == 1);
        if (!fits) {
            fail(describe(node_));
        }
        return value;
    }

    const Parameter& parameter_;
    const Node& node_;
    const std::string& address_;
};

} // namespace

Value to_value(const Parameter& parameter, const Node& node, const std::string& address) {
    return Converter(parameter, node, address).value();
}

} // namespace slurry
