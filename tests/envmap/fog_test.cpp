// SPDX-License-Identifier: Apache-2.0
// Small maps, every pixel against brute force.
#include "envmap/fog.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/threads.h"
#include "envmap/latlong.h"
#include "sh/npsf.h"
#include "tests/envmap/fog_reference.h"

namespace airlight {
namespace {

using test::brute_sum;
using test::row_integrals;

constexpr int kChannels = 5;

// Channels: noise; a sun of 1e5 in one pixel on faint noise; the same on each polar row; constant.
Image test_map(int width, int height) {
    Image map(width, height, kChannels);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            map.at(y, x, 0) = uniform(random);
            for (int c = 1; c < 4; ++c) map.at(y, x, c) = 1e-3f * uniform(random);
            map.at(y, x, 4) = 2.5f;
        }
    }
    map.at(height / 3, width / 3, 1) = 1e5f;
    map.at(0, width / 2, 2) = 1e5f;
    map.at(height - 1, 0, 3) = 1e5f;
    return map;
}

FogOptions options_for(double thickness, double tolerance,
                       FogMethod method = FogMethod::automatic) {
    FogOptions options;
    options.optical_thickness = {thickness};
    options.tolerance = tolerance;
    options.method = method;
    return options;
}

// Largest relative error of the total over all pixels and channels.
double worst_error(const Image& map, double thickness, const FogOptions& options) {
    const FogPlan plan = plan_fog(map.height, map.width, map.channels, options);
    Image total = scattered_light(map, plan);
    add_direct_light(map, plan, total);
    double worst = 0;
    for (int row = 0; row < map.height; ++row) {
        const std::vector<double> taps = row_integrals(
            [&](double gamma) { return psf(thickness, gamma); }, map.height, map.width, row);
        for (int x = 0; x < map.width; ++x) {
            for (int c = 0; c < map.channels; ++c) {
                const double exact =
                    brute_sum(map, taps, x, c) + std::exp(-thickness) * map.at(row, x, c);
                EXPECT_GE(total.at(row, x, c), 0);
                worst = std::max(worst, std::fabs(total.at(row, x, c) - exact) / exact);
            }
        }
    }
    return worst;
}

class FogOfThickness : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Thicknesses, FogOfThickness,
                         testing::Values(1e-4, 0.05, 0.5, 1.0, 3.0, 10.0, 50.0));

TEST_P(FogOfThickness, EveryPixelOfASmallMapMeetsTheToleranceAgainstBruteForce) {
    const Image map = test_map(48, 24);
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        EXPECT_LE(worst_error(map, GetParam(), options_for(GetParam(), tolerance)), tolerance)
            << "tolerance " << tolerance;
    }
}

TEST_P(FogOfThickness, RingsAgreeWithBruteForceToTheirStatedError) {
    for (const auto& [width, height] : {std::pair{2, 1}, {1, 1}, {7, 3}, {3, 8}, {34, 17}}) {
        const Image map = test_map(width, height);
        EXPECT_LE(worst_error(map, GetParam(), options_for(GetParam(), 1e-6, FogMethod::rings)),
                  1e-6)
            << width << " x " << height;
    }
}

TEST_P(FogOfThickness, SplitOfALargerMapAgreesWithRingsAtEveryPixel) {
    const Image map = test_map(254, 127);
    const double thickness = GetParam();
    const FogPlan exact =
        plan_fog(127, 254, kChannels, options_for(thickness, 1e-6, FogMethod::rings));
    const Image truth = scattered_light(map, exact);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const FogPlan plan =
            plan_fog(127, 254, kChannels, options_for(thickness, tolerance, FogMethod::split));
        ASSERT_EQ(plan.method, FogMethod::split);
        const Image image = scattered_light(map, plan);
        double worst = 0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            worst = std::max<double>(worst, std::fabs(image.pixels[i] / truth.pixels[i] - 1.0));
        }
        EXPECT_LE(worst, tolerance);
        // The bound is the kernel's: what a pixel sees is not far below it beside a lone sun.
        EXPECT_LE(worst, plan.estimated_error);
    }
}

TEST_P(FogOfThickness, ConstantMapStaysConstantWithTheClosedFormEnergy) {
    const double thickness = GetParam();
    for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
        Image map(128, 64, 1);
        std::fill(map.pixels.begin(), map.pixels.end(), 1.0f);
        const FogPlan plan = plan_fog(64, 128, 1, options_for(thickness, tolerance));
        Image total = scattered_light(map, plan);
        add_direct_light(map, plan, total);
        const double energy =
            std::exp(-thickness) * (1 + thickness * psf_eigenvalues_scaled(thickness, 1)[0]);
        for (const float value : total.pixels) ASSERT_NEAR(value / energy, 1, 1e-6);
    }
}

