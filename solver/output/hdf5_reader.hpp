#pragma once
// Reading a result or a checkpoint back.
#include "solver/output/hdf5_handle.hpp"

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace slurry {

// A file that is damaged, or not what was looked for; what() is one line that names the file and the reason.
class ReadError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct StoredTable { // row by row; a table [n] has one column
    std::size_t rows = 0;
    std::size_t columns = 1;
    std::vector<double> values;

    [[nodiscard]] std::vector<double> column(std::size_t index) const;
};

// Members throw ReadError. Paths are absolute within the file.
class Hdf5Reader {
  public:
    explicit Hdf5Reader(const std::filesystem::path& path);

    [[nodiscard]] bool has(const std::string& path) const;
    // Attributes of a group or dataset.
    [[nodiscard]] double number(const std::string& object, const std::string& name) const;
    [[nodiscard]] std::string text(const std::string& object, const std::string& name) const;
    // Numbers in a dataset.
    [[nodiscard]] std::size_t size(const std::string& path) const;
    // All of them in a dataset [n] or [n, m].
    [[nodiscard]] StoredTable table(const std::string& path) const;
    // Those of a checkpoint, where there have to be `size`: nothing in the file decides how much memory is
    // taken.
    [[nodiscard]] std::vector<double> numbers(const std::string& path, std::size_t size) const;
    [[nodiscard]] std::vector<int> integers(const std::string& path, std::size_t size) const;

    [[nodiscard]] hid_t file() const { return file_.get(); }
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    template <class Result> Result require(Result result, const std::string& part) const;
    [[nodiscard]] Hdf5Handle open_attribute(const std::string& object, const std::string& name) const;
    [[nodiscard]] Hdf5Handle open_dataset(const std::string& path) const;
    [[nodiscard]] std::size_t size(const Hdf5Handle& dataset, const std::string& path) const;
    template <class T> std::vector<T> values(const std::string& path, std::size_t size, hid_t type) const;

    Hdf5Silence silence_;
    std::string name_;
    Hdf5Handle file_;
};

} // namespace slurry
