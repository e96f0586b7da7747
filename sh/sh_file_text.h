// SPDX-License-Identifier: Apache-2.0
// The fixed texts of coefficient files, for the writer and the reader.
#pragma once

#include <array>

namespace airlight::detail {

inline constexpr int kShFileVersion = 1;
inline constexpr const char* kShQuantity = "radiance";
inline constexpr const char* kShUnit = "that of the map's pixels: W/(sr m^2) up to the map's scale";
inline constexpr const char* kShConvention =
    "real, orthonormal, no Condon-Shortley sign: degree 1 is 0.488603 (y, z, x); coefficient (l, "
    "m) at l(l+1)+m; order n holds l = 0 ... n-1";
inline constexpr const char* kShFrame =
    "right-handed, +Y up; a lat-long map's centre looks at +Z, its left quarter at +X";
inline constexpr std::array<const char*, 3> kShChannels = {"R", "G", "B"};

}  // namespace airlight::detail
