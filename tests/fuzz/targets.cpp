#include "tests/fuzz/targets.hpp"

#include "solver/scene/profile.hpp"
#include "solver/scene/read_scene.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>

namespace slurry::fuzz {
namespace {

// Files that scenes of the corpus name are here, seen from the repository's root.
const std::string scene_file = "tests/fuzz/corpus/scene.toml";
const std::string folder = "tests/fuzz/corpus/";

void demand(bool holds, const std::string& what) {
    if (!holds) {
        throw std::logic_error(what);
    }
}

std::string read_back(const Scene& scene) {
    try {
        return parse_scene(scene.resolved_text, scene_file).resolved_text;
    } catch (const SceneError& error) {
        return std::string("refused: ") + error.what();
    }
}

template <class Read> void try_reading(const Read& read) {
    try {
        read();
    } catch (const SceneError& error) {
        demand_reason(error.what());
    }
}

} // namespace

void demand_reason(const std::string& message) {
    demand(message.find('\n') == std::string::npos, "a refusal of several lines: " + message);
    demand(message.starts_with(folder), "a refusal without its file: " + message);
    const std::size_t colon = message.find(':');
    demand(colon != std::string::npos && std::isdigit(static_cast<unsigned char>(message[colon + 1])) != 0,
           "a refusal without its line: " + message);
    demand(message.find(": found ") != std::string::npos && message.find(", allowed ") != std::string::npos,
           "a refusal without its reason: " + message);
}

void try_scene(std::string_view text) {
    try_reading([&] {
        const Scene scene = parse_scene(text, scene_file);
        demand(read_back(scene) == scene.resolved_text, "not read back as it was:\n" + scene.resolved_text);
    });
}

void try_profile(std::string_view text) {
    const std::string name = folder + "profile.csv";
    const std::string place = scene_file + ":1:1";
    try_reading([&] {
        double previous = -HUGE_VAL;
        for (const Vector& point : parse_profile(text, name, place)) {
            demand(point.allFinite() && point.x() > previous, "a profile that does not ascend");
            previous = point.x();
        }
    });
    try_reading([&] {
        demand(std::ranges::all_of(parse_radii(text, name, place),
                                   [](double radius) { return std::isfinite(radius) && radius > 0; }),
               "a radius that is none");
    });
}

} // namespace slurry::fuzz
