// SPDX-License-Identifier: Apache-2.0
#include "envmap/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/checked.h"
#include "core/error.h"
#include "core/open_input.h"

namespace airlight::detail {
namespace {

constexpr std::size_t kSpoolBlock = std::size_t{1} << 20;

bool starts_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

FileFormat recognise(std::string_view start, const std::string& name) {
    using namespace std::string_view_literals;
    if (starts_with(start, "\x76\x2f\x31\x01"sv)) return FileFormat::openexr;
    if (starts_with(start, "#?"sv)) return FileFormat::hdr;
    for (const std::string_view magic : {"PF\n"sv, "Pf\n"sv, "PF\r\n"sv, "Pf\r\n"sv}) {
        if (starts_with(start, magic)) return FileFormat::pfm;
    }
    for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
        if (starts_with(start, magic)) return FileFormat::tiff;
    }
    throw Error(ErrorCode::data, "is no OpenEXR, Radiance .hdr, .pfm or TIFF image", name);
}

}  // namespace

const char* format_name(FileFormat format) {
    switch (format) {
        case FileFormat::openexr:
            return "openexr";
        case FileFormat::hdr:
            return "hdr";
        case FileFormat::pfm:
            return "pfm";
        case FileFormat::tiff:
            return "tiff";
    }
    return "";
}

InputFile::InputFile(const std::string& path, std::size_t max_memory) {
    OpenInput input = open_input(path, "an image");
    name_ = std::move(input.name);
    descriptor_ = std::move(input.descriptor);
    if (input.has_size) {
        size_ = input.size;
    } else {
        spool(max_memory);
    }
    if (size_ == 0) throw Error(ErrorCode::data, "is empty", name_);
    std::string start(8, '\0');
    start.resize(read(start.data(), start.size(), 0));
    format_ = recognise(start, name_);
}

std::size_t InputFile::read(void* data, std::size_t bytes, std::size_t offset) const {
    return read_at(descriptor_.get(), data, bytes, offset, name_);
}

void InputFile::spool(std::size_t max_memory) {
    Descriptor copy = unnamed_temporary_file();
    std::vector<char> block(kSpoolBlock);
    for (;;) {
        const ssize_t got = ::read(descriptor_.get(), block.data(), block.size());
        if (got < 0) {
            if (errno == EINTR) continue;
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), name_);
        }
        if (got == 0) break;
        // What is no image is not worth a copy. A pipe may begin with less than a format's mark.
        if (size_ == 0 && got >= 4) recognise({block.data(), static_cast<std::size_t>(got)}, name_);
        size_ += static_cast<std::size_t>(got);
        if (size_ > max_memory) {
            throw Error(
                ErrorCode::memory,
                "holds more than the limit of " + format_bytes(max_memory) + " (--max-memory)",
                name_);
        }
        if (const int error = write_all(copy.get(), block.data(), static_cast<std::size_t>(got));
            error != 0) {
            throw Error(ErrorCode::io,
                        "cannot be kept in a temporary file: " + system_message(error), name_);
        }
    }
    descriptor_ = std::move(copy);
}

}  // namespace airlight::detail
