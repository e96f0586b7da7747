// SPDX-License-Identifier: Apache-2.0
// Where a spherical-harmonic coefficient lives in memory.
//
// Order n means the degrees l = 0 ... n-1 and n^2 coefficients (Sloan 2002, Zhou 2007). Degree l
// holds m = -l ... l in consecutive slots; the coefficient (l, m) lies at l(l+1) + m.
#pragma once

#include <cstddef>

namespace airlight {

/// The degree and the azimuthal order of one coefficient, |m| <= l.
struct ShDegree {
    int l = 0;
    int m = 0;
};

/// Number of coefficients of order n >= 0: n^2. All three functions compute in std::size_t and are
/// exact for every non-negative int where that has 64 bits (n <= 65535 where it has 32).
constexpr std::size_t sh_count(int order) {
    return static_cast<std::size_t>(order) * static_cast<std::size_t>(order);
}

/// Slot of (l, m): l(l+1) + m, for 0 <= l and |m| <= l.
constexpr std::size_t sh_index(int l, int m) {
    const auto degree = static_cast<std::size_t>(l);
    return degree * degree + static_cast<std::size_t>(l + m);
}

/// The (l, m) whose slot is `index`; the inverse of sh_index, with l = floor(sqrt(index)).
constexpr ShDegree sh_degree(std::size_t index) {
    std::size_t root = 0;
    std::size_t rest = index;
    std::size_t bit = std::size_t{1} << (8 * sizeof(std::size_t) - 2);
    while (bit > rest) bit >>= 2;
    for (; bit != 0; bit >>= 2) {
        if (rest >= root + bit) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    // rest = index - root^2 = l + m, at most 2l.
    return {static_cast<int>(root), static_cast<int>(rest) - static_cast<int>(root)};
}

}  // namespace airlight
