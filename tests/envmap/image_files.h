// SPDX-License-Identifier: Apache-2.0
// Image files and headers for tests, made here byte by byte or through OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "envmap/image.h"
#include "tests/core/scratch_directory.h"

namespace airlight {

/// Smooth values of all magnitudes from 2⁻⁵ to 2⁵, exact in half; a lat-long map by default.
inline Image make_map(int width = 32, int height = 16, int channels = 3) {
    Image map(width, height, channels);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const auto step = static_cast<float>((i * 37) % 64);
        map.pixels[i] = (1 + step / 64) * std::ldexp(1.0f, static_cast<int>(i % 11) - 5);
    }
    return map;
}

/// Whether one of a report's notes holds that text.
inline bool mentions(const std::vector<std::string>& notes, const std::string& text) {
    for (const std::string& note : notes) {
        if (note.find(text) != std::string::npos) return true;
    }
    return false;
}

struct FileKind {
    const char* name;  ///< with the extension
    const char* format = "openexr";
    const char* compression = "none";
    int tile = 0;
    bool half = false;
    int channels = 3;
};

/// Writes a map through OpenImageIO itself, so that readers are not tested with our own writer.
inline void write_with_oiio(const std::string& path, const FileKind& kind, const Image& map,
                            const std::vector<std::string>& channel_names = {}) {
    OIIO::ImageSpec spec(map.width, map.height, map.channels,
                         kind.half ? OIIO::TypeHalf : OIIO::TypeFloat);
    if (!channel_names.empty()) spec.channelnames = channel_names;
    spec.attribute("compression", kind.compression);
    spec.tile_width = spec.tile_height = kind.tile;
    const auto writer = OIIO::ImageOutput::create(kind.format);
    if (!writer || !writer->open(path, spec) ||
        !writer->write_image(OIIO::TypeFloat, map.pixels.data()) || !writer->close()) {
        throw std::runtime_error("cannot make " + path + ": " + OIIO::geterror());
    }
}

/// Little-endian bytes, one after another.
class Bytes {
  public:
    Bytes& text(const std::string& value) {
        bytes_ += value;
        return *this;
    }
    Bytes& name(const std::string& value) { return text(value).u8(0); }
    Bytes& u8(unsigned value) {
        bytes_ += static_cast<char>(value);
        return *this;
    }
    Bytes& u16(std::uint32_t value) { return u8(value & 255).u8(value >> 8 & 255); }
    Bytes& u32(std::uint32_t value) { return u16(value & 65535).u16(value >> 16); }
    Bytes& f32(float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, 4);
        return u32(bits);
    }
    const std::string& str() const { return bytes_; }

  private:
    std::string bytes_;
};

/// The header of an OpenEXR file of half R, G, B and nothing behind it.
inline std::string exr_header(std::int32_t width, std::int32_t height, std::uint32_t tile = 0) {
    const auto window = [&](Bytes& bytes, const char* name) {
        bytes.name(name).name("box2i").u32(16).u32(0).u32(0);
        bytes.u32(static_cast<std::uint32_t>(width - 1));
        bytes.u32(static_cast<std::uint32_t>(height - 1));
    };
    Bytes bytes;
    bytes.u32(20000630).u32(tile > 0 ? 0x202 : 2);
    bytes.name("channels").name("chlist").u32(3 * 18 + 1);
    for (const char* channel : {"B", "G", "R"}) bytes.name(channel).u32(1).u32(0).u32(1).u32(1);
    bytes.u8(0);
    bytes.name("compression").name("compression").u32(1).u8(0);
    window(bytes, "dataWindow");
    window(bytes, "displayWindow");
    bytes.name("lineOrder").name("lineOrder").u32(1).u8(0);
    bytes.name("pixelAspectRatio").name("float").u32(4).f32(1);
    bytes.name("screenWindowCenter").name("v2f").u32(8).f32(0).f32(0);
    bytes.name("screenWindowWidth").name("float").u32(4).f32(1);
    if (tile > 0) bytes.name("tiles").name("tiledesc").u32(9).u32(tile).u32(tile).u8(0);
    bytes.u8(0);
    return bytes.str();
}

inline std::string hdr_header(std::uint64_t width, std::uint64_t height) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
           std::to_string(width) + "\n";
}

inline std::string pfm_header(std::uint64_t width, std::uint64_t height, const char* magic = "PF") {
    return std::string(magic) + "\n" + std::to_string(width) + " " + std::to_string(height) +
           "\n-1.0\n";
}

/// A TIFF of 32-bit float R, G, B in one strip that it does not hold.
inline std::string tiff_header(std::uint32_t width, std::uint32_t height) {
    Bytes bytes;
    bytes.text("II").u16(42).u32(8).u16(10);
    const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count,
                           std::uint32_t value) { bytes.u16(tag).u16(type).u32(count).u32(value); };
    entry(256, 4, 1, width);
    entry(257, 4, 1, height);
    entry(258, 3, 1, 32);
    entry(259, 3, 1, 1);
    entry(262, 3, 1, 2);
    entry(273, 4, 1, 200);
    entry(277, 3, 1, 3);
    entry(278, 4, 1, height);
    entry(279, 4, 1, 100);
    entry(339, 3, 1, 3);
    bytes.u32(0);
    return bytes.str() + std::string(200, '\0');
}

}  // namespace airlight
