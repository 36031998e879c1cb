#include "solver/scene/overrides.hpp"

#include "solver/scene/parameters.hpp"
#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slurry {
namespace {

struct Override {
    std::string place;
    std::vector<std::string> path;
    std::string value;
};

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    return begin == std::string_view::npos
               ? ""
               : std::string(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
}

Override split(const std::string& text) {
    Override result{fmt::format("--set {}", printable(text)), {}, {}};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        refuse(result.place, "no '='", "table.key=value");
    }
    result.value = trimmed(std::string_view(text).substr(equals + 1));
    std::string rest = trimmed(std::string_view(text).substr(0, equals));
    for (std::size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
        result.path.push_back(rest.substr(0, dot));
        rest.erase(0, dot + 1);
    }
    result.path.push_back(rest);
    return result;
}

// The declared key that the override sets; what a wrong one is refused with.
const Parameter& declared(const Override& change) {
    const std::string path = fmt::format("{}", fmt::join(change.path, "."));
    const Section* section = find_section(change.path.front());
    if (section != nullptr && change.path.size() == (section->repeated() ? 3U : 2U)) {
        if (const Parameter* parameter = find_parameter(section->name, change.path.back())) {
            return *parameter;
        }
    }
    std::string nearest_path;
    if (section == nullptr) {
        std::vector<std::string> addresses;
        for (const Parameter& parameter : parameters()) {
            addresses.push_back(parameter.address());
        }
        nearest_path = nearest(path, addresses);
    } else {
        nearest_path = nearest_address(section->name, change.path.size() == 1 ? "" : change.path.back());
    }
    const Section* meant = find_section(nearest_path.substr(0, nearest_path.find('.')));
    if (meant->repeated()) {
        const std::string name =
            meant == section && change.path.size() == 3 ? printable(change.path[1]) : "NAME";
        nearest_path.insert(nearest_path.find('.'), "." + name);
    }
    refuse(change.place, fmt::format("the unknown path {}", printable(path)),
           "table.key=value, or in walls, discs and probes table.NAME.key=value", nearest_path);
}

Entry& find_or_add(NodeTable& table, const std::string& key, const Override& change) {
    if (Entry* entry = find(table, key)) {
        return *entry;
    }
    table.push_back({key, change.place, {change.place, NodeTable{}}});
    return table.back();
}

const std::string* name_of(const Node& element) {
    const auto* table = std::get_if<NodeTable>(&element.value);
    const Entry* name = table == nullptr ? nullptr : find(*table, "name");
    return name == nullptr ? nullptr : std::get_if<std::string>(&name->node.value);
}

// The table of an array that has the name which the override asks for.
NodeTable& named_table(NodeTable& document, const Override& change) {
    std::vector<std::string> names;
    if (Entry* section = find(document, change.path[0])) {
        for (Node& element : std::get<std::vector<Node>>(section->node.value)) {
            const std::string* name = name_of(element);
            if (name != nullptr && *name == change.path[1]) {
                return std::get<NodeTable>(element.value);
            }
            if (name != nullptr) {
                names.push_back(printable(*name));
            }
        }
    }
    const std::string meant = nearest(change.path[1], names);
    refuse(change.place, fmt::format("no \"{}\" in {}", printable(change.path[1]), change.path[0]),
           names.empty() ? "none: the scene has no such tables" : fmt::format("{}", fmt::join(names, ", ")),
           meant.empty() ? "" : fmt::format("{}.{}.{}", change.path[0], meant, change.path[2]));
}

const Section& declared_section(const Entry& entry) {
    if (const Section* section = find_section(entry.key)) {
        return *section;
    }
    std::vector<std::string> names;
    std::ranges::transform(sections(), std::back_inserter(names),
                           [](const Section& known) { return std::string(known.name); });
    refuse(entry.place, fmt::format("the unknown table [{}]", printable(entry.key)),
           fmt::format("{}", fmt::join(names, ", ")), nearest(entry.key, names));
}

} // namespace

void apply_override(Node& document, const std::string& text) {
    const Override change = split(text);
    const Parameter& parameter = declared(change);
    auto& root = std::get<NodeTable>(document.value);
    NodeTable& table = change.path.size() == 3
                           ? named_table(root, change)
                           : std::get<NodeTable>(find_or_add(root, change.path[0], change).node.value);
    Entry& entry = find_or_add(table, std::string(parameter.key), change);
    entry.place = change.place;
    entry.node = parse_override_value(change.value, change.place);
}

void check_structure(const Node& document) {
    for (const Entry& entry : std::get<NodeTable>(document.value)) {
        const Section& section = declared_section(entry);
        const auto* array = std::get_if<std::vector<Node>>(&entry.node.value);
        const auto is_table = [](const Node& node) { return std::holds_alternative<NodeTable>(node.value); };
        const bool fits = section.repeated() ? array != nullptr && std::ranges::all_of(*array, is_table)
                                             : is_table(entry.node);
        if (!fits) {
            refuse(entry.place, fmt::format("{} = {}", entry.key, describe(entry.node)),
                   fmt::format("{} {}", section.repeated() ? "tables" : "one table", section.heading()));
        }
    }
}

} // namespace slurry
