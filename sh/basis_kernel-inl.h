// SPDX-License-Identifier: Apache-2.0
// The basis of one vector of directions, compiled once per SIMD target (see Highway's
// foreach_target.h): it has no #pragma once, the guard below turns with the target.
//
// visit_basis<kOrder> runs the recurrence of sh/basis_recurrence.h column by column, m = 0 first,
// and hands every Q_lm to a sink with the powers c, s = Re, Im (x + i y)^m of its column:
//     void take(int l, int m, V q, V c, V s);   // l = m ... kOrder - 1, constants once inlined
//     void end_column(int m, V c, V s);
// A factor that belongs to all of Y, a weight, goes into the powers: the product with it is free.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "sh/aligned.h"
#include "sh/basis_recurrence.h"
#include "sh/index.h"

#if defined(AIRLIGHT_SH_BASIS_KERNEL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_SH_BASIS_KERNEL_INL_H
#undef AIRLIGHT_SH_BASIS_KERNEL_INL_H
#else
#define AIRLIGHT_SH_BASIS_KERNEL_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using detail::Directions;
using detail::kUnrolledOrder;

template <class Real>
using TagOf = hn::ScalableTag<Real>;
template <class Real>
using VecOf = hn::Vec<TagOf<Real>>;
template <class Real>
constexpr std::size_t kMaxLanes = hn::MaxLanes(TagOf<Real>());

// A unit vector per lane; `one` is NaN where the direction is, otherwise 1.
template <class V>
struct Unit {
    V x, y, z, one;
};

// |v|^2 - 1, in which a unit vector cancels first.
template <class V>
HWY_INLINE V excess(V x, V y, V z) {
    const V one = hn::Set(hn::DFromV<V>(), hn::TFromV<V>(1));
    return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::MulSub(z, z, one)));
}

template <class Real>
void rescale(Unit<VecOf<Real>>& unit) {
    const TagOf<Real> d;
    HWY_ALIGN Real lanes[3][kMaxLanes<Real>];
    hn::Store(unit.x, d, lanes[0]);
    hn::Store(unit.y, d, lanes[1]);
    hn::Store(unit.z, d, lanes[2]);
    detail::rescale_directions(hn::Lanes(d), lanes[0], lanes[1], lanes[2]);
    unit.x = hn::Load(d, lanes[0]);
    unit.y = hn::Load(d, lanes[1]);
    unit.z = hn::Load(d, lanes[2]);
}

// Makes the lanes that are not `near` unit to a few eps, or NaN.
template <class Real>
HWY_NOINLINE void normalize(hn::Mask<TagOf<Real>> near, Unit<VecOf<Real>>& unit) {
    const TagOf<Real> d;
    const auto one = hn::Set(d, Real(1));
    const auto squared_length = [](const auto& v) {
        return hn::MulAdd(v.x, v.x, hn::MulAdd(v.y, v.y, hn::Mul(v.z, v.z)));
    };
    auto square = squared_length(unit);
    const auto usual = hn::And(hn::Ge(square, hn::Set(d, detail::kLeastSquare<Real>)),
                               hn::Le(square, hn::Set(d, detail::kLargestSquare<Real>)));
    if (HWY_UNLIKELY(!hn::AllTrue(d, usual))) {
        rescale<Real>(unit);
        square = squared_length(unit);
    }
    const auto scale = hn::IfThenElse(near, one, hn::Div(one, hn::Sqrt(square)));
    unit.x = hn::Mul(unit.x, scale);
    unit.y = hn::Mul(unit.y, scale);
    unit.z = hn::Mul(unit.z, scale);
    unit.one = hn::Div(square, square);
}

template <class Real>
HWY_INLINE Unit<VecOf<Real>> load_unit(const Directions<Real>& in, std::size_t i) {
    using V = VecOf<Real>;
    const TagOf<Real> d;
    Unit<V> unit{hn::LoadU(d, in.x + i), hn::LoadU(d, in.y + i), hn::LoadU(d, in.z + i),
                 hn::Set(d, Real(1))};
    V e = excess(unit.x, unit.y, unit.z);
    const auto near = hn::Le(hn::Abs(e), hn::Set(d, detail::kNearUnit<Real>));
    if (HWY_UNLIKELY(!hn::AllTrue(d, near))) {
        normalize<Real>(near, unit);
        e = excess(unit.x, unit.y, unit.z);
    }
    // 1 / |v| - 1 = -e / 2 + 3 e^2 / 8 - ...
    const V shift = hn::Mul(e, hn::MulSub(e, hn::Set(d, Real(0.375)), hn::Set(d, Real(0.5))));
    unit.x = hn::MulAdd(unit.x, shift, unit.x);
    unit.y = hn::MulAdd(unit.y, shift, unit.y);
    unit.z = hn::MulAdd(unit.z, shift, unit.z);
    return unit;
}

