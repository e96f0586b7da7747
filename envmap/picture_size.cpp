// SPDX-License-Identifier: Apache-2.0
#include "envmap/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/checked.h"
#include "core/error.h"

namespace airlight::detail {

void require_picture_memory(std::uint64_t width, std::uint64_t height, std::size_t max_memory,
                            const std::string& where) {
    if (width == 0 || height == 0) throw Error(ErrorCode::data, "has no pixels", where);
    constexpr std::uint64_t kLargestSide = std::numeric_limits<int>::max();
    constexpr std::uint64_t kPixelBytes = 3 * sizeof(float);
    if (width > kLargestSide || height > kLargestSide ||
        width > std::numeric_limits<std::uint64_t>::max() / kPixelBytes / height) {
        throw Error(
            ErrorCode::memory,
            fmt::format("{} × {} pixels are more than this machine can address", width, height),
            where);
    }
    require_memory(width * height * kPixelBytes, max_memory,
                   fmt::format("a picture of {} × {} pixels", width, height), where);
}

void require_usual_tiles(std::uint64_t tile_width, std::uint64_t tile_height, std::uint64_t width,
                         std::uint64_t height, const std::string& where) {
    constexpr std::uint64_t kUsualTile = 1024;
    if (tile_width <= std::max(width, kUsualTile) && tile_height <= std::max(height, kUsualTile)) {
        return;
    }
    throw Error(ErrorCode::data,
                fmt::format("is corrupt: tiles of {} × {} pixels in a picture of {} × {}",
                            tile_width, tile_height, width, height),
                where);
}

}  // namespace airlight::detail
