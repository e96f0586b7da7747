// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/row_moments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/constants.h"
#include "sh/row_moments.h"

#ifndef AIRLIGHT_SH_ROW_MOMENTS_ONCE
#define AIRLIGHT_SH_ROW_MOMENTS_ONCE
namespace airlight::detail {

/// Orders of one pass: their sums, the folded pixels and a factor fill the 16 registers of AVX2.
inline constexpr std::size_t kMomentGroup = 6;
/// A pixel is read as so many values, whatever its channels.
inline constexpr std::size_t kMomentLanes = 4;

template <class T>
struct MomentRow {
    const T* values;
    std::size_t columns, channels;
    bool folded;
};

}  // namespace airlight::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using detail::kMomentGroup;
using detail::kMomentLanes;
using detail::MomentRow;

using Tag = hn::CappedTag<double, kMomentLanes>;
using Vec = hn::Vec<Tag>;

HWY_INLINE Vec load(const double* values) {
    return hn::LoadU(Tag(), values);
}
HWY_INLINE Vec load(const float* values) {
    return hn::PromoteTo(Tag(), hn::LoadU(hn::Rebind<float, Tag>(), values));
}

// Adds to (cos, sin) of the orders m0 ... m0 + kOrders - 1, m0 even, what pixels with the given
// sums have: plus for even orders, minus for odd ones.
template <int kOrders, bool kFirst>
HWY_INLINE void add_orders(Vec cos_even, Vec cos_odd, Vec sin_even, Vec sin_odd,
                           const double* factors, Vec (&sums)[2 * kOrders]) {
    const Tag d;
    for (int i = 0; i < kOrders; ++i) {
        const Vec c = i % 2 == 0 ? cos_even : cos_odd;
        const Vec s = i % 2 == 0 ? sin_even : sin_odd;
        if (kFirst && i == 0) {
            sums[0] = hn::Add(sums[0], c);
        } else {
            sums[2 * i] = hn::MulAdd(hn::Set(d, factors[2 * i]), c, sums[2 * i]);
            sums[2 * i + 1] = hn::MulAdd(hn::Set(d, factors[2 * i + 1]), s, sums[2 * i + 1]);
        }
    }
}

// The moments of kOrders orders and of the channels from `first` on that a vector holds; `out` at
// the first of these orders, (channels, orders, 2).
template <int kOrders, bool kFirst, class T>
HWY_NOINLINE void add_group(const MomentRow<T>& row, std::size_t first, const double* factors,
                            std::size_t orders, double* out) {
    const Tag d;
    Vec sums[2 * kOrders];
    for (Vec& sum : sums) sum = hn::Zero(d);
    const std::size_t step = row.channels;
    const T* values = row.values + first;
    if (row.folded) {
        const T* left = values;
        const T* before_middle = values + (row.columns / 2 - 1) * step;
        const T* middle = values + row.columns / 2 * step;
        const T* right = values + (row.columns - 1) * step;
        for (std::size_t k = 0; k < row.columns / 4; ++k) {
            const Vec a = load(left), b = load(before_middle), c = load(middle), e = load(right);
            const Vec ae = hn::Add(a, e), bc = hn::Add(b, c);
            const Vec a_e = hn::Sub(a, e), c_b = hn::Sub(c, b);
            add_orders<kOrders, kFirst>(hn::Add(ae, bc), hn::Sub(ae, bc), hn::Add(a_e, c_b),
                                        hn::Sub(a_e, c_b), factors, sums);
            factors += 2 * kOrders;
            left += step;
            before_middle -= step;
            middle += step;
            right -= step;
        }
    } else {
        for (std::size_t k = 0; k < row.columns; ++k) {
            const Vec value = load(values + k * step);
            add_orders<kOrders, kFirst>(value, value, value, value, factors, sums);
            factors += 2 * kOrders;
        }
    }
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN double spread[2 * kOrders][kMomentLanes];
    for (int i = 0; i < 2 * kOrders; ++i) hn::Store(sums[i], d, spread[i]);
    for (std::size_t lane = 0; lane < std::min(lanes, row.channels - first); ++lane) {
        double* const to = out + (first + lane) * orders * 2;
        for (int i = 0; i < 2 * kOrders; ++i) to[i] = spread[i][lane];
    }
}

