// SPDX-License-Identifier: Apache-2.0
// Inputs and outputs that must be refused, each with its own sentence.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/memory.h"
#include "envmap/info.h"
#include "envmap/io.h"
#include "tests/envmap/image_files.h"

namespace airlight {
namespace {

struct Refusal {
    ErrorCode code = ErrorCode::usage;
    std::string what = "not refused";
};

Refusal refusal(const std::string& path, const ReadOptions& options = {}) {
    const auto start = std::chrono::steady_clock::now();
    Refusal result;
    try {
        read_image(path, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), path);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        result = {error.code(), error.what()};
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1)) << path;
    return result;
}

void expect_refused(const std::string& path, ErrorCode code, const std::string& what,
                    const ReadOptions& options = {}) {
    const Refusal result = refusal(path, options);
    EXPECT_EQ(result.code, code) << path << ": " << result.what;
    EXPECT_NE(result.what.find(what), std::string::npos) << path << ": " << result.what;
}

TEST(BadInput, WhatIsNoImageIsSaidInOneSentence) {
    const ScratchDirectory directory;
    write_bytes(directory / "empty.exr", "");
    write_bytes(directory / "text.exr", "hello, world\n");
    write_bytes(directory / "one", "#");
    write_bytes(directory / "magic.exr", "\x76\x2f\x31\x01");
    expect_refused(directory / "missing.exr", ErrorCode::io, "does not exist");
    expect_refused(directory / "text.exr/in.exr", ErrorCode::io, "Not a directory");
    expect_refused(directory.path(), ErrorCode::io, "is a directory");
    expect_refused(directory / "empty.exr", ErrorCode::data, "is empty");
    expect_refused(directory / "text.exr", ErrorCode::data,
                   "is no OpenEXR, Radiance .hdr, .pfm or TIFF image");
    expect_refused(directory / "one", ErrorCode::data, "is no OpenEXR");
    expect_refused(directory / "magic.exr", ErrorCode::data, "its header leads past the end");
    expect_refused("/dev/null", ErrorCode::data, "is empty");
    ReadOptions small;
    small.max_memory = 1 << 20;
    // Without copying it first.
    expect_refused("/dev/zero", ErrorCode::data, "is no OpenEXR", small);
    EXPECT_THROW(probe_image(directory / "text.exr"), Error);
}

TEST(BadInput, HeadersThatClaimTooMuchAreRefusedBeforeAnythingIsAllocated) {
    const ScratchDirectory directory;
    const std::size_t before = peak_memory();
    const auto write = [&](const char* name, const std::string& bytes) {
        write_bytes(directory / name, bytes);
        return directory / name;
    };
    const char* limit = "more than the limit of 2 GiB (--max-memory)";
    expect_refused(write("a.exr", exr_header(1000000000, 1000000000)), ErrorCode::memory, limit);
    expect_refused(write("a.hdr", hdr_header(1000000000, 1000000000)), ErrorCode::memory, limit);
    expect_refused(write("a.pfm", pfm_header(1000000000, 1000000000)), ErrorCode::memory, limit);
    // libtiff itself refuses this one, since the size of the strip overflows.
    expect_refused(write("a.tif", tiff_header(1000000000, 1000000000)), ErrorCode::data, "");
    expect_refused(write("b.exr", exr_header(60000, 30000)), ErrorCode::memory,
                   "a picture of 60000 × 30000 pixels needs 20.1 GiB");
    expect_refused(write("b.hdr", hdr_header(60000, 30000)), ErrorCode::memory, limit);
    expect_refused(write("b.pfm", pfm_header(60000, 30000)), ErrorCode::memory, limit);
    expect_refused(write("b.tif", tiff_header(60000, 30000)), ErrorCode::memory, limit);
    expect_refused(write("c.pfm", pfm_header(99999999999999, 99999999999999)), ErrorCode::memory,
                   "more than this machine can address");
    // Under the limit, but not in the file.
    expect_refused(write("d.exr", exr_header(18000, 9000)), ErrorCode::data,
                   "cannot hold its 9000 chunks");
    expect_refused(write("d.hdr", hdr_header(18000, 9000)), ErrorCode::data, "truncated");
    expect_refused(write("d.pfm", pfm_header(18000, 9000)), ErrorCode::data, "truncated");
    expect_refused(write("d.tif", tiff_header(18000, 9000)), ErrorCode::data, "");
    expect_refused(write("e.exr", exr_header(32, 16, 1000000000)), ErrorCode::data,
                   "tiles of 1000000000 × 1000000000 pixels in a picture of 32 × 16");
    expect_refused(write("f.exr", exr_header(0, 16)), ErrorCode::data, "has no pixels");
    expect_refused(write("f.pfm", pfm_header(0, 0)), ErrorCode::data, "has no pixels");
    EXPECT_LT(peak_memory(), before + (std::size_t{64} << 20));
}

