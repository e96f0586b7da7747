// SPDX-License-Identifier: Apache-2.0
#include "envmap/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/checked.h"
#include "core/error.h"
#include "envmap/picture_size.h"

namespace airlight::detail {
namespace {

constexpr std::uint32_t kMultiPart = 0x1000;
constexpr std::size_t kLongestName = 255;

/// Reads forward through the file, never past its end.
class Cursor {
  public:
    explicit Cursor(const InputFile& file) : file_(file) {}

    std::size_t remaining() const { return file_.size() - offset_; }

    void read(void* data, std::size_t bytes) {
        if (bytes > remaining()) truncated();
        while (bytes > 0) {
            if (offset_ < block_start_ || offset_ >= block_start_ + block_bytes_) {
                block_start_ = offset_;
                block_bytes_ = file_.read(block_.data(), block_.size(), offset_);
                if (block_bytes_ == 0) truncated();
            }
            const std::size_t at = offset_ - block_start_;
            const std::size_t part = std::min(bytes, block_bytes_ - at);
            std::memcpy(data, block_.data() + at, part);
            data = static_cast<char*>(data) + part;
            offset_ += part;
            bytes -= part;
        }
    }

    void skip(std::size_t bytes) {
        if (bytes > remaining()) truncated();
        offset_ += bytes;
    }

    std::uint32_t read_u32() {
        std::array<unsigned char, 4> b = {};
        read(b.data(), b.size());
        return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 |
               std::uint32_t{b[3]} << 24;
    }
    std::int32_t read_i32() { return static_cast<std::int32_t>(read_u32()); }

    std::string read_name() {
        std::string name;
        for (char c = 0; read(&c, 1), c != 0;) {
            if (name.size() == kLongestName) {
                throw Error(ErrorCode::data, "is corrupt: a name in its header never ends",
                            file_.name());
            }
            name += c;
        }
        return name;
    }

    [[noreturn]] void truncated() const {
        throw Error(ErrorCode::data, "is truncated or corrupt: its header leads past the end",
                    file_.name());
    }

  private:
    const InputFile& file_;
    std::size_t offset_ = 0;
    std::array<char, 4096> block_ = {};
    std::size_t block_start_ = 0;
    std::size_t block_bytes_ = 0;
};

struct PartHeader {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t tile_width = 0;
    std::uint64_t tile_height = 0;
    std::uint64_t rows_per_chunk = 1;
    bool empty = true;
};

// How many rows OpenEXR compresses together, by its number of the compression.
std::uint64_t rows_per_chunk(unsigned char compression) {
    switch (compression) {
        case 3:  // zip
        case 5:  // pxr24
            return 16;
        case 4:  // piz
        case 6:  // b44
        case 7:  // b44a
        case 8:  // dwaa
            return 32;
        case 9:  // dwab
            return 256;
        default:  // none, rle, zips
            return 1;
    }
}

void read_window(Cursor& cursor, PartHeader& part) {
    const std::int64_t x0 = cursor.read_i32();
    const std::int64_t y0 = cursor.read_i32();
    const std::int64_t x1 = cursor.read_i32();
    const std::int64_t y1 = cursor.read_i32();
    part.width = x1 < x0 ? 0 : static_cast<std::uint64_t>(x1 - x0 + 1);
    part.height = y1 < y0 ? 0 : static_cast<std::uint64_t>(y1 - y0 + 1);
}

PartHeader read_part(Cursor& cursor) {
    PartHeader part;
    for (std::string name; !(name = cursor.read_name()).empty();) {
        part.empty = false;
        const std::string type = cursor.read_name();
        const std::uint32_t bytes = cursor.read_u32();
        if (bytes > cursor.remaining()) cursor.truncated();
        if (name == "dataWindow" && type == "box2i" && bytes == 16) {
            read_window(cursor, part);
        } else if (name == "tiles" && type == "tiledesc" && bytes == 9) {
            part.tile_width = cursor.read_u32();
            part.tile_height = cursor.read_u32();
            cursor.skip(1);
        } else if (name == "compression" && type == "compression" && bytes == 1) {
            unsigned char compression = 0;
            cursor.read(&compression, 1);
            part.rows_per_chunk = rows_per_chunk(compression);
        } else {
            cursor.skip(bytes);
        }
    }
    return part;
}

// Returns the number of chunks of the part's largest level.
std::uint64_t check_part(const PartHeader& part, const InputFile& file, std::size_t max_memory) {
    require_picture_memory(part.width, part.height, max_memory, file.name());
    const auto pieces = [](std::uint64_t size, std::uint64_t piece) {
        return (size + piece - 1) / piece;
    };
    if (part.tile_width == 0 || part.tile_height == 0) {
        return pieces(part.height, part.rows_per_chunk);
    }
    require_usual_tiles(part.tile_width, part.tile_height, part.width, part.height, file.name());
    return pieces(part.width, part.tile_width) * pieces(part.height, part.tile_height);
}

}  // namespace

void check_exr_header(const InputFile& file, std::size_t max_memory) {
    Cursor cursor(file);
    cursor.skip(4);
    const std::uint32_t version = cursor.read_u32();
    const bool multi_part = (version & kMultiPart) != 0;
    std::uint64_t chunks = 0;
    for (;;) {
        const PartHeader part = read_part(cursor);
        if (multi_part && part.empty) break;
        chunks += check_part(part, file, max_memory);
        if (!multi_part) break;
    }
    constexpr std::uint64_t kTableEntry = 8;
    if (chunks > cursor.remaining() / kTableEntry) {
        throw Error(ErrorCode::data,
                    fmt::format("is truncated or corrupt: {} cannot hold its {} chunks",
                                format_bytes(file.size()), chunks),
                    file.name());
    }
}

}  // namespace airlight::detail