template <bool kFirst, class T>
HWY_NOINLINE void add_any_group(const MomentRow<T>& row, std::size_t first, const double* factors,
                                std::size_t group, std::size_t orders, double* out) {
    switch (group) {
        case 1:
            return add_group<1, kFirst>(row, first, factors, orders, out);
        case 2:
            return add_group<2, kFirst>(row, first, factors, orders, out);
        case 3:
            return add_group<3, kFirst>(row, first, factors, orders, out);
        case 4:
            return add_group<4, kFirst>(row, first, factors, orders, out);
        case 5:
            return add_group<5, kFirst>(row, first, factors, orders, out);
        default:
            return add_group<6, kFirst>(row, first, factors, orders, out);
    }
}

template <class T>
void all_moments(const MomentRow<T>& row, const double* table, std::size_t orders, double* out) {
    const std::size_t places = row.folded ? row.columns / 4 : row.columns;
    for (std::size_t first = 0; first < row.channels; first += hn::Lanes(Tag())) {
        for (std::size_t m = 0; m < orders; m += kMomentGroup) {
            const std::size_t group = std::min(kMomentGroup, orders - m);
            const double* factors = table + 2 * m * places;
            if (m == 0) {
                add_any_group<true>(row, first, factors, group, orders, out);
            } else {
                add_any_group<false>(row, first, factors, group, orders, out + 2 * m);
            }
        }
    }
}

void float_moments(const MomentRow<float>& row, const double* table, std::size_t orders,
                   double* out) {
    all_moments(row, table, orders, out);
}

void double_moments(const MomentRow<double>& row, const double* table, std::size_t orders,
                    double* out) {
    all_moments(row, table, orders, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

HWY_EXPORT(float_moments);
HWY_EXPORT(double_moments);

void run(const detail::MomentRow<float>& row, const double* table, std::size_t orders,
         double* out) {
    HWY_DYNAMIC_DISPATCH(float_moments)(row, table, orders, out);
}

void run(const detail::MomentRow<double>& row, const double* table, std::size_t orders,
         double* out) {
    HWY_DYNAMIC_DISPATCH(double_moments)(row, table, orders, out);
}

}  // namespace

RowMoments::RowMoments(std::size_t columns, std::size_t orders)
    : columns_(columns), orders_(orders), folded_(columns % 4 == 0) {
    assert(columns >= 1 && orders >= 1);
    const std::size_t places = folded_ ? columns / 4 : columns;
    table_.reserve(2 * places * orders);
    for (std::size_t m0 = 0; m0 < orders; m0 += detail::kMomentGroup) {
        const std::size_t end = std::min(orders, m0 + detail::kMomentGroup);
        for (std::size_t k = 0; k < places; ++k) {
            for (std::size_t m = m0; m < end; ++m) {
                // Whole turns are taken off in integers.
                const std::size_t part = m * (2 * k + 1) % (2 * columns);
                const double angle = kPi * static_cast<double>(part) / static_cast<double>(columns);
                table_.push_back(std::cos(angle));
                table_.push_back(std::sin(angle));
            }
        }
    }
}

template <class T>
void RowMoments::moments(const T* row, std::size_t channels, std::size_t readable,
                         double* out) const {
    const std::size_t size = columns_ * channels;
    assert(readable >= size);
    if (readable >= size + detail::kMomentLanes) {
        return run(detail::MomentRow<T>{row, columns_, channels, folded_}, table_.data(), orders_,
                   out);
    }
    std::vector<T> copy(row, row + size);
    copy.resize(size + detail::kMomentLanes);
    run(detail::MomentRow<T>{copy.data(), columns_, channels, folded_}, table_.data(), orders_,
        out);
}

void RowMoments::operator()(const float* row, std::size_t channels, std::size_t readable,
                            double* out) const {
    moments(row, channels, readable, out);
}

void RowMoments::operator()(const double* row, std::size_t channels, std::size_t readable,
                            double* out) const {
    moments(row, channels, readable, out);
}

}  // namespace airlight
#endif
