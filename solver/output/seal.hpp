#pragma once
// Tells a file that is as it was written from one that is cut short or has a wrong bit.
#include <cstddef>
#include <filesystem>
#include <string>

namespace slurry {

// Bytes at the beginning of a sealed file, which HDF5 skips as its user block.
inline constexpr std::size_t seal_size = 512;

// What the first seal_size bytes have to be: text with the length of the file and a checksum of all bytes
// behind the seal. Throws OutputError when the file cannot be read.
[[nodiscard]] std::string seal_of(const std::filesystem::path& file);

// Why the file is not what was sealed, in words; empty when it is.
[[nodiscard]] std::string seal_fault(const std::filesystem::path& file);

} // namespace slurry
