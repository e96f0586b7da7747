// SPDX-License-Identifier: Apache-2.0
// The article's own single-precision arithmetic, kept to measure it.
#pragma once

#include <cmath>

#include "medium/scaled_erfc.h"

namespace airlight {
namespace detail {

/// [Golubev] eq. 46 for cos >= 0, in the order of operations of its ChapmanUpper.
inline float chapman_upper_fp32(float z, float cosine) {
    const float sine = std::sqrt(std::fmax(0.0f, 1 - cosine * cosine));
    const float over_root_z = 1 / std::sqrt(z), root_z = z * over_root_z;
    const float one_more = 1 + sine;
    const float over_root = 1 / std::sqrt(one_more), over = over_root * over_root;
    const float scaled_erfc = erfcx_rational9(root_z * cosine * over_root);
    const float first = cosine * over * (1 - 0.5f * over);
    const float second =
        1.7724539f * over_root * scaled_erfc *
        (root_z * (-1.5f + one_more + over) + over_root_z * 0.25f * (2 * one_more - 1) * over);
    return first + second;
}

/// [Golubev] eq. 47, ChapmanHorizontal.
inline float chapman_horizontal_fp32(float z) {
    const float over_root_z = 1 / std::sqrt(z);
    const float series = -0.14687275f + z * (0.46999280f + z * 1.2533141f);
    return series * (over_root_z * over_root_z * over_root_z);
}

/// [Golubev] eq. 43 and 48, RescaledChapman: e^{Z - z} C(z, theta).
inline float rescaled_chapman_fp32(float z, float big_z, float cosine) {
    const float sine = std::sqrt(std::fmax(0.0f, 1 - cosine * cosine));
    const float upper = chapman_upper_fp32(z, std::abs(cosine)) * std::exp(big_z - z);
    if (cosine >= 0) return upper;
    const float z0 = z * sine;
    return 2 * chapman_horizontal_fp32(z0) * std::exp(big_z - z0) - upper;
}

/// ln C by those, with the exponents of eq. 48 put together.
inline float ln_chapman_fp32(float z, float cosine) {
    if (cosine >= 0) return std::log(chapman_upper_fp32(z, cosine));
    const float sine = std::sqrt(std::fmax(0.0f, 1 - cosine * cosine));
    const float z0 = z * sine, drop = z - z0;
    return drop + std::log(2 * chapman_horizontal_fp32(z0) -
                           chapman_upper_fp32(z, -cosine) * std::exp(-drop));
}

}  // namespace detail
}  // namespace airlight
