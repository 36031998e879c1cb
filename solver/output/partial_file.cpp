#include "solver/output/partial_file.hpp"

#include "solver/output/result_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace slurry {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view attempt) {
    throw OutputError(fmt::format("{}: cannot {}: {}", path.string(), attempt, std::strerror(errno)));
}

// A name is safe against a crash of the machine only when its folder is. Not every file system can do that.
void synchronise_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return; // a folder may be writable, yet not readable
    const bool failed = ::fsync(descriptor) != 0 && errno == EIO;
    ::close(descriptor);
    if (failed)
        fail(folder, "write to the disk");
}

} // namespace

PartialFile::PartialFile(std::filesystem::path target) : target_(std::move(target)), path_(target_) {
    path_ += ".partial";
    // Not truncated before the lock is ours: the file may be another run's.
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
        fail(path_, "create the file");
    // A file system without locks (ENOLCK, ENOTSUP) is no reason to refuse a run.
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(descriptor_);
        throw OutputError(fmt::format(
            "{}: another run is writing this file; choose another folder with --out", path_.string()));
    }
    if (::ftruncate(descriptor_, 0) != 0) {
        ::close(descriptor_);
        fail(path_, "empty the file");
    }
}

PartialFile::~PartialFile() {
    if (descriptor_ < 0)
        return;
    ::unlink(path_.c_str());
    ::close(descriptor_);
}

void PartialFile::require_space(std::uintmax_t bytes) const {
    struct stat now {};
    if (::fstat(descriptor_, &now) != 0)
        fail(path_, "look at the file");
    const bool fits = ::fallocate(descriptor_, 0, now.st_size, static_cast<off_t>(bytes)) == 0 ||
                      errno == EOPNOTSUPP || errno == ENOSYS; // a file system that cannot tell
    const int reason = errno;
    const bool as_before = ::ftruncate(descriptor_, now.st_size) == 0;
    if (!fits)
        errno = reason;
    if (!fits || !as_before)
        fail(path_, fmt::format("write {} bytes", bytes));
}

void PartialFile::write(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor_, text.data(), text.size());
        if (written < 0 && errno != EINTR)
            fail(path_, "write");
        if (written > 0)
            text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void PartialFile::synchronise() {
    if (::fsync(descriptor_) != 0)
        fail(path_, "write to the disk");
}

void PartialFile::commit_as(const std::filesystem::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0)
        fail(target, "give the file its name");
    ::close(std::exchange(descriptor_, -1));
    synchronise_folder(target.parent_path());
}

} // namespace slurry
