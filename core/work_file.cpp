// SPDX-License-Identifier: Apache-2.0
#include "core/work_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/atomic_file.h"
#include "core/checked.h"
#include "core/error.h"
#include "core/target.h"

namespace airlight {
namespace {

constexpr int kAttempts = 100;

bool is_named(int descriptor, const std::string& path) {
    struct stat open_one = {}, named_one = {};
    return fstat(descriptor, &open_one) == 0 && stat(path.c_str(), &named_one) == 0 &&
           open_one.st_ino == named_one.st_ino && open_one.st_dev == named_one.st_dev;
}

}  // namespace

WorkFile::WorkFile(std::string target, const std::string& suffix, bool force)
    : target_(std::move(target)), force_(force) {
    const detail::Target place = detail::inspect_target(target_, force_);
    resolved_ = place.resolved;
    directory_ = place.directory;
    path_ = resolved_ + suffix;
    for (int attempt = 0;; ++attempt) {
        kept_ = false;
        int descriptor =
            open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor < 0 && errno == EEXIST) {
            kept_ = true;
            descriptor = open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
        }
        if (descriptor < 0 && errno == ENOENT && attempt < kAttempts) continue;
        if (descriptor < 0) refuse("cannot be opened", errno);
        file_ = Descriptor(descriptor);
        if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            throw Error(ErrorCode::io, "another process is at work on it", target_);
        }
        // Between opening and locking, its last owner may have finished and taken the name away.
        if (is_named(descriptor, path_) || attempt == kAttempts) break;
    }
    struct stat status = {};
    if (fstat(descriptor(), &status) != 0) refuse("cannot be opened", errno);
    if (!S_ISREG(status.st_mode)) {
        kept_ = true;
        throw Error(ErrorCode::io, "is not a regular file", path_);
    }
    size_ = static_cast<std::size_t>(status.st_size);
    if (lseek(descriptor(), 0, SEEK_END) < 0) refuse("cannot be read", errno);
    try {
        // That owner may also have made the target meanwhile.
        detail::inspect_target(target_, force_);
        if (!kept_) detail::sync_directory(directory_, target_);
    } catch (...) {
        if (!kept_) unlink(path_.c_str());
        throw;
    }
}

WorkFile::~WorkFile() {
    if (!kept_ && descriptor() >= 0) unlink(path_.c_str());
}

void WorkFile::refuse(const std::string& what, int error) const {
    throw Error(ErrorCode::io, what + ": " + system_message(error), path_);
}

void WorkFile::reserve(std::size_t bytes) {
#ifdef FALLOC_FL_KEEP_SIZE
    if (bytes <= size_) return;
    if (fallocate(descriptor(), FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(bytes)) == 0) return;
    if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) {
        const int error = errno;
        const int released = ftruncate(descriptor(), static_cast<off_t>(size_));
        static_cast<void>(released);
        refuse("cannot hold the " + format_bytes(bytes) + " that this work needs", error);
    }
#else
    static_cast<void>(bytes);
#endif
}

void WorkFile::append(const void* data, std::size_t bytes) {
    if (const int error = write_all(descriptor(), data, bytes)) refuse("cannot be written", error);
    size_ += bytes;
}

void WorkFile::cut(std::size_t size) {
    if (ftruncate(descriptor(), static_cast<off_t>(size)) != 0 ||
        lseek(descriptor(), static_cast<off_t>(size), SEEK_SET) < 0) {
        refuse("cannot be cut", errno);
    }
    size_ = size;
}

void WorkFile::sync() const {
    if (fdatasync(descriptor()) != 0) refuse("cannot be written", errno);
}

void WorkFile::publish() {
    cut(size_);
    if (fsync(descriptor()) != 0) refuse("cannot be written", errno);
    const detail::Target place = detail::inspect_target(target_, force_);
    if (place.exists && fchmod(descriptor(), place.mode) != 0) {
        throw Error(ErrorCode::io, "cannot keep its permissions: " + system_message(errno),
                    target_);
    }
    if (const int error = detail::move_name(path_, resolved_, force_); error != 0) {
        throw Error(ErrorCode::io,
                    error == EEXIST ? detail::kTargetExists
                                    : "cannot be put in place: " + system_message(error),
                    target_);
    }
    kept_ = true;
    file_ = Descriptor();
    detail::sync_directory(directory_, target_);
}

void WorkFile::remove() {
    if (unlink(path_.c_str()) != 0 && errno != ENOENT) refuse("cannot be deleted", errno);
    kept_ = true;
    file_ = Descriptor();
}

}  // namespace airlight
