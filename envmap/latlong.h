// SPDX-License-Identifier: Apache-2.0
// The lat-long mapping between the pixels of an environment map and directions.
//
// With u = (column+½)/width to the right and v = (row+½)/height downwards at pixel centres,
//
//     θ = π·v,  φ = 2π·(½ − u),  ω = (sinθ·sinφ, cosθ, sinθ·cosφ)
//
// in a right-handed world with +Y up. So the top row looks at +Y, the centre at +Z, the left
// quarter at +X, the right quarter at −X and the seam at −Z, which is OpenEXR's orientation.
// Deviates: OpenEXR's sample code puts the edge pixels' centres on the seam and the poles; here the
// picture's borders lie there, as renderers and packages of maps have it.
#pragma once

#include <array>
#include <cassert>
#include <cmath>

#include "core/constants.h"

namespace airlight {

/// A place in a map, 0 ≤ u < 1 from left to right, 0 ≤ v ≤ 1 from top to bottom.
struct LatLongPoint {
    double u = 0;
    double v = 0;
};

struct LatLongPixel {
    int row = 0;
    int column = 0;
};

/// The unit direction at (u, v); u is periodic, v in [0, 1]. Accurate to 4e-16 per component.
inline std::array<double, 3> direction_of(double u, double v) {
    const double theta = kPi * v;
    const double phi = 2 * kPi * (0.5 - u);
    const double sin_theta = std::sin(theta);
    return {sin_theta * std::sin(phi), std::cos(theta), sin_theta * std::cos(phi)};
}

/// The unit direction of a pixel's centre.
inline std::array<double, 3> pixel_direction(int row, int column, int width, int height) {
    return direction_of((column + 0.5) / width, (row + 0.5) / height);
}

/// Where a direction of any finite length but 0 falls. At the poles u = ½; the seam (−Z) is u = 0.
/// The colatitude comes from an arctangent, so it keeps its digits beside the poles.
inline LatLongPoint point_of(const std::array<double, 3>& direction) {
    const auto [x, y, z] = direction;
    assert(x != 0 || y != 0 || z != 0);
    // atan2(±0, −0) is ±π, so at the poles the sign of z's zero would choose the seam.
    const double phi = x == 0 && z == 0 ? 0 : std::atan2(x, z);
    const double u = 0.5 - phi / (2 * kPi);
    return {u < 1 ? u : 0, std::atan2(std::hypot(x, z), y) / kPi};
}

/// The pixel that holds a direction; borders belong to the pixel to the right and below.
inline LatLongPixel pixel_of(const std::array<double, 3>& direction, int width, int height) {
    assert(width > 0 && height > 0);
    const LatLongPoint point = point_of(direction);
    const int row = static_cast<int>(point.v * height);
    const int column = static_cast<int>(point.u * width);
    return {row < height ? row : height - 1, column < width ? column : width - 1};
}

/// The colatitude θ of a row's centre, in radians from +Y.
inline double row_colatitude(int row, int height) {
    return kPi * (row + 0.5) / height;
}

/// The solid angle of each pixel of a row in steradians,
///
///     (2π/width)·(cosθ₀ − cosθ₁) = (4π/width)·sinθ_c·sin(π/(2·height)),
///
/// θ₀, θ₁ the row's borders and θ_c its centre. The right-hand side, used here, does not cancel:
/// relative error ≤ 6e-16. Rows mirrored at the equator get the same bits, and all pixels together
/// 4π.
inline double pixel_solid_angle(int row, int width, int height) {
    assert(row >= 0 && row < height && width > 0);
    const int mirrored = row < height - 1 - row ? row : height - 1 - row;
    return 4 * kPi / width * std::sin(row_colatitude(mirrored, height)) *
           std::sin(kPi / (2.0 * height));
}

}  // namespace airlight
