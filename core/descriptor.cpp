// SPDX-License-Identifier: Apache-2.0
#include "core/descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"

namespace airlight {

Descriptor::~Descriptor() {
    if (descriptor_ >= 0) close(descriptor_);
}

Descriptor unnamed_temporary_file() {
    std::error_code error;
    const std::string directory = std::filesystem::temp_directory_path(error).string();
    if (error) throw Error(ErrorCode::io, "there is no directory for temporary files (TMPDIR)");
#ifdef O_TMPFILE
    if (const int unnamed = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
        unnamed >= 0) {
        return Descriptor(unnamed);
    }
#endif
    std::string name = directory + "/airlight-XXXXXX";
    const int named = mkstemp(name.data());
    if (named < 0) {
        throw Error(ErrorCode::io, "cannot create a temporary file: " + system_message(errno),
                    directory);
    }
    unlink(name.c_str());
    return Descriptor(named);
}

int write_all(int descriptor, const void* data, std::size_t bytes) {
    const char* position = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = write(descriptor, position, bytes);
        if (written < 0) {
            if (errno == EINTR) continue;
            return errno;
        }
        position += written;
        bytes -= static_cast<std::size_t>(written);
    }
    return 0;
}

std::size_t read_at(int descriptor, void* data, std::size_t bytes, std::size_t offset,
                    const std::string& where) {
    std::size_t total = 0;
    while (total < bytes) {
        const ssize_t got = pread(descriptor, static_cast<char*>(data) + total, bytes - total,
                                  static_cast<off_t>(offset + total));
        if (got < 0) {
            if (errno == EINTR) continue;
            throw Error(ErrorCode::io, "cannot read: " + system_message(errno), where);
        }
        if (got == 0) break;
        total += static_cast<std::size_t>(got);
    }
    return total;
}

}  // namespace airlight
