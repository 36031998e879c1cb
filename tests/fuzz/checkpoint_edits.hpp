#pragma once
// Changes to an HDF5 file such as our writer never makes: what a reader of checkpoints has to survive. They
// go through HDF5, so that the file is a valid one: a byte that changed is found by the seal, and HDF5 1.10
// itself does not survive every file without one.
#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace slurry::fuzz {

// Takes an input apart; behind its end there are zeros.
class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : rest_(bytes) {}

    [[nodiscard]] bool empty() const { return rest_.empty(); }
    // Below `count`, which is 1 ... 65536.
    std::size_t below(std::size_t count);
    // Any of eight bytes, or one of those that readers stumble over.
    double number();
    // Up to 15 characters.
    std::string text();

  private:
    std::string take(std::size_t count);

    std::string_view rest_;
};

struct StoredAttribute {
    std::string object, name;
};

// What is in a file, by its paths.
struct StoredNames {
    std::vector<std::string> objects; // groups and datasets, without the root
    std::vector<StoredAttribute> attributes;
};
[[nodiscard]] StoredNames names_in(const std::filesystem::path& path);

// Changes one object or attribute of the file; nothing when an earlier change has made that impossible.
void edit(hid_t file, const StoredNames& names, Bytes& bytes);

} // namespace slurry::fuzz