TEST(BadInput, AnAttributeLongerThanTheFileIsRefused) {
    const ScratchDirectory directory;
    std::string bytes = exr_header(32, 16);
    bytes.pop_back();
    bytes += Bytes().name("owner").name("string").u32(0x7fffffff).text("short").str();
    write_bytes(directory / "a.exr", bytes);
    expect_refused(directory / "a.exr", ErrorCode::data, "its header leads past the end");
}

TEST(BadInput, ThePixelLimitIsInclusive) {
    const ScratchDirectory directory;
    write_with_oiio(directory / "a.exr", {}, make_map(64, 32));
    ReadOptions options;
    options.max_memory = 64 * 32 * 12;
    EXPECT_NO_THROW(read_image(directory / "a.exr", options));
    --options.max_memory;
    expect_refused(directory / "a.exr", ErrorCode::memory,
                   "a picture of 64 × 32 pixels needs 24 KiB", options);
}

class Truncation : public testing::TestWithParam<FileKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Truncation,
                         testing::Values(FileKind{"a.exr"}, FileKind{"a.exr", "openexr", "zip"},
                                         FileKind{"a.exr", "openexr", "dwab", 0, true},
                                         FileKind{"a.exr", "openexr", "piz", 16},
                                         FileKind{"a.hdr", "hdr"},
                                         FileKind{"a.tif", "tiff", "none"},
                                         FileKind{"a.tif", "tiff", "zip"},
                                         FileKind{"a.pfm", "pfm"}));

TEST_P(Truncation, IsRefusedWhereverTheFileEnds) {
    const ScratchDirectory directory;
    const Image map = make_map(64, 32);
    const std::string path = directory / GetParam().name;
    if (std::string(GetParam().format) == "pfm") {
        write_image(path, map);
    } else {
        write_with_oiio(path, GetParam(), map);
    }
    const std::string whole = read_bytes(path);
    ASSERT_NO_THROW(read_image(path));
    // TIFF keeps its directory behind the pixels, so its last bytes may be padding nobody reads.
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 60);
    for (std::size_t size = 0; size < whole.size() - 8; size += step) {
        write_bytes(directory / "cut", whole.substr(0, size));
        const Refusal result = refusal(directory / "cut");
        EXPECT_EQ(result.code, ErrorCode::data) << size << ": " << result.what;
    }
}

TEST(BadInput, NonfinitePixelsAreCountedAndTheFirstIsNamed) {
    const ScratchDirectory directory;
    Image map = make_map();
    map.at(3, 7, 1) = NAN;
    map.at(9, 0, 2) = INFINITY;
    write_with_oiio(directory / "a.exr", {}, map);
    expect_refused(directory / "a.exr", ErrorCode::data,
                   "holds 2 non-finite values, the first (NaN) at row 3, column 7, channel G "
                   "(--nonfinite=zero makes them 0)");
    Image grey = make_map(32, 16, 1);
    grey.at(15, 31, 0) = -INFINITY;
    write_with_oiio(directory / "grey.exr", {}, grey);
    expect_refused(directory / "grey.exr", ErrorCode::data,
                   "holds 1 non-finite value, the first (-infinity) at row 15, column 31, "
                   "channel Y");
}

TEST(BadInput, OtherShapesNeedTheLayout) {
    const ScratchDirectory directory;
    write_with_oiio(directory / "a.exr", {}, make_map(30, 16));
    expect_refused(directory / "a.exr", ErrorCode::data,
                   "is 30 × 16 pixels, but a lat-long map is twice as wide as high "
                   "(--layout latlong takes any shape)");
    ReadOptions any;
    any.allow_any_aspect = true;
    EXPECT_EQ(read_image(directory / "a.exr", any).width, 30);
}

TEST(BadInput, MissingColoursAreNamed) {
    const ScratchDirectory directory;
    write_with_oiio(directory / "a.exr", {}, make_map(32, 16, 4), {"R", "G", "Z", "A"});
    expect_refused(directory / "a.exr", ErrorCode::data,
                   "has no channel B; its channels are R, G, A, Z");
    write_with_oiio(directory / "b.exr", {}, make_map(32, 16, 3), {"v.R", "v.G", "v.B"});
    expect_refused(directory / "b.exr", ErrorCode::data, "has no channel R; its channels are v.R");
    write_with_oiio(directory / "c.exr", {}, make_map(32, 16, 2), {"u", "v"});
    expect_refused(directory / "c.exr", ErrorCode::data, "has no channel R");
}

TEST(BadInput, DeepImagesAreRefused) {
    const ScratchDirectory directory;
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeFloat);
    spec.deep = true;
    OIIO::DeepData deep(spec);
    for (std::int64_t pixel = 0; pixel < 32 * 16; ++pixel) deep.set_samples(pixel, 1);
    const auto writer = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(writer->open(directory / "deep.exr", spec));
    ASSERT_TRUE(writer->write_deep_image(deep));
    ASSERT_TRUE(writer->close());
    expect_refused(directory / "deep.exr", ErrorCode::data,
                   "is a deep image, which is not supported");
    EXPECT_TRUE(probe_image(directory / "deep.exr").deep);
}

