// SPDX-License-Identifier: Apache-2.0
// Pictures by viewer/fast.h.
#pragma once

#include <array>
#include <cstdint>

#include "core/progress.h"
#include "envmap/image.h"
#include "viewer/fast.h"

namespace airlight {

struct FastPictureOptions {
    int samples = 4;            ///< of each pixel, 1 … kLargestFastSamples
    int width = 0, height = 0;  ///< pixels; 0: the camera's
    bool layers = false;        ///< also make the picture of every layer
};

inline constexpr int kLargestFastSamples = 1 << 12;

struct FastPicture {
    Image image;  ///< linear radiance, row 0 on top
    /// Of each layer, by its number; empty unless asked for. Their sum is the image.
    std::array<Image, kRadianceLayerCount> layers;
    FastCounts counts;  ///< with what the renderer built
    std::uint64_t samples = 0;
};

/// Pixels are means over their area, of rays at the very places of viewer/reference_picture.h, so
/// that two pictures differ in their light alone. The same bytes for any number of threads. Counts
/// pixels at `progress`. Throws Error(usage) for options outside their domain, Error(memory) beyond
/// max_memory.
FastPicture render_fast(const World& world, const Plan& plan, const FastMethods& methods,
                        const FastPictureOptions& options,
                        std::size_t max_memory = kDefaultMaxMemory, Progress* progress = nullptr);

}  // namespace airlight
