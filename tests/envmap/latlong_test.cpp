// SPDX-License-Identifier: Apache-2.0
#include "envmap/latlong.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/constants.h"

namespace airlight {
namespace {

// sin(π) and cos(π/2) in double are 1.2e-16 and 6e-17, and u, v carry a rounding of their own.
constexpr double kRounding = 4e-16;

void expect_direction(double u, double v, double x, double y, double z) {
    const auto direction = direction_of(u, v);
    EXPECT_NEAR(direction[0], x, kRounding) << u << ' ' << v;
    EXPECT_NEAR(direction[1], y, kRounding) << u << ' ' << v;
    EXPECT_NEAR(direction[2], z, kRounding) << u << ' ' << v;
}

TEST(LatLong, TheSixAxesAreWhereTheConventionPutsThem) {
    expect_direction(0.5, 0.5, 0, 0, 1);
    expect_direction(0.25, 0.5, 1, 0, 0);
    expect_direction(0.75, 0.5, -1, 0, 0);
    expect_direction(0, 0.5, 0, 0, -1);
    expect_direction(1, 0.5, 0, 0, -1);
    expect_direction(0.3, 0, 0, 1, 0);
    expect_direction(0.3, 1, 0, -1, 0);
}

TEST(LatLong, TheSixAxesFallOnTheirPixels) {
    const auto expect_pixel = [](std::array<double, 3> direction, int row, int column) {
        const LatLongPixel pixel = pixel_of(direction, 8, 4);
        EXPECT_EQ(pixel.row, row);
        EXPECT_EQ(pixel.column, column);
    };
    expect_pixel({0, 0, 1}, 2, 4);
    expect_pixel({1, 0, 0}, 2, 2);
    expect_pixel({-1, 0, 0}, 2, 6);
    expect_pixel({0, 0, -1}, 2, 0);
    expect_pixel({-0.0, 0, -1}, 2, 0);
    expect_pixel({0, 1, 0}, 0, 4);
    expect_pixel({0, -1, 0}, 3, 4);
    expect_pixel({-0.0, 5, -0.0}, 0, 4);
}

TEST(LatLong, PixelCentresComeBackToTheirPixels) {
    for (const auto& [width, height] : {std::pair{2, 1}, {4, 2}, {7, 5}, {64, 32}, {1, 1}}) {
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                const auto direction = pixel_direction(row, column, width, height);
                EXPECT_NEAR(std::hypot(direction[0], direction[1], direction[2]), 1, kRounding);
                const LatLongPixel pixel = pixel_of(direction, width, height);
                EXPECT_EQ(pixel.row, row);
                EXPECT_EQ(pixel.column, column);
            }
        }
    }
}

// Scaled by 2 to show that the length does not matter.
TEST(LatLong, PointOfInvertsDirectionOf) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 10000; ++i) {
        const double u = uniform(random);
        const double v = uniform(random);
        auto direction = direction_of(u, v);
        for (double& component : direction) component *= 2;
        const LatLongPoint point = point_of(direction);
        // Near a pole a rounding of ω moves u by that over sinθ.
        EXPECT_NEAR(point.u, u, 2e-16 / std::sin(kPi * v) + 2e-16);
        EXPECT_NEAR(point.v, v, 2e-16);
    }
}

TEST(LatLong, KeepsItsDigitsBesideThePole) {
    const LatLongPoint point = point_of({0, 1, 1e-12});
    EXPECT_NEAR(point.v * kPi / 1e-12, 1, 1e-15);
    EXPECT_EQ(point.u, 0.5);
}

TEST(LatLong, SolidAnglesSumToTheSphere) {
    for (const auto& [width, height] : {std::pair{2, 1}, {4, 2}, {7, 5}, {64, 32}, {8192, 4096}}) {
        double sum = 0;
        for (int row = 0; row < height; ++row) sum += width * pixel_solid_angle(row, width, height);
        // A sum of `height` positive roundings.
        EXPECT_NEAR(sum / (4 * kPi), 1, 1e-15 + 1.2e-16 * height);
    }
}

TEST(LatLong, SolidAnglesAreExactPerRowAndMirrored) {
    constexpr int kWidth = 2048;
    constexpr int kHeight = 1024;
    for (int row = 0; row < kHeight; ++row) {
        const long double pi = 3.14159265358979323846264338327950288L;
        const long double exact =
            2 * pi / kWidth * (std::cos(pi * row / kHeight) - std::cos(pi * (row + 1) / kHeight));
        const double computed = pixel_solid_angle(row, kWidth, kHeight);
        // The difference of cosines in long double loses up to 2/(π/1024)² ≈ 2e5 of 5e-20.
        EXPECT_NEAR(static_cast<double>(computed / exact), 1, 1e-13) << row;
        EXPECT_EQ(computed, pixel_solid_angle(kHeight - 1 - row, kWidth, kHeight));
    }
}

// Against the same formula in long double, where nothing cancels on the upper half.
TEST(LatLong, SolidAnglesAreAccurateToRounding) {
    for (const int height : {1, 3, 512, 4096, 1000003}) {
        for (int row = 0; row < height; row += 1 + height / 1000) {
            const long double pi = 3.14159265358979323846264338327950288L;
            const int mirrored = std::min(row, height - 1 - row);
            const long double exact = 4 * pi / (2 * height) *
                                      std::sin(pi * (mirrored + 0.5L) / height) *
                                      std::sin(pi / (2.0L * height));
            EXPECT_NEAR(static_cast<double>(pixel_solid_angle(row, 2 * height, height) / exact), 1,
                        6e-16)
                << row << ' ' << height;
        }
    }
}

TEST(LatLong, RowColatitudesAreCentres) {
    EXPECT_DOUBLE_EQ(row_colatitude(0, 1), kPi / 2);
    EXPECT_DOUBLE_EQ(row_colatitude(0, 4), kPi / 8);
    EXPECT_DOUBLE_EQ(row_colatitude(3, 4), 7 * kPi / 8);
}

}  // namespace
}  // namespace airlight
