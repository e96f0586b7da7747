// SPDX-License-Identifier: Apache-2.0
#include "core/read_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "core/atomic_file.h"
#include "core/checked.h"
#include "core/error.h"
#include "core/open_input.h"

namespace airlight {

std::string read_text(const std::string& path, const std::string& expected, std::size_t limit) {
    const OpenInput input = open_input(path, expected);
    std::string text;
    std::vector<char> block(std::size_t{1} << 16);
    for (;;) {
        const ssize_t got = read(input.descriptor.get(), block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), input.name);
        }
        if (got == 0) return text;
        text.append(block.data(), static_cast<std::size_t>(got));
        if (text.size() > limit) {
            throw Error(ErrorCode::memory,
                        fmt::format("holds more than {}, which is what the limit on memory leaves "
                                    "for {} (--max-memory)",
                                    format_bytes(limit), expected),
                        input.name);
        }
    }
}

}  // namespace airlight
