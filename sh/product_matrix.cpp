// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/product_matrix.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "sh/aligned.h"
#include "sh/index.h"
#include "sh/matrix_lanes-inl.h"
#include "sh/product_matrix.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class T>
HWY_INLINE void multiply_all(std::size_t size, const T* matrix, std::size_t count, const T* v,
                             T* out) {
    const hn::ScalableTag<T> d;
    using V = hn::Vec<decltype(d)>;
    const std::size_t width = tile_width(d);
    AlignedVector<T> tiles(2 * size * width);
    T* const x = tiles.data();
    T* const y = x + size * width;
    for (std::size_t i = 0; i < count; i += width) {
        const std::size_t here = std::min(width, count - i);
        to_tile(d, size, here, v + i * size, x);
        multiply_matrix(d, size, size, matrix, x, [&](std::size_t row, V low, V high) HWY_ATTR {
            hn::Store(low, d, y + row * width);
            hn::Store(high, d, y + row * width + width / 2);
        });
        from_tile(d, size, here, y, out + i * size);
    }
}

template <class T>
HWY_INLINE void integrate_all(std::size_t size, const T* matrix, std::size_t count, const T* v,
                              const T* b, T* out) {
    const hn::ScalableTag<T> d;
    using V = hn::Vec<decltype(d)>;
    const std::size_t lanes = hn::Lanes(d), width = tile_width(d);
    AlignedVector<T> tiles((2 * size + 1) * width);
    T* const x = tiles.data();
    T* const y = x + size * width;
    T* const sums = y + size * width;
    for (std::size_t i = 0; i < count; i += width) {
        const std::size_t here = std::min(width, count - i);
        to_tile(d, size, here, v + i * size, x);
        to_tile(d, size, here, b + i * size, y);
        V sum_low = hn::Zero(d), sum_high = sum_low;
        multiply_matrix(d, size, size, matrix, x, [&](std::size_t row, V low, V high) HWY_ATTR {
            sum_low = hn::MulAdd(low, hn::Load(d, y + row * width), sum_low);
            sum_high = hn::MulAdd(high, hn::Load(d, y + row * width + lanes), sum_high);
        });
        hn::Store(sum_low, d, sums);
        hn::Store(sum_high, d, sums + lanes);
        std::copy_n(sums, here, out + i);
    }
}

template <class T>
HWY_INLINE void dot_all(std::size_t size, const T* f, std::size_t count, const T* v, T* out) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d), whole = size - size % lanes;
    for (std::size_t i = 0; i < count; ++i, v += size) {
        auto sum = hn::Zero(d);
        std::size_t k = 0;
        for (; k < whole; k += lanes) {
            sum = hn::MulAdd(hn::LoadU(d, f + k), hn::LoadU(d, v + k), sum);
        }
        T rest = 0;
        for (; k < size; ++k) rest += f[k] * v[k];
        out[i] = hn::GetLane(hn::SumOfLanes(d, sum)) + rest;
    }
}

#define AIRLIGHT_PRODUCT_MATRIX(T)                                                                \
    HWY_ATTR void multiply_##T(std::size_t size, const T* matrix, std::size_t count, const T* v,  \
                               T* out) {                                                          \
        multiply_all(size, matrix, count, v, out);                                                \
    }                                                                                             \
    HWY_ATTR void integrate_##T(std::size_t size, const T* matrix, std::size_t count, const T* v, \
                                const T* b, T* out) {                                             \
        integrate_all(size, matrix, count, v, b, out);                                            \
    }                                                                                             \
    HWY_ATTR void dot_##T(std::size_t size, const T* f, std::size_t count, const T* v, T* out) {  \
        dot_all(size, f, count, v, out);                                                          \
    }
AIRLIGHT_PRODUCT_MATRIX(float)
AIRLIGHT_PRODUCT_MATRIX(double)
#undef AIRLIGHT_PRODUCT_MATRIX

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

template <class Real>
std::vector<double> product_matrix(const TripleProducts& triples, const Real* light) {
    const std::size_t size = sh_count(triples.order());
    std::vector<double> matrix(size * size);
    for (std::size_t k = 0; k < size; ++k) {
        double* const row = matrix.data() + k * size;
        for (const TripleProducts::Term* t = triples.begin(k); t != triples.end(k); ++t) {
            row[t->j] += t->value * light[t->i];
            row[t->i] += t->value * light[t->j];
        }
    }
    return matrix;
}

}  // namespace

HWY_EXPORT(multiply_float);
HWY_EXPORT(multiply_double);
HWY_EXPORT(integrate_float);
HWY_EXPORT(integrate_double);
HWY_EXPORT(dot_float);
HWY_EXPORT(dot_double);

ShProductMatrix::ShProductMatrix(const TripleProducts& triples, const double* light)
    : order_(triples.order()),
      double_(product_matrix(triples, light)),
      float_(double_.begin(), double_.end()) {}

ShProductMatrix::ShProductMatrix(const TripleProducts& triples, const float* light)
    : order_(triples.order()),
      double_(product_matrix(triples, light)),
      float_(double_.begin(), double_.end()) {}

void ShProductMatrix::multiply(std::size_t count, const double* v, double* out) const {
    HWY_DYNAMIC_DISPATCH(multiply_double)(sh_count(order_), double_.data(), count, v, out);
}

void ShProductMatrix::multiply(std::size_t count, const float* v, float* out) const {
    HWY_DYNAMIC_DISPATCH(multiply_float)(sh_count(order_), float_.data(), count, v, out);
}

void ShProductMatrix::integral(std::size_t count, const double* v, const double* b,
                               double* out) const {
    HWY_DYNAMIC_DISPATCH(integrate_double)(sh_count(order_), double_.data(), count, v, b, out);
}

void ShProductMatrix::integral(std::size_t count, const float* v, const float* b,
                               float* out) const {
    HWY_DYNAMIC_DISPATCH(integrate_float)(sh_count(order_), float_.data(), count, v, b, out);
}

void sh_dot(int order, const double* f, std::size_t count, const double* v, double* out) {
    HWY_DYNAMIC_DISPATCH(dot_double)(sh_count(order), f, count, v, out);
}

void sh_dot(int order, const float* f, std::size_t count, const float* v, float* out) {
    HWY_DYNAMIC_DISPATCH(dot_float)(sh_count(order), f, count, v, out);
}

}  // namespace airlight
#endif
