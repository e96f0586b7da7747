// SPDX-License-Identifier: Apache-2.0
// Vectors of coefficients, one after the other in memory, to SIMD lanes and back: compiled once per
// SIMD target (see Highway's foreach_target.h), so the guard below turns with the target.
//
// A tile holds `lanes` vectors coefficient by coefficient: coefficient k of vector v lies at
// tile[k * stride + v]. In memory vector v begins at v * size.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#if defined(AIRLIGHT_SH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_SH_LANES_INL_H
#undef AIRLIGHT_SH_LANES_INL_H
#else
#define AIRLIGHT_SH_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void to_lanes(D, std::size_t size, const T* in, T* tile, std::size_t stride) {
    for (std::size_t k = 0; k < size; ++k) tile[k * stride] = in[k];
}

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void from_lanes(D, std::size_t size, const T* tile, std::size_t stride, T* out) {
    for (std::size_t k = 0; k < size; ++k) out[k] = tile[k * stride];
}

#else

// Blocks of 128 bits, block b from `from + b * stride`.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> load_blocks(D d, const T* HWY_RESTRICT from, std::size_t stride) {
    if constexpr (hn::MaxLanes(d) * sizeof(T) <= 16) {
        return hn::LoadU(d, from);
    } else {
        const hn::Half<D> half;
        constexpr std::size_t kBlocks = hn::MaxLanes(half) * sizeof(T) / 16;
        return hn::Combine(d, load_blocks(half, from + kBlocks * stride, stride),
                           load_blocks(half, from, stride));
    }
}

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void store_blocks(D d, hn::Vec<D> value, T* HWY_RESTRICT to, std::size_t stride) {
    if constexpr (hn::MaxLanes(d) * sizeof(T) <= 16) {
        hn::StoreU(value, d, to);
    } else {
        const hn::Half<D> half;
        constexpr std::size_t kBlocks = hn::MaxLanes(half) * sizeof(T) / 16;
        store_blocks(half, hn::LowerHalf(half, value), to, stride);
        store_blocks(half, hn::UpperHalf(half, value), to + kBlocks * stride, stride);
    }
}

// Transposes the square of numbers that one block of each of v[0], v[1] ... makes.
template <class D>
HWY_INLINE void transpose_blocks(D d, hn::Vec<D> (&v)[2]) {
    const auto low = hn::InterleaveLower(d, v[0], v[1]);
    v[1] = hn::InterleaveUpper(d, v[0], v[1]);
    v[0] = low;
}

template <class D>
HWY_INLINE void transpose_blocks(D d, hn::Vec<D> (&v)[4]) {
    const hn::RepartitionToWide<D> wide;
    const auto a = hn::BitCast(wide, hn::InterleaveLower(d, v[0], v[1]));
    const auto b = hn::BitCast(wide, hn::InterleaveLower(d, v[2], v[3]));
    const auto e = hn::BitCast(wide, hn::InterleaveUpper(d, v[0], v[1]));
    const auto f = hn::BitCast(wide, hn::InterleaveUpper(d, v[2], v[3]));
    v[0] = hn::BitCast(d, hn::InterleaveLower(wide, a, b));
    v[1] = hn::BitCast(d, hn::InterleaveUpper(wide, a, b));
    v[2] = hn::BitCast(d, hn::InterleaveLower(wide, e, f));
    v[3] = hn::BitCast(d, hn::InterleaveUpper(wide, e, f));
}

// `size` coefficients of Lanes(d) vectors into a tile.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE void to_lanes(D d, std::size_t size, const T* HWY_RESTRICT in, T* HWY_RESTRICT tile,
                         std::size_t stride) {
    constexpr std::size_t kBlock = 16 / sizeof(T);
    const std::size_t lanes = hn::Lanes(d);
    if (size < kBlock) {
        for (std::size_t k = 0; k < size; ++k) {
            for (std::size_t v = 0; v < lanes; ++v) tile[k * stride + v] = in[v * size + k];
        }
        return;
    }
    for (std::size_t k = 0; k < size; k += kBlock) {
        // The last block of columns may repeat some of the one before.
        const std::size_t first = std::min(k, size - kBlock);
        hn::Vec<D> v[kBlock];
        for (std::size_t r = 0; r < kBlock; ++r) {
            v[r] = load_blocks(d, in + r * size + first, kBlock * size);
        }
        transpose_blocks(d, v);
        for (std::size_t r = 0; r < kBlock; ++r) hn::Store(v[r], d, tile + (first + r) * stride);
    }
}

// The reverse.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE void from_lanes(D d, std::size_t size, const T* HWY_RESTRICT tile, std::size_t stride,
                           T* HWY_RESTRICT out) {
    constexpr std::size_t kBlock = 16 / sizeof(T);
    const std::size_t lanes = hn::Lanes(d);
    if (size < kBlock) {
        for (std::size_t k = 0; k < size; ++k) {
            for (std::size_t v = 0; v < lanes; ++v) out[v * size + k] = tile[k * stride + v];
        }
        return;
    }
    for (std::size_t k = 0; k < size; k += kBlock) {
        const std::size_t first = std::min(k, size - kBlock);
        hn::Vec<D> v[kBlock];
        for (std::size_t r = 0; r < kBlock; ++r) v[r] = hn::Load(d, tile + (first + r) * stride);
        transpose_blocks(d, v);
        for (std::size_t r = 0; r < kBlock; ++r) {
            store_blocks(d, v[r], out + r * size + first, kBlock * size);
        }
    }
}

#endif

// The first `count` < Lanes(d) vectors; the other lanes become 0.
template <class D, class T = hn::TFromD<D>>
HWY_NOINLINE void to_some_lanes(D d, std::size_t size, std::size_t count, const T* in, T* tile,
                                std::size_t stride) {
    for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t v = 0; v < count; ++v) tile[k * stride + v] = in[v * size + k];
        std::fill(tile + k * stride + count, tile + k * stride + hn::Lanes(d), T{0});
    }
}

template <class T>
HWY_NOINLINE void from_some_lanes(std::size_t size, std::size_t count, const T* tile,
                                  std::size_t stride, T* out) {
    for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t v = 0; v < count; ++v) out[v * size + k] = tile[k * stride + v];
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_SH_LANES_INL_H
