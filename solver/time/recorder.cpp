#include "solver/time/recorder.hpp"

#include "solver/probes/grid_probe.hpp"
#include "solver/probes/point_probe.hpp"
#include "solver/probes/totals.hpp"
#include "solver/probes/wall_probe.hpp"
#include "solver/terms/particle_volume.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace slurry {

namespace {

// The values in the order of the start, which sorting during the run does not change.
std::vector<double> by_identity(const FluidParticles& fluid, const std::vector<double>& values) {
    std::vector<double> ordered(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        ordered[fluid.identity[i]] = values[i];
    }
    return ordered;
}

void wrap(std::vector<double>& positions, double lower, double upper) {
    for (double& position : positions) {
        position -= std::floor((position - lower) / (upper - lower)) * (upper - lower);
    }
}

std::vector<double> wrapped(const FluidParticles& fluid, const Domain& domain, int axis) {
    std::vector<double> positions = by_identity(fluid, axis == 0 ? fluid.x : fluid.y);
    if (domain.periodic[static_cast<std::size_t>(axis)]) {
        wrap(positions, domain.lower[axis], domain.upper[axis]);
    }
    return positions;
}

// The fluid in the order of the start, positions wrapped into the domain.
struct OrderedFluid {
    std::vector<double> x, y, velocity_x, velocity_y, pressure;

    OrderedFluid(const FluidParticles& fluid, const Domain& domain)
        : x(wrapped(fluid, domain, 0)), y(wrapped(fluid, domain, 1)),
          velocity_x(by_identity(fluid, fluid.velocity_x)), velocity_y(by_identity(fluid, fluid.velocity_y)),
          pressure(by_identity(fluid, fluid.pressure)) {}
    [[nodiscard]] FluidView view() const { return {x, y, velocity_x, velocity_y, pressure}; }
};

// Steps at `samples` evenly spaced times up to the end, the start included if wanted.
std::vector<bool> evenly_due(long steps, int samples, bool from_start) {
    std::vector<bool> due(static_cast<std::size_t>(steps) + 1, false);
    const int intervals = from_start ? std::max(1, samples - 1) : samples;
    for (int k = from_start ? 0 : 1; k <= intervals; ++k) {
        due[static_cast<std::size_t>(std::lround(static_cast<double>(steps) * k / intervals))] = true;
    }
    return due;
}

} // namespace

Recorder::Recorder(const Scene& scene, const Region& region, ResultFile& file, long steps, double time_step)
    : scene_(scene), region_(region), file_(file),
      series_due_(evenly_due(steps, scene.output.series_samples, true)),
      probes_due_(evenly_due(steps, scene.output.probe_samples, false)),
      snapshot_due_(static_cast<std::size_t>(steps) + 1, false) {
    for (const double time : scene.output.snapshot_times) {
        const long step = std::min(steps, std::lround(time / time_step));
        snapshot_due_[static_cast<std::size_t>(step)] = true;
    }
    snapshot_due_.back() = true;
    begin_probes();
}

void Recorder::begin_probes() {
    for (const ProbeScene& probe : scene_.probes) {
        if (const auto* on_wall = std::get_if<WallProbe>(&probe.kind)) {
            const auto wall =
                std::find_if(region_.walls().begin(), region_.walls().end(),
                             [&](const Wall& candidate) { return candidate.name() == on_wall->wall; });
            WallSamples samples{&probe, &*wall, wall->sample(on_wall->points)};
            std::vector<double> arc_length, x, y;
            for (const WallPoint& point : samples.points) {
                arc_length.push_back(point.arc_length);
                x.push_back(point.position.x());
                y.push_back(point.position.y());
            }
            file_.add_probe_constant(probe.name, "arc_length", "m", arc_length);
            file_.add_probe_constant(probe.name, "x", "m", x);
            file_.add_probe_constant(probe.name, "y", "m", y);
            walls_.push_back(std::move(samples));
        } else if (const auto* grid = std::get_if<GridProbe>(&probe.kind)) {
            const GridAxes axes = grid_axes(scene_.domain, grid->points);
            file_.add_probe_constant(probe.name, "x", "m", axes.x);
            file_.add_probe_constant(probe.name, "y", "m", axes.y);
        }
    }
}

