#include "solver/scene/read_scene.hpp"

#include "solver/scene/checks.hpp"
#include "solver/scene/conversion.hpp"
#include "solver/scene/disc_checks.hpp"
#include "solver/scene/document.hpp"
#include "solver/scene/overrides.hpp"
#include "solver/scene/profile.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/scene/resolved.hpp"
#include "solver/scene/stability_checks.hpp"
#include "solver/scene/wall_checks.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slurry {
namespace {

constexpr std::size_t largest_scene = std::size_t{1} << 20U;

// Fills a scene from a document, table by table in the order of sections().
class Reader {
  public:
    Reader(const Node& document, Places& places) : document_(document), places_(places) {
        places_.add("", document.place);
    }

    [[nodiscard]] Scene read() {
        const Node absent{document_.place, NodeTable{}};
        for (const Section& section : sections()) {
            const Entry* entry = find(std::get<NodeTable>(document_.value), section.name);
            if (!section.repeated()) {
                read_table(section, entry == nullptr ? absent : entry->node, 0);
            } else if (entry != nullptr) {
                for (const Node& table : std::get<std::vector<Node>>(entry->node.value)) {
                    section.append(scene_);
                    read_table(section, table, section.count(scene_) - 1);
                }
            }
        }
        return std::move(scene_);
    }

  private:
    void read_table(const Section& section, const Node& node, std::size_t index) {
        const auto& table = std::get<NodeTable>(node.value);
        const std::string chosen = selected(section, table);
        check_keys(section, table, chosen);
        std::string prefix(section.name);
        for (const Parameter* parameter : parameters_of(section.name)) {
            if (!parameter->belongs_to(chosen)) {
                continue;
            }
            read_key(*parameter, node, index, fmt::format("{}.{}", prefix, parameter->key));
            if (section.repeated() && parameter->key == "name") {
                prefix = fmt::format("{}.{}", prefix, std::get<std::string>(parameter->get(scene_, index)));
                places_.add(prefix + ".name", find(table, "name")->node.place);
            }
        }
        places_.add(prefix, node.place);
    }

    // The choice that decides which keys a table has, empty when there is none or it is not there.
    static std::string selected(const Section& section, const NodeTable& table) {
        const Entry* entry = section.selector.empty() ? nullptr : find(table, section.selector);
        if (entry == nullptr) {
            return {};
        }
        const std::string address = fmt::format("{}.{}", section.name, section.selector);
        return std::get<std::string>(
            to_value(*find_parameter(section.name, section.selector), entry->node, address));
    }

    static void check_keys(const Section& section, const NodeTable& table, const std::string& chosen) {
        for (const Entry& entry : table) {
            if (find_parameter(section.name, entry.key, chosen) != nullptr) {
                continue;
            }
            std::vector<std::string_view> keys;
            for (const Parameter* parameter : parameters_of(section.name)) {
                if (parameter->belongs_to(chosen)) {
                    keys.push_back(parameter->key);
                }
            }
            refuse(
                entry.place,
                fmt::format("the unknown key {} in [{}]{}", printable(entry.key), section.name,
                            chosen.empty() ? "" : fmt::format(" with {} = \"{}\"", section.selector, chosen)),
                fmt::format("{}", fmt::join(keys, ", ")), nearest_address(section.name, entry.key, chosen));
        }
    }

    void read_key(const Parameter& parameter, const Node& table, std::size_t index,
                  const std::string& address) {
        if (const Entry* entry = find(std::get<NodeTable>(table.value), parameter.key)) {
            parameter.set(scene_, index, to_value(parameter, entry->node, address));
            places_.add(address, entry->node.place);
        } else if (const std::optional<Value>& fallback = parameter.fallback.of(scene_.scheme)) {
            parameter.set(scene_, index, *fallback);
        } else {
            refuse(table.place, fmt::format("no {}", address),
                   fmt::format("{}: it has no default", parameter.allowed_text()));
        }
    }

    const Node& document_;
    Places& places_;
    Scene scene_;
};

// Absolute with links followed, as far as it exists; empty when that cannot be found out. weakly_canonical on
// its own leaves a relative path relative where nothing of it exists.
std::filesystem::path links_followed(const std::filesystem::path& path) {
    std::error_code error;
    const auto absolute = std::filesystem::absolute(path, error);
    return error ? std::filesystem::path() : std::filesystem::weakly_canonical(absolute, error);
}

// Whether a path is in the folder or below, links followed.
bool is_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
    const auto base = links_followed(folder.empty() ? "." : folder);
    return !base.empty() && std::ranges::mismatch(base, links_followed(file)).in1 == base.end();
}

// The file as this process finds it: paths are relative to the scene's folder and may not leave it, not even
// by a link, because a scene may come from somebody else; an absolute path is one that its user can see.
std::filesystem::path located(const std::filesystem::path& file, const Scene& scene,
                              const std::string& place) {
    std::filesystem::path normal = file.lexically_normal();
    if (file.is_relative() && (normal.empty() || *normal.begin() == "..")) {
        refuse(place, fmt::format("the file \"{}\"", printable(file.string())),
               "a file in the scene's folder or below, or an absolute path");
    }
    if (file.is_absolute()) {
        return normal;
    }
    std::filesystem::path path = scene.path.parent_path() / normal;
    if (!is_in(path, scene.path.parent_path())) {
        refuse(place,
               fmt::format("the file \"{}\", a link out of the scene's folder", printable(file.string())),
               "a file in the scene's folder or below, or an absolute path");
    }
    return path;
}

void load_files(Scene& scene, const Places& places) {
    for (WallScene& wall : scene.walls) {
        if (auto* profile = std::get_if<ProfileShape>(&wall.shape)) {
            const std::string& place = places.of("walls." + wall.name + ".file");
            profile->file = located(profile->file, scene, place);
            profile->points = read_profile(profile->file, place);
        }
    }
    for (DiscScene& discs : scene.discs) {
        auto* random = std::get_if<RandomDiscs>(&discs.placement);
        if (random != nullptr && random->sizes == SizeDistribution::file) {
            const std::string& place = places.of("discs." + discs.name + ".file");
            random->file = located(random->file, scene, place);
            random->radii = read_radii(random->file, place);
        }
    }
}

} // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& path,
                  std::span<const std::string> overrides, const Limits& limits) {
    Node document = parse_document(text, printable_path(path));
    check_structure(document);
    for (const std::string& change : overrides) {
        apply_override(document, change);
    }
    Places places;
    Scene scene = Reader(document, places).read();
    scene.path = path;
    scene.limits = limits;
    check_scene(scene, places);
    scene.resolved_text = resolved_text(scene); // before paths are made relative to this process
    load_files(scene, places);
    scene.warnings = check_wall_shapes(scene, places);
    std::ranges::move(check_disc_sizes(scene, places), std::back_inserter(scene.warnings));
    std::ranges::move(check_cell_reynolds(scene, places), std::back_inserter(scene.warnings));
    return scene;
}

Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides,
                 const Limits& limits) {
    return parse_scene(read_bounded_file(path, largest_scene, printable_path(path)), path, overrides, limits);
}

} // namespace slurry
