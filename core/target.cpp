// SPDX-License-Identifier: Apache-2.0
#include "core/target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"

namespace airlight::detail {

Target inspect_target(const std::string& target, bool force) {
    if (target.empty()) throw Error(ErrorCode::io, "the output path is empty");
    Target place;
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
        if (!force) throw Error(ErrorCode::io, kTargetExists, target);
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

void sync_directory(const std::string& name, const std::string& target) {
    // Some network file systems cannot sync a directory and say EINVAL.
    const int directory = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return;
    const int error = fsync(directory) == 0 ? 0 : errno;
    close(directory);
    if (error != 0 && error != EINVAL) {
        throw Error(ErrorCode::io,
                    "was written but may not outlive a power cut: " + system_message(error),
                    target);
    }
}

}  // namespace airlight::detail
