#include "solver/converge/study.hpp"

#include "solver/converge/spacings.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "solver/geometry/region.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/scene/read_scene.hpp"
#include "solver/time/checkpoint_folder.hpp"
#include "solver/time/interruption.hpp"
#include "solver/time/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace slurry {
namespace {

constexpr int fewest_probe_samples = 40; // enough of them in the steady part for a mean and its noise
constexpr int fewest_series_samples = 100;
constexpr double stiffening = 2;

// The error of a sound speed c goes like 1 / c^2; so much of the difference to `stiffening` c is all of it.
constexpr double whole_of_difference = stiffening * stiffening / (stiffening * stiffening - 1);

// The scene as the study runs it; what is wrong with a coarse one is known before the first run.
Scene scene_at(const SceneReader& read, double spacing, double sound_speed_factor) {
    const auto place = [&](const std::exception& error) {
        return fmt::format(
            "at {:.4g} m, the study's coarser spacings being multiples of the scene's: {}; choose a "
            "smaller --spacing",
            spacing, error.what());
    };
    try {
        std::vector<std::string> overrides{fmt::format("numerics.particle_spacing={:.10e}", spacing)};
        const Scene as_written = read(overrides);
        if (as_written.output.probe_samples < fewest_probe_samples) {
            overrides.push_back(fmt::format("output.probe_samples={}", fewest_probe_samples));
        }
        if (as_written.output.series_samples < fewest_series_samples) {
            overrides.push_back(fmt::format("output.series_samples={}", fewest_series_samples));
        }
        overrides.push_back(fmt::format("numerics.sound_speed={:.10e}",
                                        sound_speed_factor * as_written.numerics.sound_speed));
        Scene scene = read(overrides);
        static_cast<void>(Region(scene));
        return scene;
    } catch (const GeometryError& error) {
        throw GeometryError(place(error));
    } catch (const SceneError& error) {
        throw SceneError(place(error));
    }
}

// The checkpoint of an interrupted run of this very scene; empty where there is none.
std::filesystem::path interrupted_run(const std::filesystem::path& folder, const Scene& scene) {
    if (!std::filesystem::exists(folder / "checkpoint.h5")) {
        return {};
    }
    const std::filesystem::path found = find_checkpoint(folder).path;
    return is_file_of(found, scene) ? found : std::filesystem::path();
}

StudyRun run_one(Scene scene, const StudyOptions& options, const std::string& which) {
    const double spacing = scene.numerics.particle_spacing;
    const std::filesystem::path folder = options.folder / which;
    if (const auto result = folder / "result.h5"; options.reuse && is_file_of(result, scene)) {
        return {scene, read_run(result, scene)};
    }
    if (!options.quiet) {
        fmt::print(std::cout, "spacing {:.4g} m, sound speed {:.4g} m/s\n", spacing,
                   scene.numerics.sound_speed);
    }
    try {
        const RunSummary summary = run_scene(
            scene, {.folder = folder,
                    .threads = options.threads,
                    .quiet = options.quiet,
                    .resume_from = options.reuse ? interrupted_run(folder, scene) : std::filesystem::path(),
                    .go_on = options.go_on});
        return {scene, read_run(summary.result, scene)};
    } catch (const RunError& error) {
        throw RunError(fmt::format("at the study's spacing of {:.4g} m: {}", spacing, error.what()));
    }
}

using Quantities = std::vector<const Quantity*>; // the same one of every run

// The latest time from which on every run is steady; NaN when one is not.
double common_start(const Quantities& runs) {
    double latest = 0;
    for (const Quantity* run : runs) {
        const double from = steady_from(run->time, run->value);
        if (std::isnan(from)) {
            return from;
        }
        latest = std::max(latest, from);
    }
    return latest;
}

bool finite(const Reading& reading) {
    return std::isfinite(reading.value) && std::isfinite(reading.noise);
}

void judge_sound_speed(Assessment& quantity) {
    if (!quantity.stiffer) {
        return;
    }
    const GridValue& same_spacing = quantity.values[quantity.values.size() - 2];
    const double difference = quantity.stiffer->value - same_spacing.value;
    quantity.sound_speed_band = safety * whole_of_difference * std::abs(difference);
    if (std::abs(difference) > standard_errors * std::hypot(quantity.stiffer->noise, same_spacing.noise)) {
        quantity.sound_speed_shift = whole_of_difference * difference;
    }
}

std::optional<Assessment> assess_one(const Study& study, std::size_t index) {
    Quantities runs;
    for (const StudyRun& run : study.runs) {
        runs.push_back(&run.stored.quantities[index]);
    }
    if (study.stiffer) {
        runs.push_back(&study.stiffer->stored.quantities[index]);
    }
    const double start = common_start(runs);
    const bool mean = !std::isnan(start);
    Assessment found{.place = runs[0]->place,
                     .name = runs[0]->name,
                     .unit = runs[0]->unit,
                     .kind = runs[0]->kind,
                     .mean = mean,
                     .from_time = mean ? start : runs[0]->time.back(),
                     .values = {},
                     .stiffer = {},
                     .scale = 0,
                     .spacing = {},
                     .sound_speed_band = 0,
                     .sound_speed_shift = 0};
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const Reading reading = mean ? mean_from(runs[k]->time, runs[k]->value, start)
                                     : final_value(runs[k]->time, runs[k]->value);
        if (!finite(reading)) {
            return {};
        }
        if (k < study.runs.size()) {
            found.values.push_back(
                {study.runs[k].scene.numerics.particle_spacing, reading.value, reading.noise});
        } else {
            found.stiffer = reading;
        }
    }
    found.spacing = estimate_error(found.values);
    judge_sound_speed(found);
    return found;
}

