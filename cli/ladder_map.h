// SPDX-License-Identifier: Apache-2.0
// The environment map on which methods of fog are compared, in `airlight ladder` and bench/.
#pragma once

#include <cmath>

#include "envmap/image.h"
#include "envmap/latlong.h"

namespace airlight {

/// A clear sky that pales towards the horizon over a dim ground, L = 0.05 … 1.2, with a sun of 1e5
/// in one pixel at a height of about 45 degrees: RGB, the same at every call.
inline Image sun_and_sky(int width, int height) {
    constexpr float kSun[3] = {1e5f, 0.9e5f, 0.75e5f};
    constexpr double kZenith[3] = {0.15, 0.35, 0.9}, kHorizon[3] = {0.9, 1.0, 1.2};
    constexpr double kGround[3] = {0.12, 0.1, 0.05};
    Image map(width, height, 3);
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const auto [x, y, z] = pixel_direction(row, column, width, height);
            // 1 above the horizon, 0 below, over about ten degrees.
            const double sky = 0.5 + 0.5 * std::tanh(12 * y);
            const double paleness = std::exp(-3 * std::abs(y)) * (1 + 0.2 * z);
            const double shade = 1 + 0.3 * std::sin(7 * x) * std::sin(5 * z);
            for (int c = 0; c < 3; ++c) {
                const double above = kZenith[c] + (kHorizon[c] - kZenith[c]) * paleness;
                map.at(row, column, c) =
                    static_cast<float>(sky * above + (1 - sky) * kGround[c] * shade);
            }
        }
    }
    for (int c = 0; c < 3; ++c) map.at(height / 4, width / 3, c) = kSun[c];
    return map;
}

}  // namespace airlight