template <int kOrder, int kM, int kL, class D, class V, class Sink>
HWY_INLINE void visit_column(D d, V z, V zz, V before, V q, V c, V s, Sink& sink) {
    using Real = hn::TFromD<D>;
    sink.take(kL, kM, q, c, s);
    if constexpr (kL + 1 < kOrder) {
        constexpr const double* a = detail::kRecurrence.a[kM];
        constexpr double b = detail::kRecurrence.b[kM][kL + 1];
        constexpr double seed = detail::kRecurrence.seed[kM];
        V next;
        if constexpr (kL == kM) {
            next = hn::Mul(hn::Set(d, static_cast<Real>(a[kL + 1] * seed)), z);
        } else if constexpr (kL == kM + 1) {
            next = hn::MulAdd(hn::Set(d, static_cast<Real>(a[kL + 1] * a[kL] * seed)), zz,
                              hn::Set(d, static_cast<Real>(-b * seed)));
        } else {
            next = hn::MulSub(hn::Mul(hn::Set(d, static_cast<Real>(a[kL + 1])), z), q,
                              hn::Mul(hn::Set(d, static_cast<Real>(b)), before));
        }
        visit_column<kOrder, kM, kL + 1>(d, z, zz, q, next, c, s, sink);
    }
}

template <int kOrder, int kM, class D, class V, class Sink>
HWY_INLINE void visit_columns(D d, const Unit<V>& unit, V zz, V c, V s, Sink& sink) {
    const V seed = hn::Set(d, static_cast<hn::TFromD<D>>(detail::kRecurrence.seed[kM]));
    visit_column<kOrder, kM, kM>(d, unit.z, zz, seed, seed, c, s, sink);
    sink.end_column(kM, c, s);
    if constexpr (kM + 1 < kOrder) {
        const V turned = kM == 0 ? hn::Mul(unit.x, c) : hn::MulSub(unit.x, c, hn::Mul(unit.y, s));
        s = kM == 0 ? hn::Mul(unit.y, c) : hn::MulAdd(unit.x, s, hn::Mul(unit.y, c));
        visit_columns<kOrder, kM + 1>(d, unit, zz, turned, s, sink);
    }
}

// `weight` times the basis.
template <int kOrder, class V, class Sink>
HWY_INLINE void visit_basis(const Unit<V>& unit, V weight, Sink& sink) {
    const hn::DFromV<V> d;
    visit_columns<kOrder, 0>(d, unit, hn::Mul(unit.z, unit.z), weight, weight, sink);
}

// The basis of whole vectors, order <= kVectorOrder: defined in sh/basis_batch.cpp alone, since
// unrolled code is slow to compile.
void evaluate_whole(int order, const Directions<float>& in, float* out, std::size_t stride);
void evaluate_whole(int order, const Directions<double>& in, double* out, std::size_t stride);

// The directions from `first` on, filled up with (0, 0, 1).
template <class Real, std::size_t kSize>
struct Tail {
    HWY_ALIGN Real x[kSize] = {};
    HWY_ALIGN Real y[kSize] = {};
    HWY_ALIGN Real z[kSize];

    Tail(const Directions<Real>& in, std::size_t first) {
        std::fill_n(z, kSize, Real(1));
        std::copy(in.x + first, in.x + in.count, x);
        std::copy(in.y + first, in.y + in.count, y);
        std::copy(in.z + first, in.z + in.count, z);
    }
    Directions<Real> directions(std::size_t count) const { return {count, x, y, z}; }
};

// Sums over one channel of a small order take the basis straight from the recurrence. For several
// channels, and for larger orders, this many vectors of directions have their basis in the
// first-level cache, where every channel passes over it.
constexpr std::size_t kBlock = 4;

template <class Real>
constexpr std::size_t block_size() {
    return kBlock * hn::Lanes(TagOf<Real>());
}

// basis(first) is that of the block of directions that begins there, (slots, block_size).
template <class Real>
class Block {
  public:
    Block(int order, const Directions<Real>& in) : order_(order), in_(in) {
        basis_.resize(sh_count(order) * block_size<Real>());
    }

    const Real* basis(std::size_t first) {
        const std::size_t size = block_size<Real>();
        if (first + size <= in_.count) {
            evaluate_whole(order_, in_.from(first, size), basis_.data(), size);
        } else {
            const Tail<Real, kBlock * kMaxLanes<Real>> tail(in_, first);
            evaluate_whole(order_, tail.directions(size), basis_.data(), size);
        }
        return basis_.data();
    }

  private:
    int order_;
    Directions<Real> in_;
    AlignedVector<Real> basis_;
};

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_SH_BASIS_KERNEL_INL_H
