#pragma once
// The reader of checkpoints, tried like those of targets.hpp.
#include "tests/fuzz/checkpoint_edits.hpp"
#include "tests/solver/time/resumable_run.hpp"

#include <string_view>

namespace slurry::fuzz {

// A run with a good checkpoint, which each try damages another way. Throws std::logic_error, or lets through
// what should never be thrown, when what has to hold does not.
class CheckpointTarget {
  public:
    CheckpointTarget();

    // The first byte of the input says how its rest is taken:
    // - as bytes that change, or a shorter length: the seal has to notice;
    // - as edits of what is in the file: its scene, or its state, is refused in one line that names the file;
    //   or the state is taken, and then the next step ends well or is stopped by the watchdog.
    void operator()(std::string_view input);

  private:
    void try_bytes(Bytes bytes);
    void try_edits(Bytes bytes, void (CheckpointTarget::*read)());
    void read_scene();
    void read_and_step();

    testing::OwnFolder folder_;
    std::filesystem::path path_ = folder_.path() / "checkpoint.h5";
    testing::ResumableRun run_;
    RunIdentity identity_;
    std::string good_; // bytes of the checkpoint
    StoredNames names_;
};

} // namespace slurry::fuzz