TEST(Fog, NoMediumReturnsTheMapBitForBit) {
    Image map = test_map(16, 8);
    map.at(0, 0, 0) = -0.0f;
    map.at(1, 0, 0) = std::numeric_limits<float>::denorm_min();
    map.at(2, 0, 0) = std::numeric_limits<float>::max();
    const FogPlan plan = plan_fog(8, 16, kChannels, options_for(0, 1e-3));
    EXPECT_TRUE(plan.groups.empty());
    Image total = scattered_light(map, plan);
    add_direct_light(map, plan, total);
    EXPECT_EQ(std::memcmp(total.pixels.data(), map.pixels.data(), map.bytes()), 0);
}

TEST(Fog, ChannelsHaveTheirOwnThicknessAndAlbedo) {
    Image map(32, 16, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) map.pixels[i] = 0.1f + i % 11;
    FogOptions options = options_for(0, 1e-3);
    options.optical_thickness = {0.3, 0.0, 2.0};
    options.albedo = {1.0, 1.0, 0.5};
    const Image together = scattered_light(map, plan_fog(16, 32, 3, options));
    for (int c = 0; c < 3; ++c) {
        FogOptions alone = options_for(options.optical_thickness[c], 1e-3);
        alone.albedo = {options.albedo[c]};
        Image channel(32, 16, 1);
        for (int i = 0; i < 512; ++i) channel.pixels[i] = map.pixels[3 * i + c];
        const Image expected = scattered_light(channel, plan_fog(16, 32, 1, alone));
        for (int i = 0; i < 512; ++i) {
            ASSERT_NEAR(together.pixels[3 * i + c], expected.pixels[i],
                        2e-3 * expected.pixels[i] + 1e-30);
        }
    }
}

TEST(Fog, FactoredFormHasTheShapeOfThicknessOne) {
    const Image map = test_map(32, 16);
    FogOptions options = options_for(2.0, 1e-4);
    options.psf = PsfForm::factored;
    const Image factored = scattered_light(map, plan_fog(16, 32, kChannels, options));
    const Image one = scattered_light(map, plan_fog(16, 32, kChannels, options_for(1.0, 1e-4)));
    const double ratio = 2 * std::exp(-2.0) / std::exp(-1.0);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        ASSERT_NEAR(factored.pixels[i] / (ratio * one.pixels[i]), 1, 1e-6);
    }
    EXPECT_EQ(FogOptions().psf, PsfForm::exact);
}

TEST(Fog, AllBandsOfABandLimitedMapAgreeWithTheExactConvolution) {
    // A cosine lobe has bands 0 and 1: its convolution is lambda_0 and lambda_1 times them. The
    // pixel average lowers the first band by about (pi / rows)^2 / 6.
    const int rows = 64, columns = 128;
    Image map(columns, rows, 1);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            map.at(y, x, 0) = static_cast<float>(1 + std::cos(kPi * (y + 0.5) / rows));
        }
    }
    FogOptions options = options_for(1.0, 1e-3, FogMethod::sh);
    const Image fog = scattered_light(map, plan_fog(rows, columns, 1, options));
    const std::vector<double> lambda = psf_eigenvalues_scaled(1.0, 2);
    for (int y = 0; y < rows; ++y) {
        const double exact =
            std::exp(-1.0) * (lambda[0] + lambda[1] * std::cos(kPi * (y + 0.5) / rows));
        ASSERT_NEAR(fog.at(y, 5, 0), exact, 1e-6);
    }
}

TEST(Fog, BandsAloneRingBesideASunAndTheSplitDoesNot) {
    Image map(128, 64, 1);
    map.at(32, 64, 0) = 1e5f;
    const Image bands =
        scattered_light(map, plan_fog(64, 128, 1, options_for(1, 1e-3, FogMethod::sh)));
    EXPECT_LT(*std::min_element(bands.pixels.begin(), bands.pixels.end()), 0);
    const Image split = scattered_light(map, plan_fog(64, 128, 1, options_for(1, 1e-1)));
    EXPECT_GT(*std::min_element(split.pixels.begin(), split.pixels.end()), 0);
}

TEST(Fog, BytesDoNotDependOnThreads) {
    const Image map = test_map(256, 128);
    FogOptions options = options_for(1.0, 1e-3);
    options.optical_thickness = {0.5, 1, 1, 2, 2};
    std::vector<float> first;
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadLimit limit(threads);
        const FogPlan plan = plan_fog(128, 256, kChannels, options);
        const Image image = scattered_light(map, plan);
        if (first.empty()) first = image.pixels;
        EXPECT_EQ(std::memcmp(first.data(), image.pixels.data(), map.bytes()), 0) << threads;
    }
}

