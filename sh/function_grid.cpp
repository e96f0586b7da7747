// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/function_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"
#include "sh/aligned.h"
#include "sh/basis.h"
#include "sh/function_grid.h"
#include "sh/index.h"
#include "sh/matrix_lanes-inl.h"
#include "sh/quadrature.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using Vec = hn::Vec<Tag>;

// kInputs vectors of coefficients in, function(values at a point) back to coefficients.
template <std::size_t kInputs, class Function>
HWY_INLINE void on_grid(std::size_t size, std::size_t points, const float* synthesis,
                        const float* analysis, std::size_t count, const float* const (&in)[kInputs],
                        float* out, const Function& function) {
    const Tag d;
    const std::size_t width = tile_width(d);
    AlignedVector<float> memory((size + kInputs * points) * width);
    float* const tile = memory.data();
    float* const values = tile + size * width;
    for (std::size_t i = 0; i < count; i += width) {
        const std::size_t here = std::min(width, count - i);
        for (std::size_t k = 0; k < kInputs; ++k) {
            to_tile(d, size, here, in[k] + i * size, tile);
            float* const to = values + k * points * width;
            multiply_matrix(d, points, size, synthesis, tile,
                            [&](std::size_t point, Vec low, Vec high) HWY_ATTR {
                                hn::Store(low, d, to + point * width);
                                hn::Store(high, d, to + point * width + width / 2);
                            });
        }
        for (std::size_t j = 0; j < points * width; j += width / 2) {
            Vec x[kInputs];
            for (std::size_t k = 0; k < kInputs; ++k) {
                x[k] = hn::Load(d, values + k * points * width + j);
            }
            hn::Store(function(x), d, values + j);
        }
        multiply_matrix(d, size, points, analysis, values,
                        [&](std::size_t row, Vec low, Vec high) HWY_ATTR {
                            hn::Store(low, d, tile + row * width);
                            hn::Store(high, d, tile + row * width + width / 2);
                        });
        from_tile(d, size, here, tile, out + i * size);
    }
}

// Highway's functions and limits make numbers of NaN.
HWY_INLINE Vec keep_nan(Vec x, Vec result) {
    return hn::IfThenElse(hn::IsNaN(x), x, result);
}

HWY_ATTR void grid_exponential(std::size_t size, std::size_t points, const float* synthesis,
                               const float* analysis, std::size_t count, const float* in,
                               float* out) {
    on_grid<1>(size, points, synthesis, analysis, count, {in}, out,
               [](const Vec(&x)[1]) HWY_ATTR { return keep_nan(x[0], hn::Exp(Tag(), x[0])); });
}

HWY_ATTR void grid_logarithm(std::size_t size, std::size_t points, const float* synthesis,
                             const float* analysis, std::size_t count, float floor, const float* in,
                             float* out) {
    on_grid<1>(size, points, synthesis, analysis, count, {in}, out, [=](const Vec(&x)[1]) HWY_ATTR {
        return keep_nan(x[0], hn::Log(Tag(), hn::Max(x[0], hn::Set(Tag(), floor))));
    });
}

HWY_ATTR void grid_clamp(std::size_t size, std::size_t points, const float* synthesis,
                         const float* analysis, std::size_t count, float low, float high,
                         const float* in, float* out) {
    on_grid<1>(size, points, synthesis, analysis, count, {in}, out, [=](const Vec(&x)[1]) HWY_ATTR {
        return keep_nan(x[0], hn::Min(hn::Max(x[0], hn::Set(Tag(), low)), hn::Set(Tag(), high)));
    });
}

