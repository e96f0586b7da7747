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

namespace airlight {
namespace {

constexpr int kNameAttempts = 100;
constexpr const char* kExists = "already exists (use --force to replace it)";

struct Place {
    std::string resolved;
    std::string directory;
    bool exists = false;
    mode_t mode = 0;
};

// Looks at the target and its directory; throws for all that is known to fail.
Place inspect(const std::string& target, bool force) {
    if (target.empty()) throw Error(ErrorCode::io, "the output path is empty");
    Place place;
    place.resolved = target;
    struct stat status = {};
    if (lstat(target.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
        std::error_code error;
        place.resolved = std::filesystem::canonical(target, error).string();
        if (error) {
            throw Error(ErrorCode::io, "is a symbolic link that leads nowhere", target);
        }
    }
    const std::filesystem::path parent = std::filesystem::path(place.resolved).parent_path();
    place.directory = parent.empty() ? "." : parent.string();
    if (stat(place.resolved.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::io, "is a directory", target);
        if (!S_ISREG(status.st_mode)) {
            throw Error(ErrorCode::io, "is not a regular file (use - for standard output)", target);
        }
        if (!force) throw Error(ErrorCode::io, kExists, target);
        place.exists = true;
        place.mode = status.st_mode & 07777;
    }
    if (stat(place.directory.c_str(), &status) != 0) {
        const int error = errno;
        throw Error(ErrorCode::io,
                    error == ENOENT ? "the directory " + place.directory + " does not exist"
                    : error == ENOTDIR
                        ? place.directory + " is not a directory"
                        : "cannot look into " + place.directory + ": " + system_message(error),
                    target);
    }
    if (!S_ISDIR(status.st_mode)) {
        throw Error(ErrorCode::io, place.directory + " is not a directory", target);
    }
    if (place.resolved.back() == '/') throw Error(ErrorCode::io, "is no file name", target);
    if (access(place.directory.c_str(), W_OK | X_OK) != 0) {
        throw Error(ErrorCode::io,
                    "cannot create a file in " + place.directory + ": " + system_message(errno),
                    target);
    }
    return place;
}

std::string hidden_name(const std::string& directory) {
    static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device random;
    std::uniform_int_distribution<std::size_t> letter(0, sizeof kLetters - 2);
    std::string name = directory + "/.airlight-";
    for (int i = 0; i < 12; ++i) name += kLetters[letter(random)];
    return name;
}

// Moves one name onto another, which without `force` must not exist. Returns 0 or an errno value.
int move_name(const std::string& from, const std::string& to, bool force) {
#ifdef RENAME_NOREPLACE
    if (!force) {
        if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
            return 0;
        // Some file systems know only the plain form.
        if (errno != EINVAL && errno != ENOSYS) return errno;
    }
#endif
    if (!force && access(to.c_str(), F_OK) == 0) return EEXIST;
    return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

std::string system_message(int error_number) {
    return std::generic_category().message(error_number);
}

void check_target(const std::string& target, bool force) {
    inspect(target, force);
}

AtomicFile::AtomicFile(std::string target, const AtomicFileOptions& options)
    : target_(std::move(target)), force_(options.force) {
    const Place place = inspect(target_, force_);
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
            throw Error(
                ErrorCode::io,
                errno == EEXIST ? kExists : "cannot be put in place: " + system_message(errno),
                target_);
        }
        if (!force_) return;
        path_ = name;
        named_ = true;
    }
#endif
    if (const int error = move_name(path_, resolved_, force_); error != 0) {
        throw Error(ErrorCode::io,
                    error == EEXIST ? kExists : "cannot be put in place: " + system_message(error),
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
    // The new file is in place; what remains makes its name outlive a power cut. Some network file
    // systems cannot sync a directory and say EINVAL.
    const int directory = open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return;
    const int error = fsync(directory) == 0 ? 0 : errno;
    close(directory);
    if (error != 0 && error != EINVAL) {
        throw Error(ErrorCode::io,
                    "was written but may not outlive a power cut: " + system_message(error),
                    target_);
    }
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
