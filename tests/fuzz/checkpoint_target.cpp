#include "tests/fuzz/checkpoint_target.hpp"

#include "solver/output/seal.hpp"
#include "solver/particles/run_error.hpp"
#include "solver/scene/read_scene.hpp"
#include "solver/time/watchdog.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace slurry::fuzz {
namespace {

void require(bool holds, const std::string& what) {
    if (!holds) {
        throw std::logic_error(what);
    }
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// Everything that a checkpoint holds, and few particles: most of the time would go into their next step.
Scene small_channel_with_discs() {
    Scene scene = testing::channel_with_discs();
    scene.numerics.particle_spacing = 1.0 / 8;
    return scene;
}

} // namespace

CheckpointTarget::CheckpointTarget()
    : run_(small_channel_with_discs(), folder_.path() / "run"), identity_(run_identity(run_.scene)) {
    // Every file that is opened takes half a megabyte, which would go back to the system each time.
    H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
    run_.go_to(2);
    PartialFile file(path_);
    write_checkpoint(file, identity_, run_.state, "scene.toml");
    file.commit();
    std::ifstream stream(path_, std::ios::binary);
    good_.assign(std::istreambuf_iterator<char>(stream), {});
    names_ = names_in(path_);
    require(seal_fault(path_).empty() && names_.objects.size() > 30 && names_.attributes.size() > 30,
            "the checkpoint to damage is none");
}

void CheckpointTarget::operator()(std::string_view input) {
    Bytes bytes(input);
    switch (bytes.below(8)) {
    case 0:
        return try_bytes(bytes);
    case 1:
        return try_edits(bytes, &CheckpointTarget::read_scene);
    default:
        return try_edits(bytes, &CheckpointTarget::read_and_step);
    }
}

void CheckpointTarget::try_bytes(Bytes bytes) {
    std::string damaged = good_;
    if (bytes.below(2) == 0) {
        damaged.resize(good_.size() * bytes.below(256) / 256);
    }
    while (!bytes.empty() && !damaged.empty()) {
        const std::size_t place = bytes.below(65536) * 256 + bytes.below(256);
        damaged[place % damaged.size()] = static_cast<char>(bytes.below(256));
    }
    write_bytes(path_, damaged);
    require(seal_fault(path_).empty() == (damaged == good_), "damage that the seal does not show");
}

void CheckpointTarget::try_edits(Bytes bytes, void (CheckpointTarget::*read)()) {
    write_bytes(path_, good_);
    {
        const Hdf5Silence silence;
        const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        for (int count = 0; count < 8 && !bytes.empty(); ++count) {
            edit(file.get(), names_, bytes);
        }
    }
    try {
        (this->*read)();
    } catch (const ReadError& error) {
        const std::string message = error.what();
        require(message.starts_with(path_.string() + ": "), "a refusal without its file: " + message);
        require(message.find('\n') == std::string::npos, "a refusal of several lines: " + message);
    } catch (const OutputError& error) { // what was recorded cannot be copied
        require(std::string_view(error.what()).find('\n') == std::string_view::npos,
                "a refusal of several lines");
    } catch (const RunError&) { // the watchdog's
    }
}

void CheckpointTarget::read_scene() {
    try {
        static_cast<void>(read_checkpoint_scene(path_, {}));
    } catch (const SceneError&) { // the run's scene was not read from a file
    }
}

void CheckpointTarget::read_and_step() {
    ResultFile result(folder_.path() / "resumed", run_.scene, "test", true);
    PhaseClock clock;
    read_checkpoint(path_, identity_, {run_.step, run_.particles, *run_.sums, run_.contacts, result, clock});
    advance(run_.particles, run_.forces, 0.5 * largest_time_step(run_.scene), clock);
    check_particles(run_.particles, run_.region, run_.scene, run_.step);
    result.begin_sample(run_.particles.time);
    result.add_sample("kinetic_energy", "J/m", 0);
}

} // namespace slurry::fuzz
