// SPDX-License-Identifier: Apache-2.0
// Damaged files must be refused or read, never crash, hang or take more memory than allowed.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <random>

#include "core/error.h"
#include "core/memory.h"
#include "envmap/info.h"
#include "envmap/io.h"
#include "tests/core/mutate.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

constexpr int kMutations = 1000;
constexpr std::size_t kLimit = std::size_t{16} << 20;

std::vector<std::string> seeds() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_IMAGE_CORPUS)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

class MutatedImage : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Seeds, MutatedImage, testing::ValuesIn(seeds()), [](const auto& seed) {
    std::string name = seed.param;
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
});

TEST_P(MutatedImage, IsReadOrRefused) {
    const ScratchDirectory directory;
    const std::string seed = read_bytes(std::string(AIRLIGHT_IMAGE_CORPUS) + "/" + GetParam());
    ReadOptions options;
    options.max_memory = kLimit;
    options.allow_any_aspect = true;
    write_bytes(directory / "in", seed);
    ASSERT_NO_THROW(read_image(directory / "in", options)) << "the seed itself must be good";
    const std::size_t before = peak_memory();
    std::mt19937 random(1);
    int refused = 0;
    for (int i = 0; i < kMutations; ++i) {
        write_bytes(directory / "in", mutate(seed, random));
        const auto start = std::chrono::steady_clock::now();
        try {
            const Image image = read_image(directory / "in", options);
            ASSERT_LE(image.bytes(), kLimit);
            ASSERT_EQ(image.channels, 3);
            for (const float value : image.pixels) ASSERT_TRUE(std::isfinite(value));
            probe_image(directory / "in");
        } catch (const Error& error) {
            ++refused;
            ASSERT_NE(error.what(), std::string());
        }
        ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2)) << i;
    }
    EXPECT_GT(refused, kMutations / 4);
    // The picture and the libraries' own buffers; a sanitizer's bookkeeping fits as well.
    EXPECT_LT(peak_memory(), before + 8 * kLimit);
}

TEST(MutatedImage, TheCorpusHasEveryFormat) {
    std::string all;
    for (const std::string& name : seeds()) all += name + " ";
    for (const char* part : {"zip.exr", "dwab.exr", "piz_tiled.exr", ".hdr", ".pfm", ".tif"}) {
        EXPECT_NE(all.find(part), std::string::npos) << part;
    }
}

}  // namespace
}  // namespace airlight
