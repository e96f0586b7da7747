// SPDX-License-Identifier: Apache-2.0
// What an image file holds, from its header alone, and figures about a decoded map.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "envmap/image.h"

namespace airlight {

/// A file's header; nothing is decoded.
struct ImageInfo {
    std::string format;  ///< as OpenImageIO calls it: "openexr", "hdr", "pnm" (.pfm), "tiff"
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  ///< names in OpenImageIO's order, R G B A first
    std::string pixel_type;             ///< "half", "float", "uint8" …
    std::string compression;            ///< empty when the format has none
    bool tiled = false;
    int tile_width = 0;
    int tile_height = 0;
    int mip_levels = 1;
    int parts = 1;
    bool deep = false;
    std::uint64_t file_bytes = 0;
    std::vector<Attribute> attributes;  ///< all of the first part's
};

/// Reads the header of an image found by content; "-" is standard input. Throws Error as
/// read_image does for what is no readable image; shape, deep data and size are not judged.
ImageInfo probe_image(const std::string& path);

/// An attribute's value as text, for people: numbers in decimal, bytes by their layout's rules.
std::string to_text(const Attribute& attribute);

struct ChannelStatistics {
    float minimum = 0;  ///< of the finite values
    float maximum = 0;
    double mean = 0;  ///< weighted by solid angle: (1/4π)∫L dω over finite pixels
};

struct ImageStatistics {
    std::vector<ChannelStatistics> channels;
    std::uint64_t nonfinite = 0;  ///< values, not pixels
    std::uint64_t negative = 0;
    int brightest_row =
        0;  ///< the pixel with the largest mean of its channels, first in file order
    int brightest_column = 0;
    std::array<double, 3> brightest_direction = {};  ///< of its centre, unit, as latlong.h has it
};

/// Figures about a lat-long map, the same for any number of threads. A map without pixels has no
/// channels' figures; non-finite values are counted and otherwise left out.
ImageStatistics image_statistics(const Image& map);

}  // namespace airlight
