// SPDX-License-Identifier: Apache-2.0
#include "viewer/picture_compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace airlight {
namespace {

Image grey(int width, int height, float value) {
    Image image(width, height, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

TEST(PictureCompare, ErrorsAreOverTheBrightestPixel) {
    Image truth = grey(20, 10, 1), other = truth;
    truth.at(3, 4, 1) = other.at(3, 4, 1) = 4;
    other.at(5, 6, 2) = 3;  // off by 2
    const PictureErrors errors = compare_pictures(other, truth);
    EXPECT_DOUBLE_EQ(errors.largest, 0.5);
    EXPECT_EQ(errors.p99, 0);
    EXPECT_DOUBLE_EQ(errors.rms, 0.5 / std::sqrt(200.0));
    EXPECT_DOUBLE_EQ(errors.bias, 2.0 / 3 / 200 / 4);
    EXPECT_DOUBLE_EQ(errors.relative, 2 / std::sqrt(599 + 16.0));
    EXPECT_DOUBLE_EQ(compare_pictures(other, truth, 8).largest, 0.25);
}

TEST(PictureCompare, EqualPicturesDifferByNothing) {
    for (const float value : {0.0f, 1.0f}) {
        const PictureErrors errors = compare_pictures(grey(3, 2, value), grey(3, 2, value));
        EXPECT_EQ(errors.rms, 0);
        EXPECT_EQ(errors.largest, 0);
        EXPECT_EQ(errors.relative, 0);
    }
    EXPECT_TRUE(std::isinf(compare_pictures(grey(2, 2, 1), grey(2, 2, 0)).rms));
}

TEST(PictureCompare, TheOwnerIsTheLayerWithTheLargestError) {
    LayerImages truth, other;
    truth.fill(grey(4, 4, 1));
    other.fill(grey(4, 4, 1));
    EXPECT_FALSE(compare_layers(other, truth, 1).owner);
    other[1] = grey(4, 4, 1.1f);
    other[4] = grey(4, 4, 0.5f);
    EXPECT_EQ(compare_layers(other, truth, 1).owner, kRadianceLayers[4].method);
}

TEST(PictureCompare, DifferencesAreOrangeOrBlueByDecades) {
    const Image truth = grey(4, 1, 1);
    Image other = truth;
    for (int c = 0; c < 3; ++c) {
        other.at(0, 1, c) = 2;      // as much as there is
        other.at(0, 2, c) = 0.99f;  // two decades below
        other.at(0, 3, c) = 1.00005f;
    }
    const Sheet sheet = difference_picture(other, truth, 1);
    const auto pixel = [&](std::size_t i) { return sheet.pixels.data() + 3 * i; };
    EXPECT_EQ(pixel(0)[0] + pixel(0)[1] + pixel(0)[2], 0);
    EXPECT_EQ(pixel(1)[0], 255);
    EXPECT_LT(pixel(1)[2], pixel(1)[0]);
    EXPECT_NEAR(pixel(2)[2], 127, 2);
    EXPECT_LT(pixel(2)[0], pixel(2)[2]);
    EXPECT_EQ(pixel(3)[0], 0);
}

}  // namespace
}  // namespace airlight
