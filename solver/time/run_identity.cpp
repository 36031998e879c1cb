#include "solver/time/run_identity.hpp"

#include "solver/loop/pack.hpp"
#include "solver/scene/refusal.hpp"

#include <fmt/format.h>
#include <version.hpp>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <type_traits>

namespace slurry {
namespace {

using Values = std::map<std::string, std::string>;

// A resolved scene by keys, "walls.pad.velocity": the name is the first key of a table that there are several
// of. Any text will do: that of a checkpoint may be damaged.
Values values_of(const std::string& resolved) {
    Values values;
    std::istringstream stream(resolved);
    std::string table;
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("[")) {
            const std::size_t begin = std::min(line.find_first_not_of('['), line.size());
            table = line.substr(begin, line.find(']') - begin);
        } else if (const auto equals = line.find(" = "); equals != std::string::npos) {
            const std::string key = line.substr(0, equals);
            const std::string value = line.substr(equals + 3);
            if (key == "name" && value.size() > 1) {
                table += fmt::format(".{}", value.substr(1, value.size() - 2));
            }
            values[fmt::format("{}.{}", table, key)] = value;
        }
    }
    values.erase("output.checkpoint_interval");
    return values;
}

std::string scene_difference(const Values& there, const Values& here) {
    for (const auto& [key, value] : there) {
        const auto found = here.find(key);
        if (found == here.end()) {
            return fmt::format("{} = {}, here it is not", printable(key), printable(value));
        }
        if (found->second != value) {
            return fmt::format("{} = {}, here {}", key, printable(value), found->second);
        }
    }
    const auto added =
        std::ranges::find_if(here, [&](const auto& entry) { return !there.contains(entry.first); });
    return added == here.end() ? "" : fmt::format("no {}, here {}", added->first, added->second);
}

template <class T> uLong add_to(uLong checksum, const std::vector<T>& values) {
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, Vector>);
    return crc32_z(checksum, reinterpret_cast<const Bytef*>(values.data()), values.size() * sizeof(T));
}

std::string checksum_of_files(const Scene& scene) {
    uLong checksum = crc32_z(0, nullptr, 0);
    for (const WallScene& wall : scene.walls) {
        if (const auto* profile = std::get_if<ProfileShape>(&wall.shape)) {
            checksum = add_to(checksum, profile->points);
        }
    }
    for (const DiscScene& discs : scene.discs) {
        if (const auto* random = std::get_if<RandomDiscs>(&discs.placement)) {
            checksum = add_to(checksum, random->radii);
        }
    }
    return fmt::format("{:08x}", checksum);
}

} // namespace

std::string program_version() {
    return SLURRY_VERSION;
}

RunIdentity run_identity(const Scene& scene) {
    const bool wide = scene.numerics.pair_arithmetic == PairArithmetic::single_precision;
    return {program_version(),
            fmt::format("{} in {} lanes, compiler {}", wide ? "float" : "double",
                        wide ? native_lanes<float> : native_lanes<double>, __VERSION__),
            scene.resolved_text, checksum_of_files(scene)};
}

std::string difference(const RunIdentity& there, const RunIdentity& here) {
    if (there.version != here.version) {
        return fmt::format("slurry {}, here {}", printable(there.version), here.version);
    }
    if (std::string found = scene_difference(values_of(there.scene), values_of(here.scene)); !found.empty()) {
        return found;
    }
    if (there.arithmetic != here.arithmetic) {
        return fmt::format("arithmetic of {}, here {}", printable(there.arithmetic), here.arithmetic);
    }
    return there.files == here.files ? "" : "other numbers in the CSV files that the scene names";
}

} // namespace slurry
