// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/product_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/product_lanes-inl.h"
#include "sh/product_rows.h"
#include "sh/quadrature.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Fourier coefficients of one row and vector of pairs: x_0 ... x_n-1, then y_1 ... y_n-1.
template <class D, class Order, class T = hn::TFromD<D>>
class RowView {
  public:
    HWY_INLINE RowView(D, Order order, const T* from) : from_(from), order_(order) {}
    HWY_INLINE hn::Vec<D> x(int m) const { return hn::Load(D(), from_ + m * kLanes); }
    HWY_INLINE hn::Vec<D> y(int m) const {
        return hn::Load(D(), from_ + (order_ - 1 + m) * kLanes);
    }

  private:
    static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
    const T* HWY_RESTRICT from_;
    Order order_;
};

// Coefficient m of the product of two rows, x into *x and, for m > 0, y into *y.
template <class D, class Order, class M>
HWY_INLINE void convolve(D d, Order order, M m, const RowView<D, Order>& a,
                         const RowView<D, Order>& b, hn::Vec<D>* x, hn::Vec<D>* y) {
    if (m == 0) {
        auto cosines = hn::Zero(d), sines = hn::Zero(d);
        for (int q = 1; q < order; ++q) {
            cosines = hn::MulAdd(a.x(q), b.x(q), cosines);
            sines = hn::MulAdd(a.y(q), b.y(q), sines);
        }
        const auto half = hn::Add(cosines, sines);
        *x = hn::MulAdd(a.x(0), b.x(0), hn::Add(half, half));
        return;
    }
    auto x0 = hn::Mul(a.x(0), b.x(m)), x1 = hn::Mul(a.x(m), b.x(0));
    auto y0 = hn::Mul(a.x(0), b.y(m)), y1 = hn::Mul(a.y(m), b.x(0));
    for (int q = 1; q < m; ++q) {
        const int p = m - q;
        x0 = hn::MulAdd(a.x(q), b.x(p), x0);
        x1 = hn::NegMulAdd(a.y(q), b.y(p), x1);
        y0 = hn::MulAdd(a.x(q), b.y(p), y0);
        y1 = hn::MulAdd(a.y(q), b.x(p), y1);
    }
    for (int q = 1; q < order - m; ++q) {
        const int p = m + q;
        x0 = hn::MulAdd(a.x(p), b.x(q), x0);
        x1 = hn::MulAdd(a.y(p), b.y(q), x1);
        y0 = hn::MulAdd(a.y(p), b.x(q), y0);
        y1 = hn::NegMulAdd(a.x(p), b.y(q), y1);
        x0 = hn::MulAdd(a.x(q), b.x(p), x0);
        x1 = hn::MulAdd(a.y(q), b.y(p), x1);
        y0 = hn::MulAdd(a.x(q), b.y(p), y0);
        y1 = hn::NegMulAdd(a.y(q), b.x(p), y1);
    }
    *x = hn::Add(x0, x1);
    *y = hn::Add(y0, y1);
}

// f(m) for m = 0 ... order-1; of a constant order with a constant m.
template <class F, int... kM>
HWY_INLINE void unrolled(const F& f, std::integer_sequence<int, kM...>) {
    (f(std::integral_constant<int, kM>()), ...);
}
template <int kOrder, class F>
HWY_INLINE void for_each_m(std::integral_constant<int, kOrder>, const F& f) {
    unrolled(f, std::make_integer_sequence<int, kOrder>());
}
template <class F>
HWY_INLINE void for_each_m(int order, const F& f) {
    for (int m = 0; m < order; ++m) f(m);
}

// Gauss-Legendre rows of an order, and half of a number: constants of a constant.
template <int kOrder>
constexpr auto row_nodes(std::integral_constant<int, kOrder>) {
    return std::integral_constant<int, (3 * kOrder - 1) / 2>();
}
constexpr int row_nodes(int order) {
    return (3 * order - 1) / 2;
}
template <int kNodes>
constexpr auto half_of(std::integral_constant<int, kNodes>) {
    return std::integral_constant<int, kNodes / 2>();
}
constexpr int half_of(int count) {
    return count / 2;
}

template <class T>
struct RowKernel {
    const detail::ProductRows<T>& tables;

    std::size_t scratch(std::size_t lanes) const {
        return ((4 + 2 * tables.rows) * static_cast<std::size_t>(2 * tables.order - 1) +
                2 * sh_count(tables.order)) *
               lanes;
    }

