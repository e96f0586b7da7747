// SPDX-License-Identifier: Apache-2.0
#include "envmap/info.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/threads.h"
#include "envmap/io.h"
#include "envmap/latlong.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

TEST(ProbeImage, TellsWhatTheHeaderSays) {
    const ScratchDirectory directory;
    write_with_oiio(directory / "a.exr", {"", "openexr", "dwab", 32, true, 4}, make_map(64, 32, 4));
    const ImageInfo info = probe_image(directory / "a.exr");
    EXPECT_EQ(info.format, "openexr");
    EXPECT_EQ(info.width, 64);
    EXPECT_EQ(info.height, 32);
    EXPECT_EQ(info.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(info.pixel_type, "half");
    EXPECT_EQ(info.compression.substr(0, 4), "dwab");
    EXPECT_TRUE(info.tiled);
    EXPECT_EQ(info.tile_width, 32);
    EXPECT_EQ(info.mip_levels, 1);
    EXPECT_EQ(info.parts, 1);
    EXPECT_FALSE(info.deep);
    EXPECT_EQ(info.file_bytes, std::filesystem::file_size(directory / "a.exr"));
}

TEST(ProbeImage, KnowsTheOtherFormats) {
    const ScratchDirectory directory;
    const Image map = make_map();
    for (const auto& [name, format] :
         {std::pair{"a.hdr", "hdr"}, {"a.pfm", "pfm"}, {"a.tif", "tiff"}}) {
        write_image(directory / name, map);
        const ImageInfo info = probe_image(directory / name);
        EXPECT_EQ(info.format, format);
        EXPECT_EQ(info.width, 32);
        EXPECT_EQ(info.height, 16);
        EXPECT_EQ(info.channels, (std::vector<std::string>{"R", "G", "B"}));
        EXPECT_EQ(info.pixel_type, "float");
        EXPECT_FALSE(info.tiled);
    }
}

TEST(ProbeImage, ShowsAttributesAsText) {
    const ScratchDirectory directory;
    WriteOptions options;
    options.attributes = {{"airlight:method", std::string("full")},
                          {"airlight:opticalThickness", 0.5f},
                          {"airlight:order", 6}};
    write_image(directory / "a.exr", make_map(), options);
    ImageMetadata metadata;
    metadata.attributes = probe_image(directory / "a.exr").attributes;
    const auto text = [&](const char* name) {
        const Attribute* attribute = metadata.find(name);
        return attribute != nullptr ? to_text(*attribute) : "absent";
    };
    EXPECT_EQ(text("airlight:method"), "full");
    EXPECT_EQ(text("airlight:opticalThickness"), "0.5");
    EXPECT_EQ(text("airlight:order"), "6");
    EXPECT_EQ(text("screenWindowCenter"), "0, 0");
    EXPECT_EQ(to_text({"x", std::vector<unsigned char>{1, 2}, "float[8]"}), "2 bytes");
}

TEST(ImageMetadata, SetReplacesByName) {
    ImageMetadata metadata;
    metadata.set({"a", 1});
    metadata.set({"b", 2});
    metadata.set({"a", 3});
    ASSERT_EQ(metadata.attributes.size(), 2u);
    EXPECT_EQ(std::get<int>(metadata.find("a")->value), 3);
    EXPECT_EQ(metadata.find("c"), nullptr);
}

TEST(ImageStatistics, MeansAreWeightedBySolidAngle) {
    // The mean of 1 + cos θ over the sphere is 1, of cos²θ 1/3; pixels at their centre's value are
    // off by π²/(24·256²)·… ≈ 1e-5 for the latter; the constant one only by 512 roundings a row.
    Image map(512, 256, 3);
    for (int row = 0; row < 256; ++row) {
        const double cosine = std::cos(row_colatitude(row, 256));
        for (int column = 0; column < 512; ++column) {
            map.at(row, column, 0) = static_cast<float>(1 + cosine);
            map.at(row, column, 1) = static_cast<float>(cosine * cosine);
            map.at(row, column, 2) = 2.5f;
        }
    }
    const ImageStatistics statistics = image_statistics(map);
    ASSERT_EQ(statistics.channels.size(), 3u);
    EXPECT_NEAR(statistics.channels[0].mean, 1, 1e-7);
    EXPECT_NEAR(statistics.channels[1].mean, 1.0 / 3, 2e-5);
    EXPECT_NEAR(statistics.channels[2].mean, 2.5, 1e-14);
    EXPECT_EQ(statistics.channels[2].minimum, 2.5f);
    EXPECT_EQ(statistics.channels[2].maximum, 2.5f);
}

TEST(ImageStatistics, FindsTheSunAndCountsTheBad) {
    Image map = make_map(64, 32);
    map.at(5, 16, 0) = map.at(5, 16, 1) = 1e5f;
    map.at(20, 3, 2) = -4;
    map.at(21, 3, 2) = NAN;
    map.at(21, 4, 2) = INFINITY;
    const ImageStatistics statistics = image_statistics(map);
    EXPECT_EQ(statistics.nonfinite, 2u);
    EXPECT_EQ(statistics.negative, 1u);
    EXPECT_EQ(statistics.channels[0].maximum, 1e5f);
    EXPECT_EQ(statistics.channels[2].minimum, -4);
    EXPECT_TRUE(std::isfinite(statistics.channels[2].mean));
    EXPECT_EQ(statistics.brightest_row, 5);
    EXPECT_EQ(statistics.brightest_column, 16);
    EXPECT_EQ(statistics.brightest_direction, pixel_direction(5, 16, 64, 32));
    EXPECT_GT(statistics.brightest_direction[0], 0.4);
}

TEST(ImageStatistics, DoNotDependOnThreads) {
    const Image map = make_map(200, 100);
    const ImageStatistics all = image_statistics(map);
    const ThreadLimit one(1);
    const ImageStatistics alone = image_statistics(map);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(all.channels[c].mean, alone.channels[c].mean);
}

TEST(ImageStatistics, OfNothingAreEmpty) {
    EXPECT_TRUE(image_statistics(Image()).channels.empty());
    Image map(2, 1, 1);
    map.pixels = {NAN, NAN};
    EXPECT_EQ(image_statistics(map).channels[0].mean, 0);
}

}  // namespace
}  // namespace airlight
