#pragma once
// A whole run: from a scene to its result file.
#include "solver/scene/scene.hpp"

#include <filesystem>
#include <string>

namespace slurry {

struct RunOptions {
    std::filesystem::path folder;
    int threads = 1;
    bool quiet = false;
    bool overwrite = true;
    std::filesystem::path resume_from = {}; // a checkpoint in the folder; empty: from the start
    std::string go_on = {}; // the command that goes on after an interruption; empty: slurry run --resume
};

struct RunSummary {
    std::filesystem::path result;
    long steps = 0;
};

// Runs the scene and writes result.h5 and result.xdmf into the folder; a state that goes wrong into
// failed.h5. Throws SceneError (steps beyond the limits), GeometryError, OutputError, ReadError, RunError,
// RunInterrupted.
RunSummary run_scene(const Scene& scene, const RunOptions& options);

// What `slurry info` prints: particles, steps, what limits them, and which terms run and why. Throws
// SceneError (steps beyond the limits), GeometryError.
std::string describe_scene(const Scene& scene);

} // namespace slurry
