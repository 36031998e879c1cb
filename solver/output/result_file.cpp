#include "solver/output/result_file.hpp"

#include "solver/output/hdf5_reader.hpp"
#include "solver/output/hdf5_writer.hpp"
#include "solver/output/partial_file.hpp"
#include "solver/output/xdmf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>
#include <vector>

namespace slurry {
namespace {

// All that a run records; /discs only where there are discs.
constexpr std::array groups{"/run", "/series", "/probes", "/discs", "/snapshots"};

std::string snapshot_group(std::size_t index) {
    return fmt::format("/snapshots/{:04}", index);
}

std::filesystem::path result_path(const std::filesystem::path& folder, bool overwrite) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw OutputError(
            fmt::format("{}: cannot make the output folder: {}", folder.string(), error.message()));
    std::filesystem::path target = folder / "result.h5";
    if (std::filesystem::is_directory(target, error))
        throw OutputError(
            fmt::format("{}: is a folder; remove it or choose another folder", target.string()));
    if (!overwrite && std::filesystem::exists(target, error))
        throw OutputError(
            fmt::format("{}: exists already; remove it or choose another folder", target.string()));
    return target;
}

} // namespace

struct ResultFile::Implementation {
    std::string title;
    std::vector<ProbeScene> probes;
    PartialFile partial;
    Hdf5Writer writer; // destroyed before the file it writes to
    std::vector<XdmfSnapshot> snapshots;
    XdmfSnapshot unfinished{}; // of them when it has ended
    std::string checkpoint;    // that the run goes on from; empty for a run from the start

    Implementation(const std::filesystem::path& target, const Scene& scene)
        : title(scene.title), probes(scene.probes), partial(target), writer(partial.path()) {}

    [[nodiscard]] bool is_point(std::string_view probe) const {
        return std::ranges::any_of(probes, [&](const ProbeScene& known) {
            return known.name == probe && std::holds_alternative<PointProbe>(known.kind);
        });
    }
    template <class Value>
    void add_to_snapshot(std::string_view quantity, std::string_view unit, std::span<const Value> values) {
        const std::string path = fmt::format("{}/{}", unfinished.group, quantity);
        if (values.size() != unfinished.particles)
            throw std::logic_error(path + ": needs one value for each particle");
        writer.write(path, unit, values);
    }
    std::filesystem::path finish_as(const std::string& stem);
    // Appends to a table of the group, whose `time` has been appended to before.
    template <class Row>
    void append(const std::string& group, std::string_view quantity, std::string_view unit, const Row& row) {
        const std::string path = fmt::format("{}/{}", group, quantity);
        try {
            writer.append(path, unit, row);
        } catch (const std::logic_error& misuse) {
            misfit(misuse.what());
        }
        require_as_many_rows_as_times(path);
    }
    void require_as_many_rows_as_times(const std::string& path) const {
        if (writer.rows(path) != writer.rows(path.substr(0, path.rfind('/')) + "/time"))
            misfit(path + ": needs one row for each time");
    }
    // A fault of the program's, unless a checkpoint brought the tables: it may hold anything.
    [[noreturn]] void misfit(const std::string& what) const {
        if (checkpoint.empty())
            throw std::logic_error(what);
        throw ReadError(
            fmt::format("{}: what it recorded is not of this run: {}; start the run again without "
                        "--resume",
                        checkpoint, what));
    }
};

ResultFile::ResultFile(const std::filesystem::path& folder, const Scene& scene, std::string_view version,
                       bool overwrite)
    : implementation_(std::make_unique<Implementation>(result_path(folder, overwrite), scene)) {
    Hdf5Writer& writer = implementation_->writer;
    for (const char* group : {"/run", "/series", "/probes", "/snapshots"})
        writer.make_group(group);
    writer.set_attribute("/", "version", version);
    writer.set_attribute("/", "scene", scene.resolved_text);
    writer.flush();
}

ResultFile::~ResultFile() = default;

void ResultFile::begin_sample(double time) {
    implementation_->writer.flush(); // a full disk ends the run now, not when all is computed
    implementation_->append("/series", "time", "s", time);
}

void ResultFile::add_sample(std::string_view name, std::string_view unit, double value) {
    implementation_->append("/series", name, unit, value);
}

void ResultFile::begin_probe_sample(std::string_view probe, double time) {
    implementation_->append(fmt::format("/probes/{}", probe), "time", "s", time);
}

