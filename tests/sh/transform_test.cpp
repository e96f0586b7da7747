// SPDX-License-Identifier: Apache-2.0
#include "sh/transform.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

struct Size {
    int rows, columns, lmax;
};

const std::vector<Size> kSizes = {{1, 1, 0},     {1, 2, 0},     {2, 4, 1},      {3, 6, 2},
                                  {7, 13, 6},    {8, 32, 5},    {16, 32, 15},   {33, 66, 32},
                                  {64, 128, 63}, {65, 254, 64}, {256, 512, 255}};

template <class T>
std::vector<T> noise(std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<T> values(count);
    for (T& value : values) value = static_cast<T>(uniform(random));
    return values;
}

// The largest error of bands that went through a map, both relative to the largest band.
double round_trip_error(const Size& size, int channels, TransformPrecision precision) {
    const SphericalTransform transform(size.rows, size.columns, size.lmax, precision);
    const std::vector<double> in = noise<double>(channels * sh_count(size.lmax + 1));
    std::vector<double> map(static_cast<std::size_t>(size.rows) * size.columns * channels);
    std::vector<double> out(in.size());
    transform.synthesize(in.data(), channels, map.data());
    transform.analyze(map.data(), channels, out.data());
    double worst = 0;
    for (std::size_t i = 0; i < in.size(); ++i) worst = std::max(worst, std::fabs(in[i] - out[i]));
    return worst;
}

TEST(SphericalTransform, BandLimitedMapsComeBackToRounding) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        for (const Size& size : kSizes) {
            // White noise of (lmax+1)^2 coefficients has values up to about lmax, and their
            // rounding grows with the recurrence: 1.5e-13 measured at lmax = 1023, 8e-15 at 63.
            EXPECT_LT(round_trip_error(size, 3, TransformPrecision::full), 3e-16 * (size.lmax + 10))
                << hwy::TargetName(target) << " " << size.rows << " x " << size.columns;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(SphericalTransform, AnyNumberOfChannelsComesBack) {
    // Components go through the Legendre sums in groups of 6, 4 and 2.
    for (int channels = 1; channels <= 7; ++channels) {
        EXPECT_LT(round_trip_error({33, 66, 32}, channels, TransformPrecision::full), 2e-14)
            << channels;
    }
}

TEST(SphericalTransform, SinglePrecisionErrsByAFewRoundingsOfAFloat) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        for (const Size& size : kSizes) {
            // Synthesis and analysis together; the error grows slowly with lmax, 4e-7 each at 31 and
            // 1.1e-6 at 1023. Chirp transforms, of 66 rows on a meridian, double it.
            EXPECT_LT(round_trip_error(size, 3, TransformPrecision::single),
                      6e-7 * std::sqrt(size.lmax + 4.0))
                << hwy::TargetName(target) << " " << size.rows << " x " << size.columns;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(SphericalTransform, SynthesisAgreesWithTheBasisInTheMapFrame) {
    const int rows = 12, columns = 24, lmax = 11;
    const std::vector<double> in = noise<double>(sh_count(lmax + 1));
    std::vector<double> map(rows * columns), basis(sh_count(lmax + 1));
    SphericalTransform(rows, columns, lmax).synthesize(in.data(), 1, map.data());
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const double theta = kPi * (y + 0.5) / rows;
            const double phi = kPi - 2 * kPi * (x + 0.5) / columns;
            evaluate_basis(lmax + 1, std::sin(theta) * std::cos(phi),
                           std::sin(theta) * std::sin(phi), std::cos(theta), basis.data());
            double sum = 0;
            for (std::size_t i = 0; i < basis.size(); ++i) sum += in[i] * basis[i];
            ASSERT_NEAR(map[y * columns + x], sum, 1e-13);
        }
    }
}

TEST(SphericalTransform, FloatMapsComeBackToTheirPrecision) {
    const int rows = 64, columns = 128, lmax = 63;
    const SphericalTransform transform(rows, columns, lmax);
    const std::vector<float> in = noise<float>(2 * sh_count(lmax + 1));
    std::vector<float> map(rows * columns * 2), out(in.size());
    transform.synthesize(in.data(), 2, map.data());
    transform.analyze(map.data(), 2, out.data());
    // The map's values, up to about 60, are rounded to float once: 4e-6 each, averaged.
    for (std::size_t i = 0; i < in.size(); ++i) ASSERT_NEAR(in[i], out[i], 2e-6);
}

TEST(SphericalTransform, ConvolutionMultipliesBands) {
    const int rows = 32, columns = 64, lmax = 31, channels = 2;
    const SphericalTransform transform(rows, columns, lmax);
    const std::vector<double> in = noise<double>(channels * sh_count(lmax + 1));
    std::vector<double> scaled = in, map(rows * columns * channels), expected(map.size());
    std::vector<double> eigenvalues(channels * (lmax + 1));
    for (std::size_t i = 0; i < eigenvalues.size(); ++i) eigenvalues[i] = 1.0 / (1 + i);
    for (int c = 0; c < channels; ++c) {
        for (int l = 0; l <= lmax; ++l) {
            for (int m = -l; m <= l; ++m) {
                scaled[c * sh_count(lmax + 1) + sh_index(l, m)] *= eigenvalues[c * (lmax + 1) + l];
            }
        }
    }
    transform.synthesize(in.data(), channels, map.data());
    transform.convolve(map.data(), channels, eigenvalues.data(), map.data());
    transform.synthesize(scaled.data(), channels, expected.data());
    for (std::size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], expected[i], 1e-13);
}

TEST(SphericalTransform, BytesDoNotDependOnThreads) {
    const int rows = 64, columns = 128, lmax = 63;
    const SphericalTransform transform(rows, columns, lmax);
    const std::vector<float> map = noise<float>(rows * columns * 3);
    std::vector<float> first, first_back;
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadLimit limit(threads);
        std::vector<float> out(3 * sh_count(lmax + 1));
        transform.analyze(map.data(), 3, out.data());
        if (first.empty()) first = out;
        EXPECT_EQ(std::memcmp(first.data(), out.data(), out.size() * sizeof(float)), 0);
        std::vector<float> back(map.size());
        transform.synthesize(out.data(), 3, back.data());
        if (first_back.empty()) first_back = back;
        EXPECT_EQ(std::memcmp(first_back.data(), back.data(), back.size() * sizeof(float)), 0);
    }
}

TEST(SphericalTransform, HighOrdersAtThePolesDoNotUnderflowToGarbage) {
    // One harmonic of m = 200 alone: its value near the poles is below the smallest double.
    const int rows = 256, columns = 512, lmax = 255;
    std::vector<double> in(sh_count(lmax + 1), 0.0), map(rows * columns), out(in.size());
    in[sh_index(230, 200)] = 1;
    const SphericalTransform transform(rows, columns, lmax);
    transform.synthesize(in.data(), 1, map.data());
    for (int x = 0; x < columns; ++x) ASSERT_LT(std::fabs(map[x]), 1e-300);
    transform.analyze(map.data(), 1, out.data());
    for (std::size_t i = 0; i < in.size(); ++i) ASSERT_NEAR(in[i], out[i], 1e-13);
}

TEST(SphericalTransform, RefusesBandsThatTheMapCannotHold) {
    EXPECT_THROW(SphericalTransform(8, 16, 8), Error);
    EXPECT_THROW(SphericalTransform(8, 14, 7), Error);
    EXPECT_THROW(SphericalTransform(0, 16, 0), Error);
    EXPECT_THROW(SphericalTransform(8, 16, -1), Error);
}

}  // namespace
}  // namespace airlight