HWY_ATTR void grid_multiply(std::size_t size, std::size_t points, const float* synthesis,
                            const float* analysis, std::size_t count, const float* a,
                            const float* b, float* out) {
    on_grid<2>(size, points, synthesis, analysis, count, {a, b}, out,
               [](const Vec(&x)[2]) HWY_ATTR { return hn::Mul(x[0], x[1]); });
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(grid_exponential);
HWY_EXPORT(grid_logarithm);
HWY_EXPORT(grid_clamp);
HWY_EXPORT(grid_multiply);

ShGrid::ShGrid(int order, int rows) : order_(order) {
    if (order < 1 || (rows != 0 && rows < order)) {
        throw Error(ErrorCode::usage,
                    fmt::format("a grid of {} rows for order {}: the order must be at least 1, the "
                                "rows 0 or at least the order",
                                rows, order));
    }
    const std::size_t size = sh_count(order);
    const std::size_t height = static_cast<std::size_t>(rows == 0 ? 2 * std::int64_t{order} : rows);
    const std::string what = fmt::format("a grid of {} rows for order {}", height, order);
    require_memory(checked_product({2, height, height, size, 2 * sizeof(double)}, what),
                   kDefaultMaxMemory, what);
    rows = static_cast<int>(height);
    const PolarRule rule = gauss_legendre(rows);
    const int columns = 2 * rows;
    points_ = 2 * height * height;
    basis_.resize(points_ * size);
    weights_.resize(points_);
    std::size_t point = 0;
    for (int i = 0; i < rows; ++i) {
        const auto row = static_cast<std::size_t>(i);
        for (int j = 0; j < columns; ++j, ++point) {
            const double phi = 2 * kPi * (j + 0.5) / columns;
            evaluate_basis(order, rule.sine[row] * std::cos(phi), rule.sine[row] * std::sin(phi),
                           rule.cosine[row], &basis_[point * size]);
            weights_[point] = rule.weight[row] * 2 * kPi / columns;
        }
    }
    synthesis_.assign(basis_.begin(), basis_.end());
    analysis_.resize(basis_.size());
    for (std::size_t p = 0; p < points_; ++p) {
        for (std::size_t k = 0; k < size; ++k) {
            analysis_[k * points_ + p] = static_cast<float>(weights_[p] * basis_[p * size + k]);
        }
    }
}

void ShGrid::apply(const std::function<double(double)>& function, const double* in,
                   double* out) const {
    const std::size_t size = sh_count(order_);
    std::vector<double> sum(size);
    for (std::size_t p = 0; p < points_; ++p) {
        const double* const y = &basis_[p * size];
        double value = 0;
        for (std::size_t k = 0; k < size; ++k) value += in[k] * y[k];
        value = weights_[p] * function(value);
        for (std::size_t k = 0; k < size; ++k) sum[k] += value * y[k];
    }
    std::copy(sum.begin(), sum.end(), out);
}

void ShGrid::multiply(const double* a, const double* b, double* out) const {
    const std::size_t size = sh_count(order_);
    std::vector<double> sum(size);
    for (std::size_t p = 0; p < points_; ++p) {
        const double* const y = &basis_[p * size];
        double of_a = 0, of_b = 0;
        for (std::size_t k = 0; k < size; ++k) {
            of_a += a[k] * y[k];
            of_b += b[k] * y[k];
        }
        const double value = weights_[p] * of_a * of_b;
        for (std::size_t k = 0; k < size; ++k) sum[k] += value * y[k];
    }
    std::copy(sum.begin(), sum.end(), out);
}

void ShGrid::exponential(std::size_t count, const float* in, float* out) const {
    HWY_DYNAMIC_DISPATCH(grid_exponential)
    (sh_count(order_), points_, synthesis_.data(), analysis_.data(), count, in, out);
}

void ShGrid::logarithm(std::size_t count, float floor, const float* in, float* out) const {
    if (!(floor > 0) || std::isinf(floor)) {
        throw Error(ErrorCode::usage, "logarithm of a function on the sphere: the floor is " +
                                          fmt::format("{}, it must be above 0 and finite", floor));
    }
    HWY_DYNAMIC_DISPATCH(grid_logarithm)
    (sh_count(order_), points_, synthesis_.data(), analysis_.data(), count, floor, in, out);
}

void ShGrid::clamp(std::size_t count, float low, float high, const float* in, float* out) const {
    if (!(low <= high)) {
        throw Error(ErrorCode::usage, "clamp of a function on the sphere: the limits are " +
                                          fmt::format("{} and {}, the first must not exceed the "
                                                      "second",
                                                      low, high));
    }
    HWY_DYNAMIC_DISPATCH(grid_clamp)
    (sh_count(order_), points_, synthesis_.data(), analysis_.data(), count, low, high, in, out);
}

void ShGrid::multiply(std::size_t count, const float* a, const float* b, float* out) const {
    HWY_DYNAMIC_DISPATCH(grid_multiply)
    (sh_count(order_), points_, synthesis_.data(), analysis_.data(), count, a, b, out);
}

}  // namespace airlight
#endif
