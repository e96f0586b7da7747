// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "core/threads.h"
#include "envmap/io.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

const std::vector<std::pair<std::string, std::string>> kLosslessOutputs = {
    {"default.exr", ""}, {"none.exr", "none"}, {"piz.EXR", "piz"},  {"zips.exr", "zips"},
    {"rle.exr", "rle"},  {"default.tif", ""},  {"lzw.tiff", "lzw"}, {"map.pfm", ""}};

Image make_extreme_map() {
    Image map = make_map(640, 320);
    map.at(0, 0, 0) = 1.0e5f;
    map.at(1, 0, 0) = 3.0e38f;
    map.at(2, 0, 0) = 1.0e-42f;
    map.at(3, 0, 0) = -0.125f;
    return map;
}

TEST(WriteImage, KeepsEveryBit) {
    const ScratchDirectory directory;
    const Image map = make_extreme_map();
    for (const auto& [name, compression] : kLosslessOutputs) {
        WriteOptions options;
        options.compression = compression;
        WriteReport report;
        write_image(directory / name, map, options, &report);
        EXPECT_TRUE(read_image(directory / name).pixels == map.pixels) << name;
        EXPECT_EQ(report.bytes, std::filesystem::file_size(directory / name));
        EXPECT_TRUE(report.notes.empty());
    }
    EXPECT_EQ(directory.entries().size(), kLosslessOutputs.size());
}

// A date in the file would show after a second.
TEST(WriteImage, GivesTheSameBytesAtAnyTimeAndWithAnyThreads) {
    const ScratchDirectory directory;
    const Image map = make_extreme_map();
    const auto write_all_kinds = [&](const std::string& prefix) {
        for (const auto& [name, compression] : kLosslessOutputs) {
            WriteOptions options;
            options.compression = compression;
            write_image(directory / (prefix + name), map, options);
        }
    };
    write_all_kinds("a_");
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    const ThreadLimit one(1);
    write_all_kinds("b_");
    for (const auto& [name, compression] : kLosslessOutputs) {
        EXPECT_TRUE(read_bytes(directory / ("a_" + name)) == read_bytes(directory / ("b_" + name)))
            << name;
    }
}

TEST(WriteImage, KeepsAttributesAndAddsOurs) {
    const ScratchDirectory directory;
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeFloat);
    spec.attribute("owner", "somebody");
    spec.attribute("DateTime", "2020:01:02 03:04:05");
    spec.attribute("Software", "other");
    spec.attribute("test:gain", 2.5f);
    spec.attribute("test:count", 7);
    const float primaries[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
    const auto writer = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(writer->open(directory / "in.exr", spec));
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, make_map().pixels.data()));
    ASSERT_TRUE(writer->close());

    WriteOptions options;
    options.compression = "piz";
    options.attributes = {{"airlight:opticalThickness", 1.5f},
                          {"airlight:method", std::string("full")},
                          {"test:count", 8}};
    write_image(directory / "out.exr", read_image(directory / "in.exr"), options);
    const auto file = OIIO::ImageInput::open(directory / "out.exr");
    ASSERT_TRUE(file);
    const OIIO::ImageSpec& out = file->spec();
    EXPECT_EQ(out.get_string_attribute("Copyright"), "somebody");
    EXPECT_EQ(out.get_string_attribute("DateTime"), "2020:01:02 03:04:05");
    EXPECT_EQ(out.get_string_attribute("Software").substr(0, 9), "airlight ");
    EXPECT_EQ(out.get_float_attribute("test:gain"), 2.5f);
    EXPECT_EQ(out.get_int_attribute("test:count"), 8);
    EXPECT_EQ(out.get_float_attribute("airlight:opticalThickness"), 1.5f);
    EXPECT_EQ(out.get_string_attribute("airlight:method"), "full");
    EXPECT_EQ(out.get_string_attribute("compression"), "piz");
    const auto* kept = out.find_attribute("chromaticities");
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(std::memcmp(kept->data(), primaries, sizeof primaries), 0);
}

TEST(WriteImage, WithoutADateThereIsNone) {
    const ScratchDirectory directory;
    for (const char* name : {"a.exr", "a.tif"}) {
        write_image(directory / name, make_map());
        const auto file = OIIO::ImageInput::open(directory / name);
        ASSERT_TRUE(file);
        EXPECT_EQ(file->spec().find_attribute("DateTime"), nullptr) << name;
    }
}

