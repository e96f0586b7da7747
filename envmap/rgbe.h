// SPDX-License-Identifier: Apache-2.0
// The precision of Radiance's pixels; for the sources of this folder.
#pragma once

#include <cstddef>

namespace airlight::detail {

/// The largest value: 255/256 · 2¹²⁷.
inline constexpr float kLargestRgbe = 1.6947656946257677e38f;

/// Moves (count, 3) non-negative values to where OpenImageIO's writer, which truncates, stores the
/// nearest ones: three mantissas of 8 bits under the exponent of the largest. The stored values are
/// off by at most half a unit, 1/256 of the pixel's largest channel.
void round_to_rgbe(float* pixels, std::size_t count);

}  // namespace airlight::detail
