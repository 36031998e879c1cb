#pragma once
// A convergence study: one scene at several spacings, and at one of them with twice the sound speed.
#include "solver/converge/estimate.hpp"
#include "solver/converge/steadiness.hpp"
#include "solver/converge/stored_run.hpp"
#include "solver/scene/scene.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace slurry {

struct StudyOptions {
    std::filesystem::path folder;
    int spacings = 3;
    int threads = 1;
    bool quiet = false;
    bool vary_sound_speed = true;
    bool reuse = false;     // runs of the same scenes that the folder holds already, whole or interrupted
    std::string go_on = {}; // as RunOptions::go_on
};

struct StudyRun {
    Scene scene;
    StoredRun stored;
};

// One quantity over all runs.
struct Assessment {
    std::string place, name, unit;
    Kind kind;
    bool mean;                      // of the samples from from_time to the end, else the last sample
    double from_time;               // s
    std::vector<GridValue> values;  // coarsest first
    std::optional<Reading> stiffer; // with twice the sound speed, at the spacing of values[size - 2]
    double scale;                   // largest magnitude of its kind, in the unit
    Estimate spacing;               // what the spacings tell
    double sound_speed_band;        // in the unit; 0 when the sound speed was not varied
    double sound_speed_shift;       // to an infinite sound speed, added to the extrapolated value

    // In the unit, about the value at the finest spacing; NaN when diverging.
    [[nodiscard]] double band() const { return spacing.band() + sound_speed_band; }
    [[nodiscard]] double finest() const { return values.back().value; }
    // To spacing 0 and an infinite sound speed; NaN unless converging.
    [[nodiscard]] double extrapolated() const { return spacing.extrapolated + sound_speed_shift; }
};

struct Study {
    double asked_spacing = 0;   // m; that of the last run may differ (adaptation())
    std::vector<StudyRun> runs; // coarsest first
    std::optional<StudyRun> stiffer;
    std::vector<Assessment> quantities;
    std::vector<std::string> unreadable; // "place name": not a number somewhere
};

// The scene file with overrides, read again for each run.
using SceneReader = std::function<Scene(const std::vector<std::string>& overrides)>;

// Runs the scene at the spacings that study_spacings() finds, all of them checked before the first starts,
// into folders of options.folder. Throws what run_scene throws, with the spacing, and SceneError.
[[nodiscard]] Study run_study(const SceneReader& read, const StudyOptions& options);

// What the runs tell, without running anything.
void assess(Study& study);

} // namespace slurry