void ResultFile::add_probe_row(std::string_view probe, std::string_view quantity, std::string_view unit,
                               std::span<const double> row) {
    const std::string group = fmt::format("/probes/{}", probe);
    if (!implementation_->is_point(probe))
        implementation_->append(group, quantity, unit, row);
    else if (row.size() == 1)
        implementation_->append(group, quantity, unit, row.front());
    else
        throw std::logic_error(fmt::format("{}/{}: a point has one value", group, quantity));
}

void ResultFile::add_probe_constant(std::string_view probe, std::string_view quantity, std::string_view unit,
                                    std::span<const double> values) {
    implementation_->writer.write(fmt::format("/probes/{}/{}", probe, quantity), unit, values);
}

void ResultFile::begin_disc_sample(double time) {
    implementation_->append("/discs", "time", "s", time);
}

void ResultFile::add_disc_row(std::string_view quantity, std::string_view unit, std::span<const double> row) {
    implementation_->append("/discs", quantity, unit, row);
}

void ResultFile::add_disc_constant(std::string_view quantity, std::string_view unit,
                                   std::span<const double> values) {
    implementation_->writer.write(fmt::format("/discs/{}", quantity), unit, values);
}

void ResultFile::name_discs(std::span<const std::string> names) {
    implementation_->writer.set_attribute("/discs", "names", fmt::format("{}", fmt::join(names, ",")));
}

void ResultFile::begin_snapshot(double time, std::size_t particles) {
    implementation_->unfinished = {snapshot_group(implementation_->snapshots.size()), time, particles};
}

void ResultFile::add_to_snapshot(std::string_view quantity, std::string_view unit,
                                 std::span<const double> values) {
    implementation_->add_to_snapshot(quantity, unit, values);
}

void ResultFile::add_to_snapshot(std::string_view quantity, std::string_view unit,
                                 std::span<const int> values) {
    implementation_->add_to_snapshot(quantity, unit, values);
}

void ResultFile::end_snapshot() {
    Hdf5Writer& writer = implementation_->writer;
    const XdmfSnapshot& snapshot = implementation_->unfinished;
    // The one form of a vector that all of ParaView's XDMF readers take.
    writer.write_vector_view(snapshot.group + "/position", "m", snapshot.particles);
    writer.write_vector_view(snapshot.group + "/velocity", "m/s", snapshot.particles);
    writer.set_attribute(snapshot.group, "time", snapshot.time);
    implementation_->snapshots.push_back(snapshot);
    writer.flush();
}

void ResultFile::set_attribute(std::string_view name, double value) {
    implementation_->writer.set_attribute("/run", std::string(name), value);
}

std::uintmax_t ResultFile::size() const {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(implementation_->partial.path(), error);
    return error ? 0 : size;
}

void ResultFile::copy_to(Hdf5Writer& checkpoint) {
    Hdf5Writer& writer = implementation_->writer;
    writer.flush();
    checkpoint.make_group("/result");
    for (const std::string group : groups) {
        if (writer.has(group))
            checkpoint.copy(writer.file(), group, "/result" + group);
    }
}

void ResultFile::restore(const Hdf5Reader& checkpoint) {
    implementation_->checkpoint = checkpoint.name();
    implementation_->partial.require_space(std::filesystem::file_size(checkpoint.name()));
    Hdf5Writer& writer = implementation_->writer;
    for (const std::string group : groups) {
        if (writer.has(group))
            writer.remove(group);
        if (checkpoint.has("/result" + group))
            writer.copy(checkpoint.file(), "/result" + group, group);
    }
    for (const std::string& path : writer.tables())
        implementation_->require_as_many_rows_as_times(path);
    auto& snapshots = implementation_->snapshots;
    for (std::string group; checkpoint.has("/result" + (group = snapshot_group(snapshots.size())));)
        snapshots.push_back({group, checkpoint.number("/result" + group, "time"),
                             checkpoint.size("/result" + group + "/wall")});
}

std::filesystem::path ResultFile::Implementation::finish_as(const std::string& stem) {
    writer.close();
    partial.synchronise();
    std::filesystem::path target = partial.target().parent_path() / (stem + ".h5");
    std::filesystem::path xdmf = target;
    PartialFile description(xdmf.replace_extension(".xdmf"));
    description.write(xdmf_document(title, target.filename().string(), snapshots));
    description.synchronise();
    partial.commit_as(target);
    description.commit();
    return target;
}

std::filesystem::path ResultFile::finish() {
    std::filesystem::path result = implementation_->finish_as("result");
    std::error_code error;
    for (const char* outdated : {"failed.h5", "failed.xdmf"})
        std::filesystem::remove(result.parent_path() / outdated, error);
    return result;
}

std::filesystem::path ResultFile::set_aside() {
    return implementation_->finish_as("failed");
}

} // namespace slurry
