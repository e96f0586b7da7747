// SPDX-License-Identifier: Apache-2.0
// Maps of 1024 x 512 pixels, real ones among them: the exact rings against brute force on some
// rows, then every rung of the split against the rings at every pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "envmap/fog.h"
#include "envmap/io.h"
#include "tests/envmap/fog_reference.h"

namespace airlight {
namespace {

constexpr int kWidth = 1024, kHeight = 512;

// A map of Debian's blender-data where it is installed, and any that AIRLIGHT_EXTRA_MAPS names
// (separated by colons). The generated lamp-lit map stands in for them elsewhere.
std::vector<std::string> real_maps() {
    std::vector<std::string> paths;
    const std::string interior = "/usr/share/blender/datafiles/studiolights/world/interior.exr";
    if (std::filesystem::exists(interior)) paths.push_back(interior);
    if (const char* extra = std::getenv("AIRLIGHT_EXTRA_MAPS")) {
        std::stringstream list(extra);
        for (std::string path; std::getline(list, path, ':');) paths.push_back(path);
    }
    return paths;
}

// Channels: a one-pixel sun of 1e5 at mid height, on the top row and on the bottom row, each on a
// faint gradient; then the channels of the real maps.
Image test_map() {
    std::vector<Image> real;
    for (const std::string& path : real_maps()) {
        real.push_back(read_image(path));
        EXPECT_EQ(real.back().width, kWidth) << path;
        EXPECT_EQ(real.back().height, kHeight) << path;
    }
    Image map(kWidth, kHeight, 3 + 3 * static_cast<int>(real.size()));
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c) map.at(y, x, c) = 1e-3f * (1 + y % 7);
            for (std::size_t r = 0; r < real.size(); ++r) {
                for (int c = 0; c < 3; ++c) {
                    map.at(y, x, 3 + 3 * static_cast<int>(r) + c) = real[r].at(y, x, c);
                }
            }
        }
    }
    map.at(200, 300, 0) = 1e5f;
    map.at(0, 700, 1) = 1e5f;
    map.at(kHeight - 1, 1023, 2) = 1e5f;
    return map;
}

class LargeFog : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Thicknesses, LargeFog,
                         testing::Values(1e-4, 0.05, 0.5, 1.0, 3.0, 10.0, 50.0));

TEST_P(LargeFog, EveryPixelMeetsTheToleranceBesideASunAndAtThePoles) {
    const double thickness = GetParam(), transmittance = std::exp(-thickness);
    const Image map = test_map();
    FogOptions options;
    options.optical_thickness = {thickness};
    options.tolerance = 1e-6;
    options.method = FogMethod::rings;
    const Image truth = scattered_light(map, plan_fog(kHeight, kWidth, map.channels, options));

    for (const int row : {0, 1, 199, 200, 255, 511}) {
        const std::vector<double> taps = test::row_integrals(
            [&](double gamma) { return psf(thickness, gamma); }, kHeight, kWidth, row);
        for (const int column : {0, 299, 300, 301, 512, 700, 1023}) {
            for (int c = 0; c < map.channels; ++c) {
                const double exact = test::brute_sum(map, taps, column, c);
                ASSERT_NEAR(truth.at(row, column, c) / exact, 1, 2e-6)
                    << row << ' ' << column << ' ' << c;
            }
        }
    }

    options.method = FogMethod::automatic;
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        options.tolerance = tolerance;
        const FogPlan plan = plan_fog(kHeight, kWidth, map.channels, options);
        EXPECT_EQ(plan.method, FogMethod::split);
        Image total = scattered_light(map, plan);
        add_direct_light(map, plan, total);
        double worst = 0;
        for (std::size_t i = 0; i < total.pixels.size(); ++i) {
            const double direct = transmittance * map.pixels[i];
            // interior.exr has negative pixels left by lossy compression: there the two parts
            // cancel, and the error belongs to the sum of their sizes.
            worst = std::max(worst, std::fabs(total.pixels[i] - truth.pixels[i] - direct) /
                                        (truth.pixels[i] + std::fabs(direct)));
        }
        EXPECT_LE(worst, tolerance);
        EXPECT_LE(worst, plan.estimated_error);
        EXPECT_LE(plan.estimated_error, tolerance);
        RecordProperty("worst_at_" + std::to_string(tolerance), std::to_string(worst));
        std::printf("T %g, tolerance %g: worst pixel %.3g, bound %.3g, lmax %d\n", thickness,
                    tolerance, worst, plan.estimated_error, plan.lmax);
    }
}

}  // namespace
}  // namespace airlight
