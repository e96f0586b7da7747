// SPDX-License-Identifier: Apache-2.0
// Reading and writing HDR pictures: OpenEXR (any compression, tiled or not), Radiance .hdr,
// .pfm and TIFF, through OpenImageIO.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/checked.h"
#include "envmap/image.h"

namespace airlight {

/// What to do with NaN and infinite pixels.
enum class NonfinitePolicy {
    refuse,  ///< an Error that gives their number and the first one's row, column and channel
    zero,    ///< they become 0 and are counted
};

/// What to do with negative pixels, which lossy EXR compression leaves behind.
enum class NegativePolicy {
    keep,   ///< they stay and are counted
    clamp,  ///< they become 0 and are counted
};

struct ReadOptions {
    std::size_t max_memory = kDefaultMaxMemory;  ///< bytes that the decoded picture may occupy
    NonfinitePolicy nonfinite = NonfinitePolicy::refuse;
    NegativePolicy negative = NegativePolicy::keep;
    bool allow_any_aspect = false;  ///< `--layout latlong`: take any shape for a lat-long map
    bool offer_any_aspect = true;   ///< the message that refuses another shape names that flag
};

/// What a reader saw and did on the way, for the log and for `--json`.
struct ReadReport {
    std::uint64_t nonfinite = 0;     ///< values that were not finite (now 0)
    std::uint64_t negative = 0;      ///< values below 0 in the file
    float most_negative = 0;         ///< the least of them
    std::vector<std::string> notes;  ///< sentences: alpha dropped, grey spread, more parts …
};

/// Reads a lat-long environment map as three channels R, G, B.
///
/// The format is found by content, so a wrong or missing extension does no harm; "-" reads
/// standard input, up to `max_memory` bytes of it. Values are as in the file: half and 32-bit float
/// exactly, integers divided by their largest value. One-channel maps are spread to R, G, B; alpha
/// and other channels are dropped; of several parts or mip levels the first is taken; each with a
/// note in the report.
///
/// Throws Error naming the file:
///   io      it is missing, a directory, or cannot be read;
///   data    it is empty, no image, truncated or corrupt, deep, lacks R, G or B, is not twice as
///           wide as high (unless allow_any_aspect), is not stored upright, or holds non-finite
///           pixels (unless NonfinitePolicy::zero);
///   memory  the decoded picture would exceed max_memory. This is checked on the header, and memory
///           is filled only as pixels arrive.
Image read_image(const std::string& path, const ReadOptions& options = {},
                 ReadReport* report = nullptr);

/// How a pixel value is stored in a file.
enum class PixelType {
    half,     ///< 16 bits: 11 significant bits, at most 65504
    float32,  ///< 32 bits: the picture's own values, exactly
};

struct WriteOptions {
    PixelType pixel_type = PixelType::float32;
    /// EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab, the last two perhaps with a
    /// level as "dwaa:45". TIFF: none, zip or lzw. Empty: zip for these two.
    std::string compression;
    /// Replace an existing file.
    bool force = false;
    /// Set over the picture's own; "Software" is ours in any case.
    std::vector<Attribute> attributes;
};

/// What a writer did that the user should know.
struct WriteReport {
    std::uint64_t bytes = 0;         ///< size of the file
    std::vector<std::string> notes;  ///< sentences: precision that the format does not keep …
};

/// The extensions that write_image knows, for messages: ".exr, .hdr, .pfm, .tif, .tiff".
const char* writable_formats();

/// Throws what write_image would throw before it writes: Error(usage) for an unknown extension or
/// a compression or pixel type that the format lacks, Error(io) when the target exists without
/// `force` or its directory cannot take a file. To be asked before a long computation.
void check_writable(const std::string& path, const WriteOptions& options);

/// Writes a picture of 1 or 3 channels; the extension chooses the format, and "-" writes OpenEXR to
/// standard output. The file appears whole or not at all (core/atomic_file.h), and equal pictures
/// and options give equal bytes.
///
/// EXR keeps everything. TIFF keeps 32-bit floats, and of the attributes only texts that it has a
/// tag for; .pfm keeps 32-bit floats alone. .hdr stores a shared exponent: each channel is off by
/// at most 1/256 (as measured by tests/envmap/io_test.cpp) of the pixel's brightest channel, and it
/// is refused when a pixel is negative or beyond 1.7e38.
///
/// Throws Error(usage|io) as check_writable, Error(data) for non-finite pixels, for values
/// that half cannot hold (above 65504; the message gives their number and the largest) and for
/// those that .hdr cannot hold; Error(io) when the disk is full.
void write_image(const std::string& path, const Image& image, const WriteOptions& options = {},
                 WriteReport* report = nullptr);

/// One named picture of a layered file.
struct ImageLayer {
    std::string name;
    const Image* image = nullptr;
};

/// Writes several pictures of one size into one part of one EXR (".exr" or "-"). The first layer
/// has the plain channels R, G, B, so that every viewer shows it; the others are NAME.R, NAME.G,
/// NAME.B, as compositors expect. The attribute "airlight:layers" lists the names in order.
/// Metadata comes from the first. Throws as write_image.
void write_layers(const std::string& path, const std::vector<ImageLayer>& layers,
                  const WriteOptions& options = {}, WriteReport* report = nullptr);

}  // namespace airlight