TEST(BadInput, WhatIsNotUprightOrNotRgbIsRefused) {
    const ScratchDirectory directory;
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeFloat);
    spec.attribute("Orientation", 4);
    const auto writer = OIIO::ImageOutput::create("tiff");
    ASSERT_TRUE(writer->open(directory / "a.tif", spec));
    ASSERT_TRUE(writer->write_image(OIIO::TypeFloat, make_map().pixels.data()));
    ASSERT_TRUE(writer->close());
    expect_refused(directory / "a.tif", ErrorCode::data, "is not stored upright (orientation 4)");

    write_with_oiio(directory / "a.hdr", {"", "hdr"}, make_map());
    std::string bytes = read_bytes(directory / "a.hdr");
    bytes.replace(bytes.find("rle_rgbe"), 8, "rle_xyze");
    write_bytes(directory / "a.hdr", bytes);
    expect_refused(directory / "a.hdr", ErrorCode::data, "holds XYZ instead of R, G, B");
}

std::string write_refusal(const std::string& path, const Image& image, ErrorCode code,
                          const WriteOptions& options = {}) {
    try {
        write_image(path, image, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    return "not refused";
}

TEST(BadOutput, WhatTheFormatCannotHoldIsRefusedAndNothingIsWritten) {
    const ScratchDirectory directory;
    Image map = make_map();
    map.at(2, 2, 1) = 65505;
    map.at(2, 2, 2) = -1e6f;
    WriteOptions half;
    half.pixel_type = PixelType::half;
    EXPECT_EQ(write_refusal(directory / "a.exr", map, ErrorCode::data, half),
              "not written: 2 values up to 1e+06 exceed what half can hold (65504); write float "
              "instead");
    EXPECT_EQ(write_refusal(directory / "a.hdr", map, ErrorCode::data),
              "not written: 1 values are negative, which .hdr cannot hold (--negative=clamp, or "
              "write .exr)");
    map.at(2, 2, 2) = 2e38f;
    EXPECT_EQ(write_refusal(directory / "a.hdr", map, ErrorCode::data),
              "not written: the largest value 2e+38 exceeds what .hdr can hold (1.695e+38); write "
              ".exr");
    map.at(2, 2, 2) = NAN;
    EXPECT_EQ(write_refusal(directory / "a.exr", map, ErrorCode::data),
              "not written: 1 values are not finite");
    EXPECT_TRUE(directory.entries().empty());
}

TEST(BadOutput, UnknownFormatsAndOptionsAreUsageErrors) {
    const ScratchDirectory directory;
    const Image map = make_map();
    EXPECT_EQ(
        write_refusal(directory / "a.jpg", map, ErrorCode::usage),
        "has the unknown extension .jpg; images are written as .exr, .hdr, .pfm, .tif, .tiff");
    EXPECT_EQ(write_refusal(directory / "a.b/noext", map, ErrorCode::usage).rfind("has no ext", 0),
              0u);
    WriteOptions options;
    options.compression = "lzw";
    EXPECT_EQ(
        write_refusal(directory / "a.exr", map, ErrorCode::usage, options),
        "compression 'lzw' is unknown; it can be none, rle, zips, zip, piz, pxr24, b44, b44a, "
        "dwaa, dwab");
    options.compression = "zip:9";
    write_refusal(directory / "a.exr", map, ErrorCode::usage, options);
    options.compression = "zip";
    EXPECT_EQ(write_refusal(directory / "a.hdr", map, ErrorCode::usage, options),
              "compression 'zip' is unknown; it can be left out: the format has none");
    options.compression = "";
    options.pixel_type = PixelType::half;
    EXPECT_EQ(write_refusal(directory / "a.tif", map, ErrorCode::usage, options),
              "only .exr holds half pixels");
    EXPECT_THROW(write_layers(directory / "a.tif", {{"a", &map}, {"b", &map}}), Error);
    EXPECT_THROW(write_image(directory / "a.exr", Image(32, 16, 2)), Error);
    EXPECT_THROW(write_image(directory / "a.exr", Image()), Error);
    EXPECT_TRUE(directory.entries().empty());
}

TEST(BadOutput, CheckWritableSaysItBeforeTheWork) {
    const ScratchDirectory directory;
    write_bytes(directory / "old.exr", "old");
    EXPECT_NO_THROW(check_writable(directory / "new.exr", {}));
    EXPECT_NO_THROW(check_writable("-", {}));
    EXPECT_THROW(check_writable(directory / "old.exr", {}), Error);
    EXPECT_THROW(check_writable(directory / "no/new.exr", {}), Error);
    EXPECT_THROW(check_writable(directory / "new.png", {}), Error);
    WriteOptions force;
    force.force = true;
    EXPECT_NO_THROW(check_writable(directory / "old.exr", force));
    EXPECT_EQ(read_bytes(directory / "old.exr"), "old");
}

}  // namespace
}  // namespace airlight
