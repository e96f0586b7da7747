// SPDX-License-Identifier: Apache-2.0
#include "sh/brdf_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <thread>

#include "core/error.h"
#include "sh/brdf_models.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr BrdfSize kSmall = {6, 4, 8};

std::string header(std::int32_t half, std::int32_t difference, std::int32_t azimuth) {
    std::string bytes(12, '\0');
    const std::int32_t sides[3] = {half, difference, azimuth};
    for (int i = 0; i < 12; ++i) {
        bytes[static_cast<std::size_t>(i)] =
            static_cast<char>(static_cast<std::uint32_t>(sides[i / 4]) >> (8 * (i % 4)) & 255);
    }
    return bytes;
}

class BrdfFile : public testing::Test {
  protected:
    BrdfFile() { write_brdf(good_, tabulate(RoughMetal{}, kSmall), false); }

    void refuse(const std::string& path, ErrorCode code, const std::string& sentence,
                const BrdfReadOptions& options = {}) {
        try {
            read_brdf(path, options);
            ADD_FAILURE() << path << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), code) << error.describe();
            EXPECT_EQ(error.where(), path);
            EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos)
                << error.describe() << "\n"
                << sentence;
        }
    }
    void refuse_bytes(const std::string& bytes, const std::string& sentence) {
        write_bytes(directory_ / "bad", bytes);
        refuse(directory_ / "bad", ErrorCode::data, sentence);
    }

    const ScratchDirectory directory_;
    const std::string good_ = directory_ / "good.binary";
};

TEST_F(BrdfFile, ComesBackBitForBit) {
    BrdfTable table = tabulate(RoughMetal{}, kSmall);
    table.values[3] = -1e-300;
    table.values[4] = 5e-324;
    table.values[5] = -0.0;
    write_brdf(directory_ / "a", table, false);
    BrdfReadReport report;
    const BrdfTable back = read_brdf(directory_ / "a", {}, &report);
    EXPECT_EQ(back.size.half, 6);
    EXPECT_EQ(back.size.difference, 4);
    EXPECT_EQ(back.size.azimuth, 8);
    ASSERT_EQ(back.values.size(), table.values.size());
    EXPECT_EQ(std::memcmp(back.values.data(), table.values.data(), 8 * table.values.size()), 0);
    EXPECT_EQ(report.nonfinite, 0u);
}

TEST_F(BrdfFile, HasThePublishedLayout) {
    const std::string bytes = read_bytes(good_);
    ASSERT_EQ(bytes.size(), 12u + 3 * 6 * 4 * 8 * 8);
    EXPECT_EQ(bytes.substr(0, 12), header(6, 4, 8));
    // Green, theta_half 2, theta_diff 1, phi_diff 5.
    const std::size_t index = 6 * 4 * 8 + (2 * 4 + 1) * 8 + 5;
    double value = 0;
    std::memcpy(&value, bytes.data() + 12 + 8 * index, 8);
    const BrdfDirections at = brdf_directions(brdf_cell_centre(kSmall, 2, 1, 5));
    EXPECT_NEAR(value * 1.15 / 1500, evaluate_metal(RoughMetal{}, at.in, at.out).y, 1e-15);
}

TEST_F(BrdfFile, ExistingFilesAreReplacedByForceOnly) {
    const BrdfTable table = tabulate_lambertian(0.5, kSmall);
    EXPECT_THROW(write_brdf(good_, table, false), Error);
    write_brdf(good_, table, true);
    EXPECT_EQ(read_brdf(good_).values, table.values);
}

TEST_F(BrdfFile, ThatIsNoTableIsRefused) {
    std::filesystem::create_directory(directory_ / "sub");
    refuse(directory_ / "missing", ErrorCode::io, "does not exist");
    refuse(directory_ / "sub", ErrorCode::io, "is a directory");
    refuse(good_ + "/in", ErrorCode::io, "cannot be opened: Not a directory");
    refuse_bytes("", "is empty");
    refuse_bytes("hello", "is no BRDF table: it has 5 bytes, and the header alone takes 12");
    refuse_bytes("hello, world, this is text\n",
                 "is no BRDF table: it has 1819043176 cells of theta_half");
}

TEST_F(BrdfFile, OfAnotherLengthThanItsHeaderSaysIsRefused) {
    const std::string bytes = read_bytes(good_);
    for (const std::size_t length : {std::size_t{12}, std::size_t{13}, bytes.size() - 1}) {
        refuse_bytes(bytes.substr(0, length),
                     "is truncated: it has " + std::to_string(length) + " of 4620 bytes");
    }
    refuse_bytes(bytes + "x", "has 4621 bytes, 1 more than its header accounts for");
    refuse_bytes(bytes + bytes, "has 9240 bytes, 4620 more than its header accounts for");
}