void Recorder::record(const Particles& particles, long step) {
    const auto index = static_cast<std::size_t>(step);
    if (series_due_[index]) {
        record_series(particles);
    }
    if (probes_due_[index]) {
        record_walls_and_grids(particles);
    }
    if (snapshot_due_[index]) {
        record_snapshot(particles);
    }
}

void Recorder::record_series(const Particles& particles) {
    const FluidParticles& fluid = particles.fluid;
    const Totals totals =
        fluid_totals(by_identity(fluid, fluid.velocity_x), by_identity(fluid, fluid.velocity_y),
                     by_identity(fluid, fluid.density), fluid.mass, scene_.fluid.density);
    file_.begin_sample(particles.time);
    file_.add_sample("kinetic_energy", "J/m", totals.kinetic_energy);
    file_.add_sample("momentum_x", "kg/s", totals.momentum.x());
    file_.add_sample("momentum_y", "kg/s", totals.momentum.y());
    file_.add_sample("mean_density", "kg/m3", totals.mean_density);
    file_.add_sample("largest_speed", "m/s", totals.largest_speed);
    file_.add_sample("largest_density_error", "1", totals.largest_density_error);
    record_discs(particles);
    const auto is_point = [](const ProbeScene& probe) {
        return std::holds_alternative<PointProbe>(probe.kind);
    };
    if (std::ranges::any_of(scene_.probes, is_point)) {
        record_points(particles);
    }
}

void Recorder::record_points(const Particles& particles) {
    const OrderedFluid fluid(particles.fluid, scene_.domain);
    const ParticleFinder finder(fluid.view(), scene_.domain, scene_.numerics.particle_spacing);
    for (const ProbeScene& probe : scene_.probes) {
        if (const auto* point = std::get_if<PointProbe>(&probe.kind)) {
            const PointValues values =
                probe_point(finder, region_, point->position, particles.time, particles.discs);
            file_.begin_probe_sample(probe.name, particles.time);
            file_.add_probe_row(probe.name, "pressure", "Pa", std::span(&values.pressure, 1));
            file_.add_probe_row(probe.name, "velocity_x", "m/s", std::span(&values.velocity_x, 1));
            file_.add_probe_row(probe.name, "velocity_y", "m/s", std::span(&values.velocity_y, 1));
        }
    }
}

void Recorder::record_discs(const Particles& particles) {
    if (particles.discs.empty()) {
        return;
    }
    const auto row_of = [&](auto&& quantity) {
        std::vector<double> row;
        for (const Disc& disc : particles.discs) {
            row.push_back(quantity(disc));
        }
        return row;
    };
    const auto add = [&](const char* name, const char* unit, auto&& quantity) {
        file_.add_disc_row(name, unit, row_of(quantity));
    };
    const auto add_constant = [&](const char* name, const char* unit, auto&& quantity) {
        file_.add_disc_constant(name, unit, row_of(quantity));
    };
    if (particles.time == 0) {
        add_constant("radius", "m", [](const Disc& disc) { return disc.radius; });
        add_constant("mass", "kg/m", [](const Disc& disc) { return disc.mass; });
        add_constant("moment_of_inertia", "kg m", [](const Disc& disc) { return disc.moment_of_inertia; });
        add_constant("density", "kg/m3", [](const Disc& disc) { return disc.mass / disc.area(); });
        std::vector<std::string> names;
        std::ranges::transform(particles.discs, std::back_inserter(names), &Disc::name);
        file_.name_discs(names);
    }
    file_.begin_disc_sample(particles.time);
    add("position_x", "m", [](const Disc& disc) { return disc.position.x(); });
    add("position_y", "m", [](const Disc& disc) { return disc.position.y(); });
    add("angle", "rad", [](const Disc& disc) { return disc.angle; });
    add("velocity_x", "m/s", [](const Disc& disc) { return disc.velocity.x(); });
    add("velocity_y", "m/s", [](const Disc& disc) { return disc.velocity.y(); });
    add("spin", "rad/s", [](const Disc& disc) { return disc.spin; });
    add("force_x", "N/m", [](const Disc& disc) { return disc.force.x(); });
    add("force_y", "N/m", [](const Disc& disc) { return disc.force.y(); });
    add("torque", "N", [](const Disc& disc) { return disc.torque; });
    add("contact_force_x", "N/m", [](const Disc& disc) { return disc.contact_force.x(); });
    add("contact_force_y", "N/m", [](const Disc& disc) { return disc.contact_force.y(); });
}

