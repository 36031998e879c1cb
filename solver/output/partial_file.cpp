#include "solver/output/partial_file.hpp"

#include "solver/output/result_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace slurry {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view attempt) {
    throw OutputError(fmt::format("{}: cannot {}: {}", path.string(), attempt, std::strerror(errno)));
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

void PartialFile::commit() {
    if (::rename(path_.c_str(), target_.c_str()) != 0)
        fail(target_, "give the file its name");
    ::close(std::exchange(descriptor_, -1));
}

} // namespace slurry
