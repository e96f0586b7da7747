// SPDX-License-Identifier: Apache-2.0
#include "envmap/io.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

double largest_difference(const Image& a, const Image& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    double largest = 0;
    for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
        largest = std::max(largest, std::fabs(double{a.pixels[i]} - double{b.pixels[i]}));
    }
    return largest;
}

class LosslessReading : public testing::TestWithParam<FileKind> {};
INSTANTIATE_TEST_SUITE_P(
    Kinds, LosslessReading,
    testing::Values(FileKind{"none.exr"}, FileKind{"rle.exr", "openexr", "rle"},
                    FileKind{"zips.exr", "openexr", "zips"}, FileKind{"zip.exr", "openexr", "zip"},
                    FileKind{"piz.exr", "openexr", "piz"},
                    FileKind{"tiled.exr", "openexr", "zip", 16},
                    FileKind{"odd_tiles.exr", "openexr", "piz", 24, true},
                    FileKind{"half.exr", "openexr", "zip", 0, true},
                    FileKind{"pxr24half.exr", "openexr", "pxr24", 0, true},
                    FileKind{"none.tif", "tiff", "none"}, FileKind{"zip.tif", "tiff", "zip"},
                    FileKind{"tiled.tif", "tiff", "lzw", 16},
                    FileKind{"alpha.exr", "openexr", "zip", 0, false, 4}));

// 640 rows make three blocks of the reader, the last one short.
TEST_P(LosslessReading, GivesEveryValueExactly) {
    const ScratchDirectory directory;
    const Image map = make_map(1280, 640, GetParam().channels);
    write_with_oiio(directory / "in", GetParam(), map);
    ReadReport report;
    const Image read = read_image(directory / "in", {}, &report);
    ASSERT_EQ(read.width, 1280);
    ASSERT_EQ(read.height, 640);
    ASSERT_EQ(read.channels, 3);
    for (int row = 0; row < 640; ++row) {
        for (int column = 0; column < 1280; ++column) {
            for (int c = 0; c < 3; ++c) {
                ASSERT_EQ(read.at(row, column, c), map.at(row, column, c)) << row << ' ' << column;
            }
        }
    }
    EXPECT_EQ(report.negative + report.nonfinite, 0u);
    EXPECT_EQ(mentions(report.notes, "alpha dropped"), GetParam().channels == 4);
}

class LossyReading : public testing::TestWithParam<FileKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, LossyReading,
                         testing::Values(FileKind{"dwaa.exr", "openexr", "dwaa", 0, true},
                                         FileKind{"dwab.exr", "openexr", "dwab", 0, true},
                                         FileKind{"dwab_tiled.exr", "openexr", "dwab", 32, true},
                                         FileKind{"b44.exr", "openexr", "b44", 0, true},
                                         FileKind{"pxr24.exr", "openexr", "pxr24"},
                                         FileKind{"map.hdr", "hdr"}));

TEST_P(LossyReading, GivesASmoothPictureClosely) {
    const ScratchDirectory directory;
    Image map(128, 64, 3);
    for (int row = 0; row < 64; ++row) {
        for (int column = 0; column < 128; ++column) {
            for (int c = 0; c < 3; ++c) {
                map.at(row, column, c) =
                    static_cast<float>(1 + 0.5 * std::sin(0.1 * row + 0.05 * column + c));
            }
        }
    }
    write_with_oiio(directory / "in", GetParam(), map);
    // The coarsest, .hdr and DWA at their defaults, promise about 1 %.
    EXPECT_LT(largest_difference(read_image(directory / "in"), map), 0.02);
}

TEST(ReadImage, FindsTheFormatByContent) {
    const ScratchDirectory directory;
    const Image map = make_map();
    write_with_oiio(directory / "exr.hdr", {"", "openexr", "zip"}, map);
    write_with_oiio(directory / "tiff", {"", "tiff", "zip"}, map);
    EXPECT_EQ(read_image(directory / "exr.hdr").pixels, map.pixels);
    EXPECT_EQ(read_image(directory / "tiff").pixels, map.pixels);
}

TEST(ReadImage, SpreadsGreyAndDropsItsAlpha) {
    const ScratchDirectory directory;
    const Image grey = make_map(32, 16, 2);
    write_with_oiio(directory / "ya.exr", {}, grey, {"Y", "A"});
    ReadReport report;
    const Image read = read_image(directory / "ya.exr", {}, &report);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(read.at(3, 5, c), grey.at(3, 5, 0));
    EXPECT_TRUE(mentions(report.notes, "one channel (Y) spread"));
    EXPECT_TRUE(mentions(report.notes, "alpha dropped"));
    write_with_oiio(directory / "y.tif", {"", "tiff", "zip"}, make_map(32, 16, 1));
    EXPECT_EQ(read_image(directory / "y.tif").at(7, 9, 2), make_map(32, 16, 1).at(7, 9, 0));
}

TEST(ReadImage, PicksRedGreenBlueWhereverTheyAre) {
    const ScratchDirectory directory;
    const Image map = make_map(32, 16, 6);
    write_with_oiio(directory / "many.exr", {}, map, {"Z", "b", "N.X", "g", "r", "A"});
    ReadReport report;
    const Image read = read_image(directory / "many.exr", {}, &report);
    EXPECT_EQ(read.at(2, 3, 0), map.at(2, 3, 4));
    EXPECT_EQ(read.at(2, 3, 1), map.at(2, 3, 3));
    EXPECT_EQ(read.at(2, 3, 2), map.at(2, 3, 1));
    EXPECT_TRUE(mentions(report.notes, "other channels dropped: "));
    EXPECT_TRUE(mentions(report.notes, "N.X"));
}