TEST(Fog, NegativePixelsPassThroughLinearly) {
    Image map(64, 32, 1), negated(64, 32, 1);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        map.pixels[i] = static_cast<float>(1 + i % 7);
        negated.pixels[i] = -map.pixels[i];
    }
    const FogPlan plan = plan_fog(32, 64, 1, options_for(1, 1e-3));
    const Image a = scattered_light(map, plan), b = scattered_light(negated, plan);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) ASSERT_FLOAT_EQ(a.pixels[i], -b.pixels[i]);
}

TEST(Fog, ExtremeRadianceNeitherOverflowsNorVanishes) {
    Image map(64, 32, 1);
    map.at(16, 32, 0) = 3e38f;
    map.at(20, 10, 0) = 1e-38f;
    const Image fog = scattered_light(map, plan_fog(32, 64, 1, options_for(1, 1e-3)));
    for (const float value : fog.pixels) ASSERT_TRUE(std::isfinite(value) && value > 0);
}

TEST(Fog, TheLargestFloatsDoNotOverflowInSums) {
    Image map(256, 128, 1);
    std::fill(map.pixels.begin(), map.pixels.end(), 2e38f);
    const FogPlan plan = plan_fog(128, 256, 1, options_for(1, 1e-3));
    ASSERT_EQ(plan.method, FogMethod::split);
    const double energy = std::exp(-1.0) * psf_eigenvalues_scaled(1.0, 1)[0];
    for (const float value : scattered_light(map, plan).pixels) {
        ASSERT_NEAR(value / (energy * 2e38), 1, 1e-6);
    }
}

TEST(Fog, ThickMediaUnderflowToBlackWithoutNoise) {
    const Image map = test_map(32, 16);
    for (const double thickness : {200.0, 700.0, 1e4, 1e300}) {
        const FogPlan plan = plan_fog(16, 32, kChannels, options_for(thickness, 1e-3));
        EXPECT_TRUE(plan.groups.empty());
        Image total = scattered_light(map, plan);
        add_direct_light(map, plan, total);
        for (const float value : total.pixels) ASSERT_EQ(value, 0);
    }
}

TEST(Fog, ThicknessAtTheEdgeOfFloatKeepsItsTolerance) {
    Image map(256, 128, 1);
    std::fill(map.pixels.begin(), map.pixels.end(), 1e30f);
    map.at(40, 90, 0) = 3e38f;
    const Image truth =
        scattered_light(map, plan_fog(128, 256, 1, options_for(120, 1e-6, FogMethod::rings)));
    for (const double tolerance : {1e-1, 1e-3}) {
        const Image image =
            scattered_light(map, plan_fog(128, 256, 1, options_for(120, tolerance)));
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            ASSERT_NEAR(image.pixels[i] / truth.pixels[i], 1, tolerance);
        }
    }
}

TEST(Fog, ThinMediaScatterInProportion) {
    const Image map = test_map(32, 16);
    const Image a = scattered_light(map, plan_fog(16, 32, kChannels, options_for(1e-10, 1e-3)));
    const Image b = scattered_light(map, plan_fog(16, 32, kChannels, options_for(1e-20, 1e-3)));
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        ASSERT_NEAR(a.pixels[i] / (1e10 * b.pixels[i]), 1, 1e-6);
    }
}

TEST(Fog, OptionsOutsideTheirDomainAreUsageErrors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const auto code_of = [](const FogOptions& options) {
        try {
            plan_fog(8, 16, 3, options);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::data;
    };
    for (const double bad : {-1.0, -1e-300, nan, inf}) {
        EXPECT_EQ(code_of(options_for(bad, 1e-3)), ErrorCode::usage) << bad;
    }
    for (const double bad : {-0.1, 1.1, nan}) {
        FogOptions options;
        options.albedo = {bad};
        EXPECT_EQ(code_of(options), ErrorCode::usage) << bad;
    }
    for (const double bad : {0.0, 1.0, -1.0, nan, 1e-9}) {
        EXPECT_EQ(code_of(options_for(1, bad)), ErrorCode::usage) << bad;
    }
    EXPECT_EQ(code_of(options_for(1, 2e-6, FogMethod::split)), ErrorCode::usage);
    FogOptions two;
    two.optical_thickness = {1, 2};
    EXPECT_EQ(code_of(two), ErrorCode::usage);
    FogOptions order = options_for(1, 1e-3, FogMethod::sh);
    order.sh_order = 9;
    EXPECT_EQ(code_of(order), ErrorCode::usage);
    EXPECT_THROW(fog_method_from_name("magic"), Error);
}

}  // namespace
}  // namespace airlight
