#include "solver/output/hdf5_writer.hpp"

#include "solver/output/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace slurry {
namespace {

Hdf5Handle space_of(const std::vector<hsize_t>& sizes, const std::vector<hsize_t>& largest) {
    return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), largest.data()), H5Sclose};
}

hid_t handle_of(const Hdf5Handle& handle) {
    return handle.get();
}
herr_t handle_of(herr_t status) {
    return status;
}

// About 64 KiB a chunk, yet no more rows than a short run has.
Hdf5Handle growing_layout(std::vector<hsize_t> row) {
    row[0] = std::clamp<hsize_t>(8192 / std::max<hsize_t>(row.back(), 1), 1, 256);
    Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(layout.get(), static_cast<int>(row.size()), row.data());
    return layout;
}

} // namespace

// Passes the result of an HDF5 call on when it is good.
template <class Result> Result Hdf5Writer::require(Result result) const {
    if (handle_of(result) < 0)
        throw OutputError(fmt::format("{}: cannot write: {}", name_, hdf5_reason()));
    return result;
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path, std::size_t user_block) : name_(path.string()) {
    const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    require(H5Pset_userblock(creation.get(), user_block));
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(H5Pset_file_locking(access.get(), false, false)); // would clash with the caller's lock
    file_ =
        require(Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose));
}

// HDF5 1.10 crashes when it closes a file, or itself at exit, while something cannot be written (disk full).
// What cannot be flushed is therefore left open: the caller removes the file, and the process ends soon
// after.
Hdf5Writer::~Hdf5Writer() {
    if (file_.get() < 0 || H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0)
        return;
    file_.release();
    for (auto& [path, entry] : tables_)
        entry.dataset.release();
}

void Hdf5Writer::make_group(const std::string& path) {
    require(
        Hdf5Handle(H5Gcreate2(file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose));
}

void Hdf5Writer::attach(const std::string& object, const std::string& name, const Hdf5Handle& type,
                        const void* value) {
    const Hdf5Handle owner = require(Hdf5Handle(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose));
    if (require(H5Aexists(owner.get(), name.c_str())) > 0)
        require(H5Adelete(owner.get(), name.c_str()));
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute = require(Hdf5Handle(
        H5Acreate2(owner.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose));
    require(H5Awrite(attribute.get(), type.get(), value));
}

void Hdf5Writer::set_attribute(const std::string& object, const std::string& name, double value) {
    attach(object, name, Hdf5Handle(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose), &value);
}

void Hdf5Writer::set_attribute(const std::string& object, const std::string& name, std::string_view text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), H5T_VARIABLE); // one of fixed length ends at 64 KiB, and a scene may be longer
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    const std::string copy(text);
    const char* characters = copy.c_str();
    attach(object, name, type, &characters);
}

Hdf5Handle Hdf5Writer::make_dataset(const std::string& path, std::string_view unit, hid_t type,
                                    const Hdf5Handle& space, hid_t layout) {
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    Hdf5Handle dataset = require(
        Hdf5Handle(H5Dcreate2(file_.get(), path.c_str(), type, space.get(), links.get(), layout, H5P_DEFAULT),
                   H5Dclose));
    set_attribute(path, "unit", unit);
    return dataset;
}

