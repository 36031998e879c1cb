#include "solver/output/seal.hpp"

#include "solver/output/result_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

namespace slurry {
namespace {

struct SealedFile {
    std::string seal;        // as found
    std::string due;         // as it has to be
    std::uintmax_t size = 0; // bytes
};

SealedFile read_sealed(const std::filesystem::path& path) {
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    SealedFile file;
    file.seal.resize(seal_size);
    stream.read(file.seal.data(), seal_size);
    file.size = static_cast<std::uintmax_t>(stream.gcount());
    uLong checksum = crc32_z(0, nullptr, 0);
    std::vector<char> buffer(std::size_t{1} << 20U);
    while (stream) {
        stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        const auto count = static_cast<std::size_t>(stream.gcount());
        checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(buffer.data()), count);
        file.size += count;
    }
    if (!stream.eof())
        throw OutputError(fmt::format("{}: cannot read: {}", path.string(),
                                      errno == 0 ? "no reason given" : std::strerror(errno)));
    file.due = fmt::format("slurry checkpoint: HDF5 after {} bytes\nbytes {}\ncrc32 {:08x}\n", seal_size,
                           file.size, checksum);
    file.due.resize(seal_size, '\n');
    return file;
}

} // namespace

std::string seal_of(const std::filesystem::path& file) {
    return read_sealed(file).due;
}

std::string seal_fault(const std::filesystem::path& path) {
    const SealedFile file = read_sealed(path);
    if (file.seal == file.due)
        return "";
    const std::string length = fmt::format("\nbytes {}\n", file.size);
    return file.seal.find(length) == std::string::npos
               ? fmt::format("it is cut short or no checkpoint: it has {} bytes", file.size)
               : "its checksum does not fit: bytes have changed since it was written";
}

} // namespace slurry