void Recorder::record_walls_and_grids(const Particles& particles) {
    const OrderedFluid fluid(particles.fluid, scene_.domain);
    const ParticleFinder finder(fluid.view(), scene_.domain, scene_.numerics.particle_spacing);
    for (const WallSamples& samples : walls_) {
        const WallValues values =
            probe_wall(finder, *samples.wall, samples.points, particles.time, scene_.fluid.dynamic_viscosity);
        file_.begin_probe_sample(samples.probe->name, particles.time);
        file_.add_probe_row(samples.probe->name, "pressure", "Pa", values.pressure);
        file_.add_probe_row(samples.probe->name, "shear", "Pa", values.shear);
    }
    for (const ProbeScene& probe : scene_.probes) {
        if (const auto* grid = std::get_if<GridProbe>(&probe.kind)) {
            const GridValues values = probe_grid(finder, region_, grid_axes(scene_.domain, grid->points),
                                                 particles.time, particles.discs);
            file_.begin_probe_sample(probe.name, particles.time);
            file_.add_probe_row(probe.name, "pressure", "Pa", values.pressure);
            file_.add_probe_row(probe.name, "velocity_x", "m/s", values.velocity_x);
            file_.add_probe_row(probe.name, "velocity_y", "m/s", values.velocity_y);
        }
    }
}

// One quantity at a time: a copy of all would be a good part of the run's memory.
void Recorder::record_snapshot(const Particles& particles) {
    const FluidParticles& fluid = particles.fluid;
    const DummyParticles& dummies = particles.dummies;
    file_.begin_snapshot(particles.time, fluid.size() + dummies.size());
    const auto add = [&](const char* quantity, const char* unit, std::vector<double> of_fluid,
                         const std::vector<double>& of_dummies) {
        of_fluid.insert(of_fluid.end(), of_dummies.begin(), of_dummies.end());
        file_.add_to_snapshot(quantity, unit, of_fluid);
    };
    add("position_x", "m", wrapped(fluid, scene_.domain, 0), dummies.x);
    add("position_y", "m", wrapped(fluid, scene_.domain, 1), dummies.y);
    add("velocity_x", "m/s", by_identity(fluid, fluid.velocity_x), dummies.velocity_x);
    add("velocity_y", "m/s", by_identity(fluid, fluid.velocity_y), dummies.velocity_y);
    add("density", "kg/m3", by_identity(fluid, fluid.density),
        std::vector<double>(dummies.size(), scene_.fluid.density));
    add("pressure", "Pa", by_identity(fluid, fluid.pressure), dummies.pressure);
    std::vector<double> volumes(fluid.size());
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        volumes[fluid.identity[i]] =
            particle_volume(fluid, i, scene_.numerics.particle_volume, scene_.fluid.density);
    }
    add("volume", "m2", std::move(volumes), dummies.volume);
    std::vector<int> wall(fluid.size(), -1); // index of the wall that a dummy belongs to
    wall.insert(wall.end(), dummies.wall.begin(), dummies.wall.end());
    file_.add_to_snapshot("wall", "1", wall);
    file_.end_snapshot();
}

} // namespace slurry
