#pragma once
// A finished result file, read back.
#include "solver/output/hdf5_handle.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace slurry {

struct StoredTable { // row by row; a table [n] has one column
    std::size_t rows = 0;
    std::size_t columns = 1;
    std::vector<double> values;

    [[nodiscard]] std::vector<double> column(std::size_t index) const;
};

// Members throw OutputError that names the file and what is missing. Paths are absolute within the file.
class Hdf5Reader {
  public:
    explicit Hdf5Reader(std::filesystem::path path);

    [[nodiscard]] bool has(const std::string& object) const;
    // A dataset [n] or [n, m] of numbers.
    [[nodiscard]] StoredTable table(const std::string& dataset) const;
    [[nodiscard]] std::vector<double> values(const std::string& dataset) const;
    [[nodiscard]] std::string text(const std::string& object, const std::string& attribute) const;
    [[nodiscard]] double attribute(const std::string& object, const std::string& name) const;

  private:
    [[nodiscard]] Hdf5Handle open(hid_t identifier, Hdf5Handle::Close closer, const std::string& what) const;

    Hdf5Silence silence_;
    std::filesystem::path path_;
    Hdf5Handle file_;
};

} // namespace slurry
