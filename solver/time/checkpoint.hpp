#pragma once
// The whole state of a run in a file: what decides the bits of every later number, and what was recorded.
#include "solver/discs/contact.hpp"
#include "solver/loop/interactions.hpp"
#include "solver/output/hdf5_reader.hpp"
#include "solver/output/partial_file.hpp"
#include "solver/output/phase_clock.hpp"
#include "solver/output/result_file.hpp"
#include "solver/particles/particles.hpp"
#include "solver/time/run_identity.hpp"

namespace slurry {

// A run between two steps.
struct RunState {
    long& step; // the last one taken
    Particles& particles;
    Interactions& interactions;
    DiscContacts& contacts;
    ResultFile& result;
    PhaseClock& clock;
};

// Fills the file, and seals it. Throws OutputError.
void write_checkpoint(PartialFile& file, const RunIdentity& identity, const RunState& state,
                      const std::filesystem::path& scene);

// Takes a run that was set up from the same scene, and has taken no step, to where the checkpoint is. Throws
// ReadError when it is of another scene, version or precision, or damaged.
void read_checkpoint(const std::filesystem::path& path, const RunIdentity& identity, const RunState& state);

// The scene of a checkpoint; files that it names are read again. Throws ReadError, SceneError.
[[nodiscard]] Scene read_checkpoint_scene(const std::filesystem::path& path,
                                          std::span<const std::string> overrides, const Limits& limits = {});

} // namespace slurry
