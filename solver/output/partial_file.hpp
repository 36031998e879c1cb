#pragma once
// A file that appears under its name only as a whole.
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace slurry {

// Creates `<target>.partial` and holds a lock on it, so that two runs cannot write into each other's files.
// Removes it again when destroyed before commit(). All members throw OutputError.
class PartialFile {
  public:
    explicit PartialFile(std::filesystem::path target);
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] const std::filesystem::path& target() const { return target_; }
    // Finds out whether the file can grow by so many bytes, and leaves it as it is. HDF5 1.10 crashes when it
    // learns of a full disk in the middle of a copy.
    void require_space(std::uintmax_t bytes) const;
    void write(std::string_view text);
    // To the disk; errors that the system kept for later (a full disk, a quota) come to light here.
    void synchronise();
    // Gives the file its name, replacing an older one; afterwards the name is on the disk, too.
    void commit() { commit_as(target_); }
    // The same with another name in the same folder.
    void commit_as(const std::filesystem::path& target);

  private:
    std::filesystem::path target_;
    std::filesystem::path path_;
    int descriptor_ = -1;
};

} // namespace slurry