    // Rows i of a function: north and south of the equator, or on it (north alone).
    template <class D, class Order>
    HWY_INLINE void synthesize(D d, Order order, const T* HWY_RESTRICT p, bool equator,
                               const T* HWY_RESTRICT in, T* HWY_RESTRICT north,
                               T* HWY_RESTRICT south) const {
        constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
        for_each_m(order, [&](auto m) HWY_ATTR {
            auto even_x = hn::Zero(d), odd_x = hn::Zero(d);
            auto even_y = hn::Zero(d), odd_y = hn::Zero(d);
            for (int l = m; l < order; l += 2) {
                const auto value = hn::Set(d, p[l - m]);
                even_x = hn::MulAdd(value, hn::Load(d, in + (l * l + l + m) * kLanes), even_x);
                if (m > 0) {
                    even_y = hn::MulAdd(value, hn::Load(d, in + (l * l + l - m) * kLanes), even_y);
                }
            }
            const bool both = !equator && m + 1 < order;
            if (both) {
                for (int l = m + 1; l < order; l += 2) {
                    const auto value = hn::Set(d, p[l - m]);
                    odd_x = hn::MulAdd(value, hn::Load(d, in + (l * l + l + m) * kLanes), odd_x);
                    if (m > 0) {
                        odd_y =
                            hn::MulAdd(value, hn::Load(d, in + (l * l + l - m) * kLanes), odd_y);
                    }
                }
            }
            p += order - m;
            const int x = m * kLanes, y = (order - 1 + m) * kLanes;
            hn::Store(both ? hn::Add(even_x, odd_x) : even_x, d, north + x);
            if (m > 0) hn::Store(both ? hn::Add(even_y, odd_y) : even_y, d, north + y);
            if (equator) return;
            hn::Store(both ? hn::Sub(even_x, odd_x) : even_x, d, south + x);
            if (m > 0) hn::Store(both ? hn::Sub(even_y, odd_y) : even_y, d, south + y);
        });
    }

    // Tiles of coefficients, slot k at [k * lanes].
    template <class D, class Order>
    HWY_INLINE void run(D d, Order order, const T* HWY_RESTRICT a, const T* HWY_RESTRICT b,
                        T* HWY_RESTRICT scratch, T* out) const {
        constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
        const auto row_size = (2 * order - 1) * kLanes;
        const auto all = row_nodes(order), pairs = half_of(all);
        const auto rows = all - pairs;
        T* const north_a = scratch;
        T* const south_a = north_a + row_size;
        T* const north_b = south_a + row_size;
        T* const south_b = north_b + row_size;
        // Even and odd halves of the products, row after row.
        T* const even = south_b + row_size;
        T* const odd = even + rows * row_size;
        for (int i = 0; i < pairs; ++i) {
            const T* const p =
                tables.synthesis.data() + static_cast<std::size_t>(i) * tables.columns;
            synthesize(d, order, p, false, a, north_a, south_a);
            synthesize(d, order, p, false, b, north_b, south_b);
            const RowView<D, Order> na(d, order, north_a), nb(d, order, north_b);
            const RowView<D, Order> sa(d, order, south_a), sb(d, order, south_b);
            T* const to_even = even + i * row_size;
            T* const to_odd = odd + i * row_size;
            for_each_m(order, [&](auto m) HWY_ATTR {
                hn::Vec<D> nx, ny = hn::Zero(d), sx, sy = ny;
                convolve(d, order, m, na, nb, &nx, &ny);
                convolve(d, order, m, sa, sb, &sx, &sy);
                const int x = m * kLanes, y = (order - 1 + m) * kLanes;
                hn::Store(hn::Add(nx, sx), d, to_even + x);
                hn::Store(hn::Sub(nx, sx), d, to_odd + x);
                if (m > 0) {
                    hn::Store(hn::Add(ny, sy), d, to_even + y);
                    hn::Store(hn::Sub(ny, sy), d, to_odd + y);
                }
            });
        }
        if (rows > pairs) {
            const T* const p =
                tables.synthesis.data() + static_cast<std::size_t>(pairs) * tables.columns;
            synthesize(d, order, p, true, a, north_a, south_a);
            synthesize(d, order, p, true, b, north_b, south_b);
            const RowView<D, Order> ra(d, order, north_a), rb(d, order, north_b);
            T* const to_even = even + pairs * row_size;
            for_each_m(order, [&](auto m) HWY_ATTR {
                hn::Vec<D> x, y = hn::Zero(d);
                convolve(d, order, m, ra, rb, &x, &y);
                hn::Store(x, d, to_even + m * kLanes);
                if (m > 0) hn::Store(y, d, to_even + (order - 1 + m) * kLanes);
            });
        }
        const T* HWY_RESTRICT weight = tables.analysis.data();
        for_each_m(order, [&](auto m) HWY_ATTR {
            for (int l = m; l < order; ++l) {
                const bool is_even = (l - m) % 2 == 0;
                const int here = is_even ? rows : pairs;
                const T* const products = is_even ? even : odd;
                auto x = hn::Zero(d), y = hn::Zero(d);
                for (int i = 0; i < here; ++i) {
                    const T* const row = products + i * row_size;
                    const auto w = hn::Set(d, weight[i]);
                    x = hn::MulAdd(w, hn::Load(d, row + m * kLanes), x);
                    if (m > 0) y = hn::MulAdd(w, hn::Load(d, row + (order - 1 + m) * kLanes), y);
                }
                weight += rows;
                hn::Store(x, d, out + (l * l + l + m) * kLanes);
                if (m > 0) hn::Store(y, d, out + (l * l + l - m) * kLanes);
            }
        });
    }

