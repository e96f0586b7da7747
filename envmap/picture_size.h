// SPDX-License-Identifier: Apache-2.0
// The size that a header claims, held against the memory limit; for the sources of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace airlight::detail {

/// Throws Error(data) for a picture without pixels and Error(memory) when its R, G, B in float
/// would exceed max_memory or its sides an int.
void require_picture_memory(std::uint64_t width, std::uint64_t height, std::size_t max_memory,
                            const std::string& where);

/// Throws Error(data) for tiles much larger than the picture: a reader allocates one whole. A small
/// picture may have tiles larger than itself, up to 1024 on a side. No tiles are 0 × 0.
void require_usual_tiles(std::uint64_t tile_width, std::uint64_t tile_height, std::uint64_t width,
                         std::uint64_t height, const std::string& where);

}  // namespace airlight::detail
