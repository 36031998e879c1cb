#pragma once
// An HDF5 file being written: groups, attributes, datasets with units, and tables that grow by rows.
#include "solver/output/hdf5_handle.hpp"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slurry {

// Members throw OutputError that names the file and the system's reason, std::logic_error when misused. Paths
// are absolute within the file; groups on the way to a dataset are made when missing.
class Hdf5Writer {
  public:
    // Empties the file, which the caller has locked against other processes. HDF5 leaves the first
    // `user_block` bytes alone: none, or a power of 2 from 512.
    explicit Hdf5Writer(const std::filesystem::path& path, std::size_t user_block = 0);
    ~Hdf5Writer();
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    void make_group(const std::string& path);
    // On a group or dataset; replaces an older value.
    void set_attribute(const std::string& object, const std::string& name, double value);
    void set_attribute(const std::string& object, const std::string& name, std::string_view text);

    // A dataset [n] that stays as it is.
    void write(const std::string& path, std::string_view unit, std::span<const double> values);
    void write(const std::string& path, std::string_view unit, std::span<const int> values);
    // A virtual dataset [rows, 3] over the datasets <path>_x and <path>_y [rows], with zeros as third column.
    void write_vector_view(const std::string& path, std::string_view unit, std::size_t rows);

    // Appends to a table [n], and to a table [n, row.size()].
    void append(const std::string& path, std::string_view unit, double value);
    void append(const std::string& path, std::string_view unit, std::span<const double> row);
    // Rows of a table so far.
    [[nodiscard]] std::size_t rows(const std::string& path) const;
    // The paths of all tables.
    [[nodiscard]] std::vector<std::string> tables() const;

    [[nodiscard]] bool has(const std::string& path) const;
    void remove(const std::string& path);
    // Copies a group with all that it holds from another file. Its tables can be appended to.
    void copy(hid_t file, const std::string& from, const std::string& to);
    [[nodiscard]] hid_t file() const { return file_.get(); }

    // Hands everything to the system, so that a full disk shows now.
    void flush();
    // Nothing more can be written afterwards.
    void close();

  private:
    using Sizes = std::vector<hsize_t>;
    struct Table {
        Hdf5Handle dataset;
        Sizes row; // sizes of one row: {1} or {1, columns}
        hsize_t rows = 0;
    };

    template <class Result> Result require(Result result) const;
    void attach(const std::string& object, const std::string& name, const Hdf5Handle& type,
                const void* value);
    Hdf5Handle make_dataset(const std::string& path, std::string_view unit, hid_t type,
                            const Hdf5Handle& space, hid_t layout);
    void append(const std::string& path, std::string_view unit, const Sizes& row, const double* values);
    Table& table(const std::string& path, std::string_view unit, const Sizes& row);
    void adopt_table(const std::string& path);

    Hdf5Silence silence_;
    std::string name_;
    Hdf5Handle file_;
    std::map<std::string, Table> tables_;
};

} // namespace slurry
