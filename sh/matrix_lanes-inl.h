// SPDX-License-Identifier: Apache-2.0
// One matrix times many vectors in SIMD lanes, compiled once per SIMD target: no #pragma once.
#include <hwy/highway.h>

#include <cstddef>

#include "sh/lanes-inl.h"

#if defined(AIRLIGHT_SH_MATRIX_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_SH_MATRIX_LANES_INL_H
#undef AIRLIGHT_SH_MATRIX_LANES_INL_H
#else
#define AIRLIGHT_SH_MATRIX_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of a tile: two SIMD vectors of lanes, so that one load of a matrix entry serves both.
template <class D>
HWY_INLINE std::size_t tile_width(D d) {
    return 2 * hn::Lanes(d);
}

// kRows rows of `columns` entries each times a tile; sink(r, low, high) takes row r.
template <int kRows, class D, class Size, class Sink, class T = hn::TFromD<D>>
HWY_INLINE void multiply_rows(D d, const T* HWY_RESTRICT matrix, Size columns,
                              const T* HWY_RESTRICT x, const Sink& sink) {
    const std::size_t lanes = hn::Lanes(d);
    hn::Vec<D> low[kRows], high[kRows];
    for (int r = 0; r < kRows; ++r) low[r] = high[r] = hn::Zero(d);
    for (std::size_t k = 0; k < columns; ++k) {
        const auto x_low = hn::Load(d, x + 2 * k * lanes);
        const auto x_high = hn::Load(d, x + (2 * k + 1) * lanes);
        for (int r = 0; r < kRows; ++r) {
            const auto entry = hn::Set(d, matrix[static_cast<std::size_t>(r) * columns + k]);
            low[r] = hn::MulAdd(entry, x_low, low[r]);
            high[r] = hn::MulAdd(entry, x_high, high[r]);
        }
    }
    for (std::size_t r = 0; r < kRows; ++r) sink(r, low[r], high[r]);
}

// All rows. Single rows would wait for their own sums, so an odd end is 3 or 3 + 2 rows.
template <class D, class Size, class Sink, class T = hn::TFromD<D>>
HWY_INLINE void multiply_matrix(D d, Size rows, Size columns, const T* HWY_RESTRICT matrix,
                                const T* HWY_RESTRICT x, const Sink& sink) {
    std::size_t row = 0;
    const auto shifted = [&](std::size_t r, hn::Vec<D> low, hn::Vec<D> high)
                             HWY_ATTR { sink(row + r, low, high); };
    for (; row + 5 < rows || row + 4 == rows; row += 4) {
        multiply_rows<4>(d, matrix + row * columns, columns, x, shifted);
    }
    for (; row + 3 <= rows; row += 3) {
        multiply_rows<3>(d, matrix + row * columns, columns, x, shifted);
    }
    if (row + 2 == rows) multiply_rows<2>(d, matrix + row * columns, columns, x, shifted);
    if (row + 1 == rows) multiply_rows<1>(d, matrix + row * columns, columns, x, shifted);
}

// `count` <= tile_width(d) vectors of `size` numbers into a tile; lanes beyond them become 0.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE void to_tile(D d, std::size_t size, std::size_t count, const T* in, T* tile) {
    const std::size_t lanes = hn::Lanes(d), width = tile_width(d);
    for (std::size_t first = 0; first < width; first += lanes) {
        if (first + lanes <= count) {
            to_lanes(d, size, in + first * size, tile + first, width);
        } else {
            to_some_lanes(d, size, count > first ? count - first : 0, in + first * size,
                          tile + first, width);
        }
    }
}

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void from_tile(D d, std::size_t size, std::size_t count, const T* tile, T* out) {
    const std::size_t lanes = hn::Lanes(d), width = tile_width(d);
    for (std::size_t first = 0; first < count; first += lanes) {
        if (first + lanes <= count) {
            from_lanes(d, size, tile + first, width, out + first * size);
        } else {
            from_some_lanes(size, count - first, tile + first, width, out + first * size);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_SH_MATRIX_LANES_INL_H
