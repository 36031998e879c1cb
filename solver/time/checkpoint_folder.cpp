#include "solver/time/checkpoint_folder.hpp"

#include "solver/output/seal.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace slurry {
namespace {

std::filesystem::path current_in(const std::filesystem::path& folder) {
    return folder / "checkpoint.h5";
}
std::filesystem::path previous_in(const std::filesystem::path& folder) {
    return folder / "checkpoint.previous.h5";
}

// Why there is no checkpoint of this name to go on from; empty if there is.
std::string fault_of(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        return fmt::format("{}: is not there", path.string());
    }
    try {
        const std::string fault = seal_fault(path);
        return fault.empty() ? "" : fmt::format("{}: {}", path.string(), fault);
    } catch (const OutputError& unreadable) {
        return unreadable.what();
    }
}

// Whether a run in this folder came to its end: a result gets its name when it is whole, and what a run that
// was killed leaves of its own has another.
bool holds_result(const std::filesystem::path& folder) {
    std::error_code error;
    return std::filesystem::exists(folder / "result.h5", error) &&
           !std::filesystem::exists(folder / "result.h5.partial", error);
}

} // namespace

FoundCheckpoint find_checkpoint(const std::filesystem::path& folder) {
    const std::string fault = fault_of(current_in(folder));
    if (fault.empty()) {
        return {current_in(folder), ""};
    }
    const std::string fault_before = fault_of(previous_in(folder));
    if (fault_before.empty()) {
        return {previous_in(folder), fmt::format("{}; going on from the one before", fault)};
    }
    if (std::error_code error; !std::filesystem::exists(current_in(folder), error) &&
                               !std::filesystem::exists(previous_in(folder), error) && holds_result(folder)) {
        throw ReadError(fmt::format("{}: there is nothing to resume: the run is complete, its result is {}; "
                                    "to run the scene again, leave out --resume",
                                    folder.string(), (folder / "result.h5").string()));
    }
    throw ReadError(fmt::format("{}: no checkpoint to resume from: {}; {}; start the run again without "
                                "--resume",
                                folder.string(), fault, fault_before));
}

CheckpointFolder::CheckpointFolder(const std::filesystem::path& folder, double interval,
                                   std::filesystem::path resumed_from, SecondsSource now)
    : current_(current_in(folder)), previous_(previous_in(folder)), newest_(std::move(resumed_from)),
      interval_(interval), now_(std::move(now)), last_(now_()) {}

bool CheckpointFolder::due() {
    if (interval_ <= 0) {
        return false;
    }
    const double now = now_();
    if (now - last_ < interval_) {
        return false;
    }
    last_ = now;
    return true;
}

// At every moment one of the two names is that of a good checkpoint, if ever one was: a bad one, or another
// run's, never takes the place of `newest_`.
void CheckpointFolder::write(const RunIdentity& identity, const RunState& state,
                             const std::filesystem::path& scene) {
    PartialFile file(current_);
    write_checkpoint(file, identity, state, scene);
    file.synchronise();
    std::error_code error;
    if (newest_ == current_) {
        std::filesystem::rename(current_, previous_, error);
    }
    file.commit();
    if (newest_.empty()) {
        std::filesystem::remove(previous_, error);
    }
    newest_ = current_;
    last_ = now_(); // or a slow disk would have a run write and nothing else
}

bool CheckpointFolder::has_foreign() const {
    std::error_code error;
    return newest_.empty() &&
           (std::filesystem::exists(current_, error) || std::filesystem::exists(previous_, error));
}

void CheckpointFolder::remove() const {
    std::error_code error;
    std::filesystem::path partial = current_;
    partial += ".partial"; // what a run left that was killed while it wrote one
    for (const auto& path : {current_, previous_, partial}) {
        std::filesystem::remove(path, error);
    }
}

} // namespace slurry
