#include "solver/time/start_warnings.hpp"

#include "solver/scene/refusal.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <optional>

namespace slurry {
namespace {

constexpr double rounding = 1e-9;              // relative
constexpr double enough_spacings_per_film = 3; // as between walls, where fewer are refused

// The first time of a sample, s, at which no wall covers the place; none when all are covered.
std::optional<double> free_from(const Scene& scene, const Region& region, const Vector& place) {
    const int intervals = std::max(1, scene.output.series_samples - 1);
    for (int k = 0; k <= intervals; ++k) {
        const double time = scene.output.end_time * k / intervals;
        if (region.distance(place, time) > 0) {
            return time;
        }
    }
    return std::nullopt;
}

void warn_of_covered_probe(const Scene& scene, const Region& region, const ProbeScene& probe,
                           std::vector<std::string>& warnings) {
    const auto* point = std::get_if<PointProbe>(&probe.kind);
    if (point == nullptr) {
        return;
    }
    const auto wall = std::ranges::find_if(region.walls(), [&](const Wall& candidate) {
        return !(candidate.nearest(point->position).distance > 0);
    });
    if (wall == region.walls().end()) {
        return;
    }
    const std::optional<double> free = free_from(scene, region, point->position);
    warnings.push_back(fmt::format(
        "{}: probe '{}' at ({:.4g}, {:.4g}) m is behind wall '{}' at the start: its samples will be NaN{}",
        printable_path(scene.path), probe.name, point->position.x(), point->position.y(), wall->name(),
        free ? fmt::format(" until {:.4g} s", *free) : "; move it into the fluid"));
}

// A disc may start near one wall: abrasives pass closely, and one that starts a spacing from a wall runs
// well. From less, or with too little room on two sides, the film squeezes single particles out.
void warn_of_thin_films(const Scene& scene, const Region& region, const DiscScene& disc,
                        std::vector<std::string>& warnings) {
    const auto* single = std::get_if<SingleDisc>(&disc.placement);
    if (single == nullptr || scene.start.arrangement == Arrangement::empty) {
        return;
    }
    const double spacing = scene.numerics.particle_spacing;
    std::vector<std::string> thin;
    bool too_thin = false;
    for (const Wall& wall : region.walls()) {
        const double film = std::max(0.0, wall.nearest(single->position).distance - single->radius);
        if (film >= enough_spacings_per_film * spacing * (1 - rounding)) {
            continue;
        }
        too_thin = too_thin || film < spacing * (1 - rounding);
        thin.push_back(fmt::format(
            "{}: the film between disc '{}' and wall '{}' is {:.4g} m at the start, {:.2g} particle "
            "spacings: "
            "advised {:g} or more, so {}a disc that is smaller or farther from the wall",
            printable_path(scene.path), disc.name, wall.name(), film, film / spacing,
            enough_spacings_per_film,
            film > 0
                ? fmt::format("particle_spacing of at most {:.4g} m, or ", film / enough_spacings_per_film)
                : ""));
    }
    if (too_thin || thin.size() > 1) {
        std::ranges::move(thin, std::back_inserter(warnings));
    }
}

} // namespace

std::vector<std::string> start_warnings(const Scene& scene, const Region& region) {
    std::vector<std::string> warnings;
    for (const ProbeScene& probe : scene.probes) {
        warn_of_covered_probe(scene, region, probe, warnings);
    }
    for (const DiscScene& disc : scene.discs) {
        warn_of_thin_films(scene, region, disc, warnings);
    }
    return warnings;
}

} // namespace slurry
