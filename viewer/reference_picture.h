// SPDX-License-Identifier: Apache-2.0
// Pictures by viewer/reference.h, or by viewer/path_tracer.h.
#pragma once

#include <array>
#include <cstdint>

#include "core/progress.h"
#include "envmap/image.h"
#include "viewer/path_tracer.h"
#include "viewer/reference.h"

namespace airlight {

/// How often light is scattered.
enum class Scattering { single, multiple };
inline constexpr NamedMethod<Scattering> kScatterings[] = {
    {Scattering::single, "single"},
    {Scattering::multiple, "multiple"},
};

struct ReferencePictureOptions {
    Scattering scattering = Scattering::single;
    ReferenceOptions reference;  ///< of single scattering
    PathTracerOptions paths;     ///< of multiple scattering, which takes no plan
    int samples = 16;            ///< of each pixel at most, 1 … kLargestSamples
    /// Standard error, relative to the brightest pixel, at which a pixel needs no more samples
    /// than the first kFirstSamples; 0 makes all. Of multiple scattering all pixels have as many,
    /// 8, 16, 32 …, until the noise of the picture is within it: bright paths are rare, and pixels
    /// that stopped before they met one left a street in fog 7 % darker at 0.02.
    double tolerance = 0;
    int width = 0, height = 0;  ///< pixels; 0: the camera's
    bool layers = false;        ///< also make the picture of every layer; of single scattering
};

inline constexpr int kLargestSamples = 1 << 20;
inline constexpr int kFirstSamples = 8;

struct ReferencePicture {
    Image image;  ///< linear radiance, row 0 on top
    /// Of each layer, by its number; empty unless asked for. Their sum is the image.
    std::array<Image, kRadianceLayerCount> layers;
    ReferenceCounts counts;
    std::uint64_t samples = 0;
    /// Standard error of the pixels' means as their samples show it, root of the mean square, over
    /// the brightest pixel.
    double noise = 0;
    std::uint64_t unfinished = 0;  ///< pixels above the tolerance
};

/// Pixels are means over their area, of samples that are the same for every number of threads.
/// Counts pixels at `progress`, twice where there is a tolerance. Throws Error(usage) for options
/// outside their domain, Error(memory) beyond max_memory.
ReferencePicture render_reference(const World& world, const Plan& plan,
                                  const ReferencePictureOptions& options,
                                  std::size_t max_memory = kDefaultMaxMemory,
                                  Progress* progress = nullptr);
/// With all that the scene holds.
ReferencePicture render_reference(const World& world, const ReferencePictureOptions& options,
                                  std::size_t max_memory = kDefaultMaxMemory,
                                  Progress* progress = nullptr);

}  // namespace airlight
