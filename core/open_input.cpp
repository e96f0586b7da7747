// SPDX-License-Identifier: Apache-2.0
#include "core/open_input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "core/atomic_file.h"
#include "core/error.h"

namespace airlight {

OpenInput open_input(const std::string& path, const std::string& expected) {
    OpenInput input;
    if (path.empty()) throw Error(ErrorCode::usage, "the name of an input is empty");
    input.name = path == "-" ? "standard input" : path;
    if (path == "-" && isatty(STDIN_FILENO) == 1) {
        throw Error(ErrorCode::usage, "is a terminal, and " + expected + " was expected",
                    input.name);
    }
    input.descriptor =
        Descriptor(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status = {};
    if (input.descriptor.get() < 0 || fstat(input.descriptor.get(), &status) != 0) {
        const int error = errno;
        throw Error(
            ErrorCode::io,
            error == ENOENT ? "does not exist" : "cannot be opened: " + system_message(error),
            input.name);
    }
    if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::io, "is a directory", input.name);
    if (S_ISREG(status.st_mode) && path != "-") {
        input.has_size = true;
        input.size = static_cast<std::size_t>(status.st_size);
    }
    return input;
}

}  // namespace airlight
