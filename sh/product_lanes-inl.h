// SPDX-License-Identifier: Apache-2.0
// The loops over pairs of vectors of every product, compiled once per SIMD target: no #pragma once.
//
// A Kernel<T> multiplies one SIMD vector of pairs that lie slot by slot,
//     void operator()(D d, const T* a, const T* b, Stride stride, T* out, T* scratch) const;
// where slot k of the pairs begins at [k * stride], `out` may be `a` or `b`, and scratch, aligned,
// has scratch(lanes) numbers. A Stride that is an integral_constant says that slots are aligned.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "sh/aligned.h"
#include "sh/lanes-inl.h"

#if defined(AIRLIGHT_SH_PRODUCT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_SH_PRODUCT_LANES_INL_H
#undef AIRLIGHT_SH_PRODUCT_LANES_INL_H
#else
#define AIRLIGHT_SH_PRODUCT_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Unset memory for a call, on the stack while it is small: one allocation costs as much as some
// products.
template <class T>
class Scratch {
  public:
    explicit Scratch(std::size_t count) {
        if (count > kSmall) large_.resize(count);
        data_ = count > kSmall ? large_.data() : small_;
    }
    T* data() const { return data_; }

  private:
    static constexpr std::size_t kSmall = 32768 / sizeof(T);
    alignas(64) T small_[kSmall];
    AlignedVector<T> large_;
    T* data_;
};

// The stride of a tile.
template <class T>
using Packed = std::integral_constant<std::size_t, hn::MaxLanes(hn::ScalableTag<T>())>;

template <class T, class Kernel>
HWY_INLINE void multiply_planes(std::size_t size, std::size_t count, std::size_t stride, const T* a,
                                const T* b, T* out, const Kernel& kernel) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d), rest = count % lanes;
    const Scratch<T> memory(kernel.scratch(lanes) + 2 * size * lanes);
    T* const scratch = memory.data() + 2 * size * lanes;
    std::size_t v = 0;
    for (; v + lanes <= count; v += lanes) kernel(d, a + v, b + v, stride, out + v, scratch);
    if (rest == 0) return;
    T* const tile_a = memory.data();
    T* const tile_b = tile_a + size * lanes;
    for (std::size_t k = 0; k < size; ++k) {
        std::copy_n(a + k * stride + v, rest, tile_a + k * lanes);
        std::copy_n(b + k * stride + v, rest, tile_b + k * lanes);
        std::fill(tile_a + k * lanes + rest, tile_a + (k + 1) * lanes, T{0});
        std::fill(tile_b + k * lanes + rest, tile_b + (k + 1) * lanes, T{0});
    }
    kernel(d, tile_a, tile_b, Packed<T>(), tile_a, scratch);
    for (std::size_t k = 0; k < size; ++k)
        std::copy_n(tile_a + k * lanes, rest, out + k * stride + v);
}

template <class T, class Kernel>
HWY_INLINE void multiply_vectors(std::size_t size, std::size_t count, const T* a, const T* b,
                                 T* out, const Kernel& kernel) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    const Scratch<T> memory(kernel.scratch(lanes) + 2 * size * lanes);
    T* const tile_a = memory.data();
    T* const tile_b = tile_a + size * lanes;
    T* const scratch = tile_b + size * lanes;
    for (std::size_t v = 0; v < count; v += lanes) {
        const std::size_t first = v * size, here = std::min(lanes, count - v);
        if (here == lanes) {
            to_lanes(d, size, a + first, tile_a, lanes);
            to_lanes(d, size, b + first, tile_b, lanes);
        } else {
            to_some_lanes(d, size, here, a + first, tile_a, lanes);
            to_some_lanes(d, size, here, b + first, tile_b, lanes);
        }
        kernel(d, tile_a, tile_b, Packed<T>(), tile_a, scratch);
        if (here == lanes) {
            from_lanes(d, size, tile_a, lanes, out + first);
        } else {
            from_some_lanes(size, here, tile_a, lanes, out + first);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_SH_PRODUCT_LANES_INL_H
