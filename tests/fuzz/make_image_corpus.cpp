// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of corpus/image: one tiny picture in each format and layout that the reader
// knows. Usage: make_image_corpus DIRECTORY
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "envmap/io.h"

namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 16;

std::vector<float> make_pixels(int channels) {
    std::vector<float> pixels(static_cast<std::size_t>(kWidth * kHeight * channels));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = 0.125f * static_cast<float>(i % 97);
    }
    return pixels;
}

OIIO::ImageSpec make_spec(int channels, OIIO::TypeDesc type, const char* compression, int tile) {
    OIIO::ImageSpec spec(kWidth, kHeight, channels, type);
    spec.attribute("compression", compression);
    // Keeps today's date out of the file.
    spec.attribute("DateTime", 0);
    spec.attribute("tiff:write_exif", 0);
    spec.tile_width = spec.tile_height = tile;
    return spec;
}

void check(bool good, const std::string& path) {
    if (!good) throw std::runtime_error("cannot write " + path + ": " + OIIO::geterror());
}

void write(const std::string& path, const char* format, const OIIO::ImageSpec& spec) {
    const auto writer = OIIO::ImageOutput::create(format);
    check(writer != nullptr && writer->open(path, spec) &&
              writer->write_image(OIIO::TypeFloat, make_pixels(spec.nchannels).data()) &&
              writer->close(),
          path);
}

void write_parts(const std::string& path) {
    const auto writer = OIIO::ImageOutput::create("openexr");
    const OIIO::ImageSpec spec = make_spec(3, OIIO::TypeHalf, "zips", 0);
    const OIIO::ImageSpec specs[2] = {spec, spec};
    const std::vector<float> pixels = make_pixels(3);
    check(writer != nullptr && writer->open(path, 2, specs) &&
              writer->write_image(OIIO::TypeFloat, pixels.data()) &&
              writer->open(path, spec, OIIO::ImageOutput::AppendSubimage) &&
              writer->write_image(OIIO::TypeFloat, pixels.data()) && writer->close(),
          path);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_image_corpus DIRECTORY\n");
        return 2;
    }
    try {
        OIIO::attribute("debug", 0);
        const std::string directory = std::string(arguments[1]) + "/";
        write(directory + "zip.exr", "openexr", make_spec(3, OIIO::TypeFloat, "zip", 0));
        write(directory + "dwaa.exr", "openexr", make_spec(3, OIIO::TypeHalf, "dwaa", 0));
        write(directory + "dwab.exr", "openexr", make_spec(3, OIIO::TypeHalf, "dwab", 0));
        write(directory + "b44.exr", "openexr", make_spec(3, OIIO::TypeHalf, "b44", 0));
        write(directory + "pxr24.exr", "openexr", make_spec(3, OIIO::TypeFloat, "pxr24", 0));
        write(directory + "rle_rgba.exr", "openexr", make_spec(4, OIIO::TypeHalf, "rle", 0));
        write(directory + "piz_tiled.exr", "openexr", make_spec(3, OIIO::TypeHalf, "piz", 8));
        write_parts(directory + "parts.exr");
        write(directory + "rle.hdr", "hdr", make_spec(3, OIIO::TypeFloat, "", 0));
        write(directory + "zip.tif", "tiff", make_spec(3, OIIO::TypeFloat, "zip", 0));
        write(directory + "grey_tiled.tif", "tiff", make_spec(1, OIIO::TypeUInt16, "lzw", 16));
        airlight::Image picture(kWidth, kHeight, 3);
        picture.pixels = make_pixels(3);
        airlight::WriteOptions options;
        options.force = true;
        airlight::write_image(directory + "map.pfm", picture, options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_image_corpus: %s\n", error.what());
        return 1;
    }
    return 0;
}
