// SPDX-License-Identifier: Apache-2.0
// How far one picture is from another, and which light is to blame.
#pragma once

#include <array>
#include <optional>

#include "envmap/image.h"
#include "envmap/sheet.h"
#include "viewer/effects.h"

namespace airlight {

/// Errors of pixels, each that of the channel where it is largest, over the brightest value of the
/// truth; all 0 for equal pictures, +inf where the truth is black and the other is not.
struct PictureErrors {
    double rms = 0;  ///< root of the mean square
    double p99 = 0;  ///< 99 % of the pixels are nearer
    double largest = 0;
    double relative = 0;  ///< root of the summed squares over that of the truth itself
    double bias = 0;      ///< mean of the other less the truth, of the channels' means
};

/// Two pictures of one size. `brightest` 0 takes the truth's.
PictureErrors compare_pictures(const Image& other, const Image& truth, double brightest = 0);

/// The largest value of any channel.
double brightest_of(const Image& image);

/// Layers of two pictures.
using LayerImages = std::array<Image, kRadianceLayerCount>;

struct LayerErrors {
    std::array<PictureErrors, kRadianceLayerCount> layers;  ///< over the whole truth's brightest
    /// The layer with the largest rms; nothing where all are equal.
    std::optional<RadianceLayer> owner;
};
LayerErrors compare_layers(const LayerImages& other, const LayerImages& truth, double brightest);

/// Differences over `brightest`, by decades: black up to 1e-4, full at 1; orange where the other is
/// brighter, blue where it is darker, of the channels' mean.
Sheet difference_picture(const Image& other, const Image& truth, double brightest);

}  // namespace airlight
