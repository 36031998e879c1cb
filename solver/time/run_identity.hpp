#pragma once
// What has to be the same for a run to go on from a checkpoint to the same bits.
#include "solver/scene/scene.hpp"

#include <string>

namespace slurry {

[[nodiscard]] std::string program_version();

struct RunIdentity {
    std::string version;    // of the program
    std::string arithmetic; // precision of the pair sums, lanes, compiler
    std::string scene;      // resolved
    std::string files;      // checksum of what the scene's files hold
};

// Of a run of the scene by this program.
[[nodiscard]] RunIdentity run_identity(const Scene& scene);

// The first difference in words, "numerics.sound_speed = 20.0, here 10.0"; empty when there is none. How
// often checkpoints are written makes none.
[[nodiscard]] std::string difference(const RunIdentity& there, const RunIdentity& here);

} // namespace slurry