TEST(ReadImage, TiffColoursAreNotMultipliedByAlpha) {
    const ScratchDirectory directory;
    const Image map = make_map(32, 16, 4);
    OIIO::ImageSpec spec(32, 16, 4, OIIO::TypeFloat);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto writer = OIIO::ImageOutput::create("tiff");
    ASSERT_TRUE(writer->open(directory / "a.tif", spec));
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, map.pixels.data()));
    ASSERT_TRUE(writer->close());
    EXPECT_EQ(read_image(directory / "a.tif").at(1, 2, 0), map.at(1, 2, 0));
}

TEST(ReadImage, TakesTheFirstPartAndTheLargestMipLevel) {
    const ScratchDirectory directory;
    const Image map = make_map();
    const OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeFloat);
    const OIIO::ImageSpec specs[2] = {spec, spec};
    auto writer = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(writer->open(directory / "parts.exr", 2, specs));
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, map.pixels.data()));
    ASSERT_TRUE(writer->open(directory / "parts.exr", spec, OIIO::ImageOutput::AppendSubimage));
    const std::vector<float> other(map.pixels.size(), 9.0f);
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, other.data()));
    ASSERT_TRUE(writer->close());
    writer.reset();
    ReadReport report;
    EXPECT_EQ(read_image(directory / "parts.exr", {}, &report).pixels, map.pixels);
    EXPECT_TRUE(mentions(report.notes, "first of 2 parts"));

    OIIO::ImageSpec level(32, 16, 3, OIIO::TypeFloat);
    level.tile_width = level.tile_height = 16;
    level.attribute("textureformat", "LatLong Environment");
    writer = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(writer->open(directory / "mip.exr", level));
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, map.pixels.data()));
    for (int width = 16; width >= 1; width /= 2) {
        level.width = level.full_width = width;
        level.height = level.full_height = std::max(1, width / 2);
        ASSERT_TRUE(writer->open(directory / "mip.exr", level, OIIO::ImageOutput::AppendMIPLevel));
        ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, other.data()));
        if (level.height == 1) break;
    }
    ASSERT_TRUE(writer->close());
    writer.reset();
    EXPECT_EQ(read_image(directory / "mip.exr", {}, &report).pixels, map.pixels);
    EXPECT_TRUE(mentions(report.notes, "largest mip level"));
}

TEST(ReadImage, CountsNegativePixelsAndClampsOnRequest) {
    const ScratchDirectory directory;
    Image map = make_map();
    map.at(1, 1, 0) = -2;
    map.at(4, 4, 2) = -0.5f;
    map.at(5, 5, 1) = 1e30f;
    write_with_oiio(directory / "in", {}, map);
    ReadReport report;
    EXPECT_EQ(read_image(directory / "in", {}, &report).pixels, map.pixels);
    EXPECT_EQ(report.negative, 2u);
    EXPECT_EQ(report.most_negative, -2);
    ReadOptions clamp;
    clamp.negative = NegativePolicy::clamp;
    map.at(1, 1, 0) = map.at(4, 4, 2) = 0;
    EXPECT_EQ(read_image(directory / "in", clamp, &report).pixels, map.pixels);
    EXPECT_EQ(report.negative, 2u);
}

TEST(ReadImage, ZeroesNonfinitePixelsOnRequest) {
    const ScratchDirectory directory;
    Image map = make_map();
    map.at(3, 7, 1) = NAN;
    map.at(9, 0, 2) = -INFINITY;
    write_with_oiio(directory / "in", {}, map);
    ReadOptions zero;
    zero.nonfinite = NonfinitePolicy::zero;
    ReadReport report;
    const Image read = read_image(directory / "in", zero, &report);
    map.at(3, 7, 1) = map.at(9, 0, 2) = 0;
    EXPECT_EQ(read.pixels, map.pixels);
    EXPECT_EQ(report.nonfinite, 2u);
    EXPECT_EQ(report.negative, 0u);
}

TEST(ReadImage, TakesStandardInputWithinTheLimit) {
    const ScratchDirectory directory;
    const Image map = make_map();
    write_with_oiio(directory / "in.exr", {}, map);
    const auto read_redirected = [&](const ReadOptions& options) {
        const std::string bytes = read_bytes(directory / "in.exr");
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        const int before = dup(0);
        dup2(ends[0], 0);
        close(ends[0]);
        // 8 KB fit into a pipe's buffer.
        EXPECT_EQ(write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
        close(ends[1]);
        Image image;
        std::string failure;
        try {
            image = read_image("-", options);
        } catch (const Error& error) {
            failure = error.describe();
        }
        dup2(before, 0);
        close(before);
        return std::pair{image, failure};
    };
    EXPECT_EQ(read_redirected({}).first.pixels, map.pixels);
    ReadOptions small;
    small.max_memory = 4096;
    EXPECT_EQ(read_redirected(small).second,
              "standard input: holds more than the limit of 4 KiB (--max-memory)");
}

TEST(Reading, PfmHeadersMayEndTheirLinesAsWindowsDoes) {
    const ScratchDirectory directory;
    Image map = make_map(8, 4);
    std::string bytes = "PF\r\n8 4\r\n-1.0\r\n";
    for (int row = map.height - 1; row >= 0; --row) {
        bytes.append(reinterpret_cast<const char*>(map.row(row)), 8 * 3 * sizeof(float));
    }
    std::ofstream(directory / "crlf.pfm", std::ios::binary) << bytes;
    EXPECT_EQ(read_image(directory / "crlf.pfm").pixels, map.pixels);
}

}  // namespace
}  // namespace airlight
