#include "solver/output/hdf5_reader.hpp"

#include "solver/output/result_file.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace slurry {

std::vector<double> StoredTable::column(std::size_t index) const {
    std::vector<double> chosen(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        chosen[row] = values[row * columns + index];
    }
    return chosen;
}

Hdf5Reader::Hdf5Reader(std::filesystem::path path)
    : path_(std::move(path)),
      file_(open(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "a result file")) {}

Hdf5Handle Hdf5Reader::open(hid_t identifier, Hdf5Handle::Close closer, const std::string& what) const {
    if (identifier < 0) {
        throw OutputError(fmt::format("{}: cannot read {}: {}", path_.string(), what, hdf5_reason()));
    }
    return {identifier, closer};
}

bool Hdf5Reader::has(const std::string& object) const {
    return H5Lexists(file_.get(), object.c_str(), H5P_DEFAULT) > 0;
}

StoredTable Hdf5Reader::table(const std::string& dataset) const {
    const Hdf5Handle data = open(H5Dopen2(file_.get(), dataset.c_str(), H5P_DEFAULT), H5Dclose, dataset);
    const Hdf5Handle space = open(H5Dget_space(data.get()), H5Sclose, dataset);
    std::array<hsize_t, 2> sizes{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr) < 0) {
        throw OutputError(fmt::format("{}: {} is not a table of numbers", path_.string(), dataset));
    }
    StoredTable table{sizes[0], sizes[1], std::vector<double>(sizes[0] * sizes[1])};
    if (H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.values.data()) < 0) {
        throw OutputError(fmt::format("{}: cannot read {}: {}", path_.string(), dataset, hdf5_reason()));
    }
    return table;
}

std::vector<double> Hdf5Reader::values(const std::string& dataset) const {
    return table(dataset).values;
}

std::string Hdf5Reader::text(const std::string& object, const std::string& attribute) const {
    const std::string what = fmt::format("{} of {}", attribute, object);
    const Hdf5Handle stored =
        open(H5Aopen_by_name(file_.get(), object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
             H5Aclose, what);
    const Hdf5Handle type = open(H5Aget_type(stored.get()), H5Tclose, what);
    char* characters = nullptr;
    if (H5Tis_variable_str(type.get()) <= 0 || H5Aread(stored.get(), type.get(), &characters) < 0) {
        throw OutputError(fmt::format("{}: cannot read {}: {}", path_.string(), what, hdf5_reason()));
    }
    std::string text = characters == nullptr ? "" : characters;
    H5free_memory(characters);
    return text;
}

double Hdf5Reader::attribute(const std::string& object, const std::string& name) const {
    const std::string what = fmt::format("{} of {}", name, object);
    const Hdf5Handle attribute = open(
        H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
    double value = 0;
    if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
        throw OutputError(fmt::format("{}: cannot read {}: {}", path_.string(), what, hdf5_reason()));
    }
    return value;
}

} // namespace slurry