    template <class D, class Stride>
    HWY_INLINE void operator()(D d, const T* a, const T* b, Stride stride, T* out,
                               T* scratch) const {
        constexpr std::size_t kLanes = hn::MaxLanes(d);
        if constexpr (std::is_same_v<Stride, std::integral_constant<std::size_t, kLanes>>) {
            multiply(d, a, b, scratch, out);
        } else {
            // Addresses at a fixed distance are worth the copies.
            const std::size_t size = sh_count(tables.order);
            T* const tile_a = scratch;
            T* const tile_b = tile_a + size * kLanes;
            for (std::size_t k = 0; k < size; ++k) {
                hn::Store(hn::LoadU(d, a + k * stride), d, tile_a + k * kLanes);
                hn::Store(hn::LoadU(d, b + k * stride), d, tile_b + k * kLanes);
            }
            multiply(d, tile_a, tile_b, tile_b + size * kLanes, tile_a);
            for (std::size_t k = 0; k < size; ++k) {
                hn::StoreU(hn::Load(d, tile_a + k * kLanes), d, out + k * stride);
            }
        }
    }

    template <class D>
    HWY_INLINE void multiply(D d, const T* a, const T* b, T* scratch, T* out) const {
        const auto with = [&](auto order) HWY_ATTR { run(d, order, a, b, scratch, out); };
        if constexpr (std::is_same_v<T, float>) {
            switch (tables.order) {
                case 3:
                    return with(std::integral_constant<int, 3>());
                case 4:
                    return with(std::integral_constant<int, 4>());
                case 5:
                    return with(std::integral_constant<int, 5>());
                case 6:
                    return with(std::integral_constant<int, 6>());
                case 8:
                    return with(std::integral_constant<int, 8>());
            }
        }
        with(tables.order);
    }
};

#define AIRLIGHT_ROWS(T)                                                                           \
    HWY_ATTR void planes_##T(const detail::ProductRows<T>& tables, std::size_t count,              \
                             std::size_t stride, const T* a, const T* b, T* out) {                 \
        multiply_planes(sh_count(tables.order), count, stride, a, b, out, RowKernel<T>{tables});   \
    }                                                                                              \
    HWY_ATTR void vectors_##T(const detail::ProductRows<T>& tables, std::size_t count, const T* a, \
                              const T* b, T* out) {                                                \
        multiply_vectors(sh_count(tables.order), count, a, b, out, RowKernel<T>{tables});          \
    }
AIRLIGHT_ROWS(float)
AIRLIGHT_ROWS(double)
#undef AIRLIGHT_ROWS

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(planes_float);
HWY_EXPORT(planes_double);
HWY_EXPORT(vectors_float);
HWY_EXPORT(vectors_double);

namespace detail {

template <class T>
ProductRows<T>::ProductRows(int n) : order(n) {
    assert(n >= 1);
    const auto nodes = static_cast<std::size_t>((3 * n - 1) / 2);
    const PolarRule rule = gauss_legendre(static_cast<int>(nodes));
    pairs = nodes / 2;
    rows = nodes - pairs;
    columns = static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1) / 2;
    synthesis.resize(rows * columns);
    analysis.resize(columns * rows);
    std::vector<double> legendre(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < rows; ++i) {
        std::size_t column = 0;
        for (int m = 0; m < n; ++m) {
            normalized_legendre(n, rule.cosine[i], rule.sine[i], m, legendre.data());
            const double root = std::sqrt(2.0);
            for (int l = m; l < n; ++l, ++column) {
                const double p = legendre[static_cast<std::size_t>(l - m)];
                synthesis[i * columns + column] = static_cast<T>(m == 0 ? root * p : p);
                analysis[column * rows + i] =
                    static_cast<T>(rule.weight[i] * p * kPi * (m == 0 ? 1 : root));
            }
        }
    }
}

template struct ProductRows<float>;
template struct ProductRows<double>;

void multiply_rows(const ProductRows<float>& tables, std::size_t count, std::size_t stride,
                   const float* a, const float* b, float* out) {
    HWY_DYNAMIC_DISPATCH(planes_float)(tables, count, stride, a, b, out);
}

void multiply_rows(const ProductRows<double>& tables, std::size_t count, std::size_t stride,
                   const double* a, const double* b, double* out) {
    HWY_DYNAMIC_DISPATCH(planes_double)(tables, count, stride, a, b, out);
}

void multiply_rows(const ProductRows<float>& tables, std::size_t count, const float* a,
                   const float* b, float* out) {
    HWY_DYNAMIC_DISPATCH(vectors_float)(tables, count, a, b, out);
}

void multiply_rows(const ProductRows<double>& tables, std::size_t count, const double* a,
                   const double* b, double* out) {
    HWY_DYNAMIC_DISPATCH(vectors_double)(tables, count, a, b, out);
}

}  // namespace detail
}  // namespace airlight
#endif