// A pressure far below every shear says nothing about the flow; elsewhere a kind has its own scale.
bool scales(Kind of, Kind by) {
    return of == by || (of == Kind::pressure && by == Kind::shear);
}

} // namespace

void assess(Study& study) {
    const auto& names = study.runs.front().stored.quantities;
    for (std::size_t index = 0; index < names.size(); ++index) {
        if (std::optional<Assessment> found = assess_one(study, index)) {
            study.quantities.push_back(std::move(*found));
        } else {
            study.unreadable.push_back(names[index].place + " " + names[index].name);
        }
    }
    for (Assessment& quantity : study.quantities) {
        for (const Assessment& other : study.quantities) {
            if (scales(quantity.kind, other.kind)) {
                quantity.scale = std::max(quantity.scale, std::abs(other.finest()));
            }
        }
    }
}

Study run_study(const SceneReader& read, const StudyOptions& options) {
    const Scene wanted = read({});
    const std::vector<double> spacings =
        study_spacings(wanted.domain, wanted.numerics.particle_spacing, options.spacings);
    const std::string adapted = adaptation(wanted.domain, wanted.numerics.particle_spacing, spacings.back());
    if (!options.quiet && !adapted.empty()) {
        fmt::print(std::cout, "{}\n", adapted);
    }
    std::vector<Scene> scenes;
    scenes.reserve(spacings.size());
    for (const double spacing : spacings) {
        scenes.push_back(scene_at(read, spacing, 1));
    }
    std::optional<Scene> stiffer;
    if (options.vary_sound_speed) {
        stiffer = scene_at(read, spacings[spacings.size() - 2], stiffening);
    }
    const Interruption between_runs_too;
    Study study;
    study.asked_spacing = wanted.numerics.particle_spacing;
    for (Scene& scene : scenes) {
        const std::string folder = fmt::format("{:.4g}", scene.numerics.particle_spacing);
        study.runs.push_back(run_one(std::move(scene), options, folder));
    }
    if (stiffer) {
        study.stiffer = run_one(std::move(*stiffer), options, "twice_the_sound_speed");
    }
    assess(study);
    return study;
}

} // namespace slurry