void Hdf5Writer::write(const std::string& path, std::string_view unit, std::span<const double> values) {
    const Hdf5Handle space = space_of({values.size()}, {values.size()});
    const Hdf5Handle dataset = make_dataset(path, unit, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT);
    require(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void Hdf5Writer::write(const std::string& path, std::string_view unit, std::span<const int> values) {
    const Hdf5Handle space = space_of({values.size()}, {values.size()});
    const Hdf5Handle dataset = make_dataset(path, unit, H5T_NATIVE_INT, space, H5P_DEFAULT);
    require(H5Dwrite(dataset.get(), H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void Hdf5Writer::write_vector_view(const std::string& path, std::string_view unit, std::size_t rows) {
    const Hdf5Handle view = space_of({rows, 3}, {rows, 3});
    const Hdf5Handle component = space_of({rows}, {rows});
    const Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const std::array<hsize_t, 2> count{rows, 1};
    for (const hsize_t axis : {0U, 1U}) {
        const std::array<hsize_t, 2> column{0, axis};
        require(
            H5Sselect_hyperslab(view.get(), H5S_SELECT_SET, column.data(), nullptr, count.data(), nullptr));
        const std::string source = path + (axis == 0 ? "_x" : "_y");
        require(H5Pset_virtual(layout.get(), view.get(), ".", source.c_str(), component.get()));
    }
    require(H5Sselect_all(view.get()));
    make_dataset(path, unit, H5T_NATIVE_DOUBLE, view, layout.get());
}

Hdf5Writer::Table& Hdf5Writer::table(const std::string& path, std::string_view unit, const Sizes& row) {
    const auto found = tables_.find(path);
    if (found != tables_.end())
        return found->second;
    Sizes none = row;
    Sizes any = row;
    none[0] = 0;
    any[0] = H5S_UNLIMITED;
    Hdf5Handle dataset =
        make_dataset(path, unit, H5T_NATIVE_DOUBLE, space_of(none, any), growing_layout(row).get());
    return tables_.emplace(path, Table{std::move(dataset), row}).first->second;
}

void Hdf5Writer::append(const std::string& path, std::string_view unit, const Sizes& row,
                        const double* values) {
    Table& grown = table(path, unit, row);
    if (grown.row != row)
        throw std::logic_error(path + ": rows of different length");
    Sizes sizes = row;
    Sizes start(row.size(), 0);
    start[0] = grown.rows;
    sizes[0] = ++grown.rows;
    require(H5Dset_extent(grown.dataset.get(), sizes.data()));
    const Hdf5Handle target = require(Hdf5Handle(H5Dget_space(grown.dataset.get()), H5Sclose));
    require(H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, row.data(), nullptr));
    const Hdf5Handle source = space_of(row, row);
    require(
        H5Dwrite(grown.dataset.get(), H5T_NATIVE_DOUBLE, source.get(), target.get(), H5P_DEFAULT, values));
}

void Hdf5Writer::append(const std::string& path, std::string_view unit, double value) {
    append(path, unit, {1}, &value);
}

void Hdf5Writer::append(const std::string& path, std::string_view unit, std::span<const double> row) {
    append(path, unit, {1, row.size()}, row.data());
}

std::size_t Hdf5Writer::rows(const std::string& path) const {
    const auto found = tables_.find(path);
    return found == tables_.end() ? 0 : found->second.rows;
}

std::vector<std::string> Hdf5Writer::tables() const {
    std::vector<std::string> paths;
    std::ranges::transform(tables_, std::back_inserter(paths), [](const auto& entry) { return entry.first; });
    return paths;
}

bool Hdf5Writer::has(const std::string& path) const {
    return require(H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT)) > 0;
}

void Hdf5Writer::remove(const std::string& path) {
    require(H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT));
}

void Hdf5Writer::copy(hid_t file, const std::string& from, const std::string& to) {
    require(H5Ocopy(file, from.c_str(), file_.get(), to.c_str(), H5P_DEFAULT, H5P_DEFAULT));
    std::vector<std::string> names;
    const auto note = [](hid_t /*group*/, const char* name, const H5L_info_t* /*link*/, void* to_names) {
        static_cast<std::vector<std::string>*>(to_names)->emplace_back(name);
        return herr_t{0};
    };
    const Hdf5Handle group = require(Hdf5Handle(H5Gopen2(file_.get(), to.c_str(), H5P_DEFAULT), H5Gclose));
    require(H5Lvisit(group.get(), H5_INDEX_NAME, H5_ITER_NATIVE, note, &names));
    for (const std::string& name : names)
        adopt_table(fmt::format("{}/{}", to, name));
}

// Only tables can grow.
void Hdf5Writer::adopt_table(const std::string& path) {
    const Hdf5Handle object = require(Hdf5Handle(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose));
    if (H5Iget_type(object.get()) != H5I_DATASET)
        return;
    const Hdf5Handle space = require(Hdf5Handle(H5Dget_space(object.get()), H5Sclose));
    Sizes row(static_cast<std::size_t>(require(H5Sget_simple_extent_ndims(space.get()))));
    Sizes largest(row.size());
    require(H5Sget_simple_extent_dims(space.get(), row.data(), largest.data()));
    if (row.empty() || largest.front() != H5S_UNLIMITED)
        return;
    const hsize_t rows = std::exchange(row.front(), 1);
    Hdf5Handle dataset = require(Hdf5Handle(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose));
    tables_.emplace(path, Table{std::move(dataset), std::move(row), rows});
}

void Hdf5Writer::flush() {
    require(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL));
}

void Hdf5Writer::close() {
    flush();
    for (auto& [path, entry] : tables_)
        require(entry.dataset.close());
    require(file_.close());
}

} // namespace slurry
