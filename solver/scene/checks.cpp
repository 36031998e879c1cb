#include "solver/scene/checks.hpp"

#include "solver/scene/disc_checks.hpp"
#include "solver/scene/refusal.hpp"
#include "solver/scene/stability_checks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace slurry {
namespace {

constexpr double fewest_spacings = 3; // across the domain

std::string text_of(const Vector& vector) {
    return fmt::format("[{}, {}]", vector.x(), vector.y());
}

std::vector<std::string> wall_names(const Scene& scene) {
    std::vector<std::string> names;
    std::ranges::transform(scene.walls, std::back_inserter(names), &WallScene::name);
    return names;
}

void check_domain(const Scene& scene, const Places& places) {
    const Vector size = scene.domain.size();
    if (!(size.minCoeff() > 0)) {
        refuse(places.of("domain.upper"),
               fmt::format("domain.upper = {} with domain.lower = {}", text_of(scene.domain.upper),
                           text_of(scene.domain.lower)),
               "lower < upper in x and in y");
    }
    const double spacing = scene.numerics.particle_spacing;
    if (!(size.minCoeff() >= fewest_spacings * spacing)) {
        refuse(places.of("numerics.particle_spacing"), fmt::format("numerics.particle_spacing = {}", spacing),
               fmt::format("at most {:.4g} (m): 3 particles across the domain",
                           size.minCoeff() / fewest_spacings));
    }
    const double particles = (size.x() / spacing) * (size.y() / spacing);
    if (!(particles <= scene.limits.particles)) {
        refuse(places.of("numerics.particle_spacing"),
               fmt::format("numerics.particle_spacing = {}, about {:.3g} particles", spacing, particles),
               fmt::format("a spacing of {:.4g} (m) or more, particles {}",
                           std::sqrt(size.x() / scene.limits.particles) * std::sqrt(size.y()) * 1.0001,
                           limit_text(scene.limits, &Limits::particles, particles)));
    }
}

void check_start(const Scene& scene, const Places& places) {
    const Start& start = scene.start;
    if (start.arrangement == Arrangement::empty && scene.discs.empty()) {
        refuse(places.of("start.arrangement"), R"("empty" in a scene without discs)",
               R"(fluid ("lattice", "jittered", "relaxed"), or discs in [[discs]])");
    }
    if (start.arrangement == Arrangement::empty && start.velocity != InitialVelocity::rest) {
        refuse(places.of("start.velocity"), R"(a start velocity with start.arrangement = "empty")",
               R"("rest": there is no fluid; discs have a velocity of their own)");
    }
    if ((start.velocity == InitialVelocity::rest) != (start.speed == 0)) {
        refuse(places.of("start.speed"), fmt::format("start.speed = {}", start.speed),
               start.velocity == InitialVelocity::rest
                   ? R"(0 with start.velocity = "rest"; for another speed "shear" or "taylor_green")"
                   : R"(any other speed; 0 only with start.velocity = "rest")");
    }
}

void check_gravity(const Scene& scene, const Places& places) {
    for (const int axis : {0, 1}) {
        if (scene.domain.periodic[static_cast<std::size_t>(axis)] && scene.fluid.gravity[axis] != 0) {
            const char name = axis == 0 ? 'x' : 'y';
            refuse(places.of("fluid.gravity"),
                   fmt::format("fluid.gravity = {} in a domain that is periodic along {}",
                               text_of(scene.fluid.gravity), name),
                   fmt::format(
                       "0 along {}, where nothing ends the fall; fluid.body_force drives a periodic flow",
                       name));
        }
    }
}

void check_wall(const WallScene& wall, const Places& places) {
    const auto* line = std::get_if<LineShape>(&wall.shape);
    if (line != nullptr && line->from == line->to) {
        refuse(places.of("walls." + wall.name + ".to"),
               fmt::format("a line from {0} to {0}", text_of(line->to)), "two different ends");
    }
    const bool upright = line != nullptr && line->from.x() == line->to.x();
    const bool sideways = wall.fluid_side == FluidSide::left || wall.fluid_side == FluidSide::right;
    if (upright != sideways) {
        refuse(places.of("walls." + wall.name + ".fluid_side"), "a fluid_side that does not fit the shape",
               upright ? R"("left" or "right" of a vertical line)"
                       : R"("above" or "below" of what is no vertical line)");
    }
}

void check_probe(const ProbeScene& probe, const Scene& scene, const Places& places) {
    const std::vector<std::string> names = wall_names(scene);
    const auto* along = std::get_if<WallProbe>(&probe.kind);
    if (along != nullptr && std::ranges::find(names, along->wall) == names.end()) {
        refuse(places.of("probes." + probe.name + ".wall"),
               fmt::format("the unknown wall \"{}\"", printable(along->wall)),
               names.empty() ? "none: the scene has no walls" : fmt::format("{}", fmt::join(names, ", ")),
               nearest(along->wall, names));
    }
    const auto* point = std::get_if<PointProbe>(&probe.kind);
    if (point != nullptr && ((point->position.array() < scene.domain.lower.array()).any() ||
                             (point->position.array() > scene.domain.upper.array()).any())) {
        refuse(places.of("probes." + probe.name + ".position"),
               fmt::format("position = {}", text_of(point->position)),
               fmt::format("{} to {}, the domain", text_of(scene.domain.lower), text_of(scene.domain.upper)));
    }
}

template <class Named>
void check_unique(const std::vector<Named>& tables, const std::string& section, const Places& places) {
    std::set<std::string> seen;
    for (const Named& table : tables) {
        if (!seen.insert(table.name).second) {
            refuse(places.of(section + "." + table.name + ".name"),
                   fmt::format("the name \"{}\" twice in [[{}]]", table.name, section), "unique names");
        }
    }
}

void check_times(const Output& output, const Places& places) {
    double previous = -1;
    for (const double time : output.snapshot_times) {
        if (!(time > previous && time <= output.end_time)) {
            refuse(places.of("output.snapshot_times"),
                   previous < 0 ? fmt::format("{}", time) : fmt::format("{} after {}", time, previous),
                   fmt::format("ascending times up to output.end_time = {} (s)", output.end_time));
        }
        previous = time;
    }
}

double values_per_sample(const ProbeScene& probe) {
    struct Counter {
        double operator()(const WallProbe& wall) const { return 2.0 * wall.points; }
        double operator()(const PointProbe& /*point*/) const { return 0; }
        double operator()(const GridProbe& grid) const { return 3.0 * grid.points[0] * grid.points[1]; }
    };
    return std::visit(Counter{}, probe.kind);
}

void check_sizes(const Scene& scene, const Places& places) {
    const Output& output = scene.output;
    double values = 0;
    for (const ProbeScene& probe : scene.probes) {
        const bool point = std::holds_alternative<PointProbe>(probe.kind);
        values += point ? 3.0 * output.series_samples : values_per_sample(probe) * output.probe_samples;
        if (!(values <= scene.limits.probe_values)) {
            refuse(places.of("probes." + probe.name + ".points"),
                   fmt::format("{:.3g} probe values, points times samples of all probes", values),
                   limit_text(scene.limits, &Limits::probe_values, values));
        }
    }
    const Vector cells = scene.domain.size() / scene.numerics.particle_spacing;
    const double written = cells.prod() * static_cast<double>(output.snapshot_times.size() + 1);
    if (!(written <= scene.limits.snapshot_particles)) {
        refuse(places.of("output.snapshot_times"),
               fmt::format("snapshots of {:.3g} particles in all", written),
               limit_text(scene.limits, &Limits::snapshot_particles, written));
    }
}

} // namespace

const std::string& Places::of(std::string address) const {
    for (auto place = places_.find(address); !address.empty(); place = places_.find(address)) {
        if (place != places_.end()) {
            return place->second;
        }
        address.resize(address.find('.') == std::string::npos ? 0 : address.rfind('.'));
    }
    return places_.at("");
}

void check_scene(const Scene& scene, const Places& places) {
    check_unique(scene.walls, "walls", places);
    check_unique(scene.discs, "discs", places);
    check_unique(scene.probes, "probes", places);
    check_domain(scene, places);
    check_start(scene, places);
    check_gravity(scene, places);
    for (const WallScene& wall : scene.walls) {
        check_wall(wall, places);
    }
    check_discs(scene, places);
    for (const ProbeScene& probe : scene.probes) {
        check_probe(probe, scene, places);
    }
    check_times(scene.output, places);
    check_sizes(scene, places);
    check_stability(scene, places);
}

} // namespace slurry
