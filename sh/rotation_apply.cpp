// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/rotation_apply.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <type_traits>

#include "sh/aligned.h"
#include "sh/index.h"
#include "sh/matrix_lanes-inl.h"
#include "sh/rotation.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void rotate_tile(D d, int order, const T* HWY_RESTRICT matrix, const T* HWY_RESTRICT x,
                            T* HWY_RESTRICT y) {
    const std::size_t width = tile_width(d);
    hn::Store(hn::Load(d, x), d, y);
    hn::Store(hn::Load(d, x + width / 2), d, y + width / 2);
    const auto next = [&](auto size) HWY_ATTR {
        matrix += (size - 2) * (size - 2);
        x += (size - 2) * width;
        y += (size - 2) * width;
        multiply_matrix(d, size, size, matrix, x,
                        [&](std::size_t row, hn::Vec<D> low, hn::Vec<D> high) HWY_ATTR {
                            hn::Store(low, d, y + row * width);
                            hn::Store(high, d, y + row * width + width / 2);
                        });
    };
    // Sizes that the compiler knows save a tenth of the time where bands are short.
    if (order > 1) next(std::integral_constant<std::size_t, 3>());
    if (order > 2) next(std::integral_constant<std::size_t, 5>());
    if (order > 3) next(std::integral_constant<std::size_t, 7>());
    if (order > 4) next(std::integral_constant<std::size_t, 9>());
    if (order > 5) next(std::integral_constant<std::size_t, 11>());
    for (int l = 6; l < order; ++l) next(static_cast<std::size_t>(2 * l + 1));
}

template <class T>
HWY_INLINE void rotate_vectors(int order, const T* matrix, std::size_t count, const T* in, T* out) {
    const hn::ScalableTag<T> d;
    const std::size_t size = sh_count(order), width = tile_width(d);
    AlignedVector<T> tiles(2 * size * width);
    T* const x = tiles.data();
    T* const y = x + size * width;
    for (std::size_t v = 0; v < count; v += width, in += width * size, out += width * size) {
        const std::size_t here = std::min(width, count - v);
        to_tile(d, size, here, in, x);
        rotate_tile(d, order, matrix, x, y);
        from_tile(d, size, here, y, out);
    }
}

template <class T>
HWY_INLINE void rotate_all_planes(int order, const T* matrix, std::size_t count, std::size_t stride,
                                  const T* in, T* out) {
    const hn::ScalableTag<T> d;
    const std::size_t size = sh_count(order), lanes = hn::Lanes(d), width = tile_width(d);
    AlignedVector<T> tiles(2 * size * width);
    T* const x = tiles.data();
    T* const y = x + size * width;
    for (std::size_t v = 0; v < count; v += width) {
        const std::size_t here = std::min(width, count - v);
        if (here == width) {
            for (std::size_t k = 0; k < size; ++k) {
                hn::Store(hn::LoadU(d, in + k * stride + v), d, x + k * width);
                hn::Store(hn::LoadU(d, in + k * stride + v + lanes), d, x + k * width + lanes);
            }
        } else {
            for (std::size_t k = 0; k < size; ++k) {
                std::copy_n(in + k * stride + v, here, x + k * width);
                std::fill(x + k * width + here, x + (k + 1) * width, T{0});
            }
        }
        rotate_tile(d, order, matrix, x, y);
        if (here == width) {
            for (std::size_t k = 0; k < size; ++k) {
                hn::StoreU(hn::Load(d, y + k * width), d, out + k * stride + v);
                hn::StoreU(hn::Load(d, y + k * width + lanes), d, out + k * stride + v + lanes);
            }
        } else {
            for (std::size_t k = 0; k < size; ++k) {
                std::copy_n(y + k * width, here, out + k * stride + v);
            }
        }
    }
}

HWY_ATTR void rotate_float(int order, const float* matrix, std::size_t count, const float* in,
                           float* out) {
    rotate_vectors(order, matrix, count, in, out);
}

HWY_ATTR void rotate_double(int order, const double* matrix, std::size_t count, const double* in,
                            double* out) {
    rotate_vectors(order, matrix, count, in, out);
}

HWY_ATTR void rotate_planes_float(int order, const float* matrix, std::size_t count,
                                  std::size_t stride, const float* in, float* out) {
    rotate_all_planes(order, matrix, count, stride, in, out);
}

HWY_ATTR void rotate_planes_double(int order, const double* matrix, std::size_t count,
                                   std::size_t stride, const double* in, double* out) {
    rotate_all_planes(order, matrix, count, stride, in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(rotate_float);
HWY_EXPORT(rotate_double);
HWY_EXPORT(rotate_planes_float);
HWY_EXPORT(rotate_planes_double);

void ShRotation::rotate(std::size_t count, const double* in, double* out) const {
    HWY_DYNAMIC_DISPATCH(rotate_double)(order_, double_.data(), count, in, out);
}

void ShRotation::rotate(std::size_t count, const float* in, float* out) const {
    HWY_DYNAMIC_DISPATCH(rotate_float)(order_, float_.data(), count, in, out);
}

void ShRotation::rotate_planes(std::size_t count, std::size_t stride, const double* in,
                               double* out) const {
    assert(stride >= count);
    HWY_DYNAMIC_DISPATCH(rotate_planes_double)(order_, double_.data(), count, stride, in, out);
}

void ShRotation::rotate_planes(std::size_t count, std::size_t stride, const float* in,
                               float* out) const {
    assert(stride >= count);
    HWY_DYNAMIC_DISPATCH(rotate_planes_float)(order_, float_.data(), count, stride, in, out);
}

}  // namespace airlight
#endif