TEST_F(BrdfFile, HeadersThatMakeNoSenseAreRefusedBeforeAnythingIsAllocated) {
    refuse_bytes(header(-90, 90, 180), "has -90 cells of theta_half, and 1 to 4096 are possible");
    refuse_bytes(header(90, 0, 0), "has 0 cells of theta_diff, and 1 to 4096 are possible");
    refuse_bytes(
        header(90, 90, 181),
        "has 181 cells of phi_diff, and with 90 of theta_diff only 180 or 360 are possible");
    refuse_bytes(header(2147483647, 2147483647, 2147483647), "cells of theta_half");
    refuse_bytes(header(-2147483647 - 1, 90, 180), "cells of theta_half");
    // 6.6 TB, of which the file has 12 bytes.
    refuse_bytes(header(4096, 4096, 16384), "is truncated: it has 12 of 6597069766668 bytes");
    BrdfReadOptions small;
    small.max_memory = 4000;
    refuse(good_, ErrorCode::memory, "--max-memory", small);
}

TEST_F(BrdfFile, RandomBytesAreRefused) {
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        std::string bytes(static_cast<std::size_t>(random() % 5000), '\0');
        for (char& byte : bytes) byte = static_cast<char>(random());
        // Every other file has a header that makes sense, and random values, NaN among them.
        if (round % 2 == 0) bytes = header(6, 4, 8) + bytes;
        write_bytes(directory_ / "bad", bytes);
        EXPECT_THROW(read_brdf(directory_ / "bad"), Error);
    }
}

TEST_F(BrdfFile, ValuesThatAreNoneAreCountedAndTheFirstIsNamed) {
    BrdfTable table = tabulate(RoughMetal{}, kSmall);
    const std::size_t index = 2 * kSmall.cells() + (3 * 4 + 2) * 8 + 1;
    table.values[index] = std::nan("");
    table.values[index + 9] = HUGE_VAL;
    table.values[index + 10] = -HUGE_VAL;
    write_brdf(directory_ / "nan", table, false);
    refuse(directory_ / "nan", ErrorCode::data,
           "holds 3 non-finite values, the first at channel B, theta_half 3, theta_diff 2, "
           "phi_diff 1 (--nonfinite=invalid");
    BrdfReadOptions options;
    options.nonfinite = BrdfNonfinite::invalid;
    BrdfReadReport report;
    const BrdfTable back = read_brdf(directory_ / "nan", options, &report);
    EXPECT_EQ(report.nonfinite, 3u);
    for (const std::size_t i : {index, index + 9, index + 10}) EXPECT_EQ(back.values[i], -1);

    table = tabulate(RoughMetal{}, kSmall);
    table.values[0] = 1e101;
    write_brdf(directory_ / "large", table, false);
    refuse(directory_ / "large", ErrorCode::data,
           "holds 1e+101 at channel R, theta_half 0, theta_diff 0, phi_diff 0, and values go to "
           "1e+100");
    write_brdf(directory_ / "none", BrdfTable(kSmall), false);
    refuse(directory_ / "none", ErrorCode::data, "holds no value");
}

TEST_F(BrdfFile, IsKnownByItsHeaderOrItsName) {
    std::filesystem::copy_file(good_, directory_ / "plain");
    EXPECT_TRUE(looks_like_brdf(directory_ / "plain"));
    EXPECT_TRUE(looks_like_brdf(directory_ / "missing.binary"));
    // The first bytes of EXR, RGBE, PFM, TIFF of both orders, PNG and JPEG.
    for (const std::string begin : {"\x76\x2f\x31\x01", "#?RADIANCE", "PF\n8 4\n", "II*", "MM",
                                    "\x89PNG", "\xff\xd8\xff\xe0"}) {
        write_bytes(directory_ / "image", begin + std::string(100, '\0'));
        EXPECT_FALSE(looks_like_brdf(directory_ / "image")) << begin;
    }
    EXPECT_FALSE(looks_like_brdf(directory_ / "missing"));
    write_bytes(directory_ / "short", header(90, 90, 180).substr(0, 11));
    EXPECT_FALSE(looks_like_brdf(directory_ / "short"));
}

TEST_F(BrdfFile, PipesAreReadUpToWhatTheirHeaderNames) {
    const std::string bytes = read_bytes(good_);
    const std::string pipe = directory_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const auto feed = [&](const std::string& content) {
        return std::thread([=] { write_bytes(pipe, content); });
    };
    std::thread writer = feed(bytes);
    EXPECT_EQ(read_brdf(pipe).values, read_brdf(good_).values);
    writer.join();
    writer = feed(bytes.substr(0, 1000));
    refuse(pipe, ErrorCode::data, "is truncated: it has 1000 of 4620 bytes");
    writer.join();
    writer = feed(bytes + "x");
    refuse(pipe, ErrorCode::data, "goes on beyond the 4620 bytes that its header accounts for");
    writer.join();
    writer = feed(header(4096, 4096, 8192) + "x");
    BrdfReadOptions options;
    options.max_memory = std::size_t{1} << 40;
    options.max_memory *= 16;
    refuse(pipe, ErrorCode::data, "is truncated: it has 13 of", options);
    writer.join();
}

}  // namespace
}  // namespace airlight
