#pragma once
// The checkpoints of a run in its folder: the last two, so that there is always a good one.
#include "solver/output/phase_clock.hpp"
#include "solver/time/checkpoint.hpp"

#include <filesystem>
#include <string>

namespace slurry {

// The newest good checkpoint in a folder.
struct FoundCheckpoint {
    std::filesystem::path path;
    std::string warning; // why an earlier one was taken; empty if it was not
};
// Throws ReadError when there is none, and says why each is not good, or that the run is complete.
[[nodiscard]] FoundCheckpoint find_checkpoint(const std::filesystem::path& folder);

class CheckpointFolder {
  public:
    // `interval`: wall time between checkpoints, s; 0: none is due by itself. `resumed_from`: the checkpoint
    // that the run goes on from, empty for a run from the start.
    CheckpointFolder(const std::filesystem::path& folder, double interval, std::filesystem::path resumed_from,
                     SecondsSource now = steady_seconds);

    // Whether the interval has passed since the last checkpoint, or the last call that said so.
    [[nodiscard]] bool due();
    // Keeps the one before, too. Throws OutputError; what was there is then left as it was.
    void write(const RunIdentity& identity, const RunState& state, const std::filesystem::path& scene);
    // The last good one; empty when there is none.
    [[nodiscard]] const std::filesystem::path& newest() const { return newest_; }
    // Whether there are checkpoints of an earlier run, which this one will replace.
    [[nodiscard]] bool has_foreign() const;
    // The run has ended well.
    void remove() const;

  private:
    std::filesystem::path current_, previous_, newest_;
    double interval_;
    SecondsSource now_;
    double last_;
};

} // namespace slurry
