// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/target.h"

namespace airlight {
namespace {

constexpr int kNameAttempts = 100;

std::string hidden_name(const std::string& directory) {
    static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device random;
    std::uniform_int_distribution<std::size_t> letter(0, sizeof kLetters - 2);
    std::string name = directory + "/.airlight-";
    for (int i = 0; i < 12; ++i) name += kLetters[letter(random)];
    return name;
}

}  // namespace

std::string system_message(int error_number) {
    return std::generic_category().message(error_number);
}

void check_target(const std::string& target, bool force) {
    detail::inspect_target(target, force);
}

AtomicFile::AtomicFile(std::string target, const AtomicFileOptions& options)
    : target_(std::move(target)), force_(options.force) {
    const detail::Target place = detail::inspect_target(target_, force_);
    resolved_ = place.resolved;
    directory_ = place.directory;
    open_unfinished(options.unnamed);
    if (place.exists && fchmod(descriptor_, place.mode) != 0) {
        const int error = errno;
        abandon();
        throw Error(ErrorCode::io, "cannot keep its permissions: " + system_message(error),
                    target_);
    }
}

AtomicFile::~AtomicFile() {
    abandon();
}

void AtomicFile::open_unfinished(bool unnamed) {
#ifdef O_TMPFILE
    if (unnamed) {
        descriptor_ = open(directory_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) {
            path_ = "/proc/self/fd/" + std::to_string(descriptor_);
            // Without /proc there is no way to give it a name later.
            if (access(path_.c_str(), F_OK) == 0) return;
            close(descriptor_);
        }
    }
#else
    static_cast<void>(unnamed);
#endif
    for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
        path_ = hidden_name(directory_);
        descriptor_ = open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) {
            named_ = true;
            return;
        }
        if (errno != EEXIST) break;
    }
    throw Error(ErrorCode::io,
                "cannot create a file in " + directory_ + ": " + system_message(errno), target_);
}

void AtomicFile::write(const void* data, std::size_t bytes) {
    if (const int error = write_all(descriptor_, data, bytes); error != 0) {
        throw Error(ErrorCode::io, "cannot write: " + system_message(error), target_);
    }
}

void AtomicFile::publish() {
#ifdef O_TMPFILE
    if (!named_) {
        const std::string name = force_ ? hidden_name(directory_) : resolved_;
        if (linkat(AT_FDCWD, path_.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            throw Error(ErrorCode::io,
                        errno == EEXIST ? detail::kTargetExists
                                        : "cannot be put in place: " + system_message(errno),
                        target_);
        }
        if (!force_) return;
        path_ = name;
        named_ = true;
    }
#endif
    if (const int error = detail::move_name(path_, resolved_, force_); error != 0) {
        throw Error(ErrorCode::io,
                    error == EEXIST ? detail::kTargetExists
                                    : "cannot be put in place: " + system_message(error),
                    target_);
    }
    named_ = false;
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) {
        throw Error(ErrorCode::io, "cannot write: " + system_message(errno), target_);
    }
    publish();
    abandon();
    detail::sync_directory(directory_, target_);
}

void AtomicFile::abandon() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
    if (named_) unlink(path_.c_str());
    named_ = false;
}

void write_file_atomically(const std::string& target, const std::string& bytes, bool force) {
    AtomicFile file(target, AtomicFileOptions{force});
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace airlight
