#include "solver/output/hdf5_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

namespace slurry {
namespace {

bool is_good(const Hdf5Handle& handle) {
    return handle.get() >= 0;
}
bool is_good(herr_t status) {
    return status >= 0;
}

} // namespace

template <class Result> Result Hdf5Reader::require(Result result, const std::string& part) const {
    if (!is_good(result))
        throw ReadError(fmt::format("{}: cannot read {}: {}", name_, part, hdf5_reason()));
    return result;
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : name_(path.string()) {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_file_locking(access.get(), false, false); // reading from a folder that cannot be written
    file_ = require(Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose), "the file");
}

bool Hdf5Reader::has(const std::string& path) const {
    return H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Handle Hdf5Reader::open_attribute(const std::string& object, const std::string& name) const {
    const std::string part = fmt::format("{} of {}", name, object);
    Hdf5Handle attribute = require(
        Hdf5Handle(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose),
        part);
    // HDF5 writes as many values as there are, wherever they go.
    const Hdf5Handle space = require(Hdf5Handle(H5Aget_space(attribute.get()), H5Sclose), part);
    if (const hssize_t points = H5Sget_simple_extent_npoints(space.get()); points != 1)
        throw ReadError(fmt::format("{}: found {} values in {}, not one", name_, points, part));
    return attribute;
}

double Hdf5Reader::number(const std::string& object, const std::string& name) const {
    double value = 0;
    require(H5Aread(open_attribute(object, name).get(), H5T_NATIVE_DOUBLE, &value), name);
    return value;
}

std::string Hdf5Reader::text(const std::string& object, const std::string& name) const {
    const Hdf5Handle attribute = open_attribute(object, name);
    const Hdf5Handle type = require(Hdf5Handle(H5Aget_type(attribute.get()), H5Tclose), name);
    if (H5Tis_variable_str(type.get()) <= 0)
        throw ReadError(fmt::format("{}: {} of {} is not a text", name_, name, object));
    char* characters = nullptr;
    require(H5Aread(attribute.get(), type.get(), static_cast<void*>(&characters)), name);
    const std::unique_ptr<char, herr_t (*)(void*)> owner(characters, H5free_memory);
    return characters == nullptr ? "" : characters;
}

Hdf5Handle Hdf5Reader::open_dataset(const std::string& path) const {
    return require(Hdf5Handle(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose), path);
}

std::size_t Hdf5Reader::size(const std::string& path) const {
    return size(open_dataset(path), path);
}

std::size_t Hdf5Reader::size(const Hdf5Handle& dataset, const std::string& path) const {
    const Hdf5Handle space = require(Hdf5Handle(H5Dget_space(dataset.get()), H5Sclose), path);
    const hssize_t points = H5Sget_simple_extent_npoints(space.get());
    return points < 0 ? 0 : static_cast<std::size_t>(points);
}

std::vector<double> StoredTable::column(std::size_t index) const {
    std::vector<double> chosen(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        chosen[row] = values[row * columns + index];
    }
    return chosen;
}

StoredTable Hdf5Reader::table(const std::string& path) const {
    const Hdf5Handle dataset = open_dataset(path);
    const Hdf5Handle space = require(Hdf5Handle(H5Dget_space(dataset.get()), H5Sclose), path);
    std::array<hsize_t, 2> sizes{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr) < 0) {
        throw ReadError(fmt::format("{}: {} is not a table of numbers", name_, path));
    }
    // Each number of a result takes more than a byte of the file: a larger table would be one of nothing.
    hsize_t bytes = 0;
    require(H5Fget_filesize(file_.get(), &bytes), path);
    if (sizes[0] > bytes || sizes[1] > bytes / std::max<hsize_t>(sizes[0], 1)) {
        throw ReadError(fmt::format("{}: {} of {} x {} numbers is larger than the file", name_, path,
                                    sizes[0], sizes[1]));
    }
    StoredTable table{sizes[0], sizes[1], std::vector<double>(sizes[0] * sizes[1])};
    require(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.values.data()),
            path);
    return table;
}

template <class T>
std::vector<T> Hdf5Reader::values(const std::string& path, std::size_t count, hid_t type) const {
    const Hdf5Handle dataset = open_dataset(path);
    if (const std::size_t found = size(dataset, path); found != count)
        throw ReadError(
            fmt::format("{}: found {} numbers in {}, not {}: of another run", name_, found, path, count));
    std::vector<T> values(count);
    require(H5Dread(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
    return values;
}

std::vector<double> Hdf5Reader::numbers(const std::string& path, std::size_t size) const {
    return values<double>(path, size, H5T_NATIVE_DOUBLE);
}

std::vector<int> Hdf5Reader::integers(const std::string& path, std::size_t size) const {
    return values<int>(path, size, H5T_NATIVE_INT);
}

} // namespace slurry
