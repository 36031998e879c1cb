#pragma once
// The one output file of a run, result.h5, and result.xdmf beside it for ParaView.
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace slurry {

class Hdf5Reader;
class Hdf5Writer;

// The output could not be written; what() is one line that names the file and the reason.
class OutputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Collects the results in `result.h5.partial` and gives the file its name only when the run has ended well;
// when it is destroyed before, the partial file is removed.
class ResultFile {
  public:
    // Makes the folder if needed. Throws OutputError when it cannot be written; refuses a folder that already
    // holds a result only if `overwrite` is false.
    ResultFile(const std::filesystem::path& folder, const Scene& scene, std::string_view version,
               bool overwrite);
    ~ResultFile();
    ResultFile(const ResultFile&) = delete;
    ResultFile& operator=(const ResultFile&) = delete;

    // Appends one sample to /series/<name>, and its time to /series/time (call begin_sample first).
    void begin_sample(double time);
    void add_sample(std::string_view name, std::string_view unit, double value);

    // Appends one row to /probes/<probe>/<quantity>; begin_probe_sample appends to /probes/<probe>/time.
    void begin_probe_sample(std::string_view probe, double time);
    void add_probe_row(std::string_view probe, std::string_view quantity, std::string_view unit,
                       std::span<const double> row);
    // A dataset of a probe that does not change with time: /probes/<probe>/<quantity>.
    void add_probe_constant(std::string_view probe, std::string_view quantity, std::string_view unit,
                            std::span<const double> values);

    // Appends one value per disc to /discs/<quantity>; begin_disc_sample appends to /discs/time.
    void begin_disc_sample(double time);
    void add_disc_row(std::string_view quantity, std::string_view unit, std::span<const double> row);
    // What does not change with time: one value per disc, and the names.
    void add_disc_constant(std::string_view quantity, std::string_view unit, std::span<const double> values);
    void name_discs(std::span<const std::string> names);

    // All particles at one time, /snapshots/0000/...: a quantity at a time, each with one value for each
    // particle, the fluid's ordered by identity; they are positions, velocities and whatever else.
    void begin_snapshot(double time, std::size_t particles);
    void add_to_snapshot(std::string_view quantity, std::string_view unit, std::span<const double> values);
    void add_to_snapshot(std::string_view quantity, std::string_view unit, std::span<const int> values);
    void end_snapshot();

    // A number about the run: attribute of /run (fluid_particles, steps, wall_seconds, threads, ...).
    void set_attribute(std::string_view name, double value);

    // Copies all that was recorded into the group /result of a checkpoint, and goes on from there: restore(),
    // and whatever is added after it, throw ReadError when the checkpoint's tables are not such as these.
    [[nodiscard]] std::uintmax_t size() const; // bytes, until now
    void copy_to(Hdf5Writer& checkpoint);
    void restore(const Hdf5Reader& checkpoint);

    // Syncs, renames to result.h5, writes result.xdmf. Returns the path. What an earlier run set aside goes.
    std::filesystem::path finish();
    // The same as failed.h5 and failed.xdmf, beside an earlier result: for a run that went wrong.
    std::filesystem::path set_aside();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace slurry