TEST(WriteImage, HalfRoundsToElevenBits) {
    const ScratchDirectory directory;
    Image map = make_map();
    map.at(0, 0, 0) = 65504;
    map.at(0, 1, 0) = 1e-10f;
    map.at(0, 2, 0) = 1 + 1.0f / 4096;
    WriteOptions options;
    options.pixel_type = PixelType::half;
    write_image(directory / "a.exr", map, options);
    map.at(0, 1, 0) = 0;
    map.at(0, 2, 0) = 1;
    EXPECT_EQ(read_image(directory / "a.exr").pixels, map.pixels);
}

TEST(WriteImage, RadianceIsOffByAtMost256thOfTheBrightestChannel) {
    const ScratchDirectory directory;
    Image map = make_map(512, 256);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        // All mantissas of the brightest channel, those about to round up included, and the other
        // channels up to 2⁻¹⁰ below.
        map.pixels[i] = std::ldexp(1 + static_cast<float>(i % 4099) / 4099.0f,
                                   static_cast<int>(i / 3 % 40) - 20 - static_cast<int>(i % 11));
    }
    map.at(0, 0, 0) = 1.69e38f;
    map.at(0, 0, 1) = map.at(0, 0, 2) = 0;
    WriteReport report;
    write_image(directory / "a.hdr", map, {}, &report);
    EXPECT_TRUE(mentions(report.notes, "1/256"));
    const Image read = read_image(directory / "a.hdr");
    double worst = 0;
    double bias = 0;
    for (std::size_t pixel = 0; pixel < map.pixels.size(); pixel += 3) {
        const double largest =
            std::max({map.pixels[pixel], map.pixels[pixel + 1], map.pixels[pixel + 2]});
        for (std::size_t c = 0; c < 3; ++c) {
            const double error =
                (double{read.pixels[pixel + c]} - double{map.pixels[pixel + c]}) / largest;
            worst = std::max(worst, std::fabs(error));
            bias += error / static_cast<double>(map.pixels.size());
        }
    }
    EXPECT_LE(worst, 1.0 / 256);
    EXPECT_GT(worst, 0.9 / 256);
    // Rounded; truncation would show as about −1/512 · ¾.
    EXPECT_LT(std::fabs(bias), 3e-4);
}

TEST(WriteImage, GreyStaysOneChannel) {
    const ScratchDirectory directory;
    for (const char* name : {"a.exr", "a.tif", "a.pfm"}) {
        const Image grey = make_map(32, 16, 1);
        write_image(directory / name, grey);
        ReadReport report;
        EXPECT_EQ(read_image(directory / name, {}, &report).at(5, 6, 1), grey.at(5, 6, 0));
        EXPECT_TRUE(mentions(report.notes, "one channel (Y)")) << name;
    }
}

TEST(WriteImage, StandardOutputGetsOpenExr) {
    const ScratchDirectory directory;
    const Image map = make_map();
    write_bytes(directory / "out", "");
    const int before = dup(1);
    ASSERT_NE(freopen((directory / "out").c_str(), "wb", stdout), nullptr);
    write_image("-", map);
    fflush(stdout);
    dup2(before, 1);
    close(before);
    EXPECT_EQ(read_image(directory / "out").pixels, map.pixels);
}

TEST(WriteLayers, TheFirstIsPlainAndTheOthersCarryTheirNames) {
    const ScratchDirectory directory;
    Image total = make_map();
    Image direct = make_map();
    Image scattered = make_map();
    for (float& value : direct.pixels) value *= 0.25f;
    for (float& value : scattered.pixels) value *= 0.75f;
    total.metadata.set({"owner", std::string("somebody")});
    write_layers(directory / "a.exr",
                 {{"total", &total}, {"direct", &direct}, {"scattered", &scattered}});
    EXPECT_EQ(read_image(directory / "a.exr").pixels, total.pixels);
    const auto file = OIIO::ImageInput::open(directory / "a.exr");
    ASSERT_TRUE(file);
    const OIIO::ImageSpec spec = file->spec();
    EXPECT_EQ(spec.nchannels, 9);
    EXPECT_EQ(spec.get_string_attribute("airlight:layers"), "total direct scattered");
    EXPECT_EQ(spec.get_string_attribute("Copyright"), "somebody");
    for (const auto& [layer, image] : {std::pair{"direct", &direct}, {"scattered", &scattered}}) {
        for (int c = 0; c < 3; ++c) {
            const int channel = spec.channelindex(std::string(layer) + "." + "RGB"[c]);
            ASSERT_GE(channel, 0);
            std::vector<float> plane(32 * 16);
            ASSERT_TRUE(
                file->read_image(0, 0, channel, channel + 1, OIIO::TypeFloat, plane.data()));
            for (std::size_t i = 0; i < plane.size(); ++i) {
                ASSERT_EQ(plane[i], image->pixels[3 * i + static_cast<std::size_t>(c)]);
            }
        }
    }
}

}  // namespace
}  // namespace airlight
