// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/basis_batch.cpp"
#include "sh/basis_batch.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <vector>

#include "sh/aligned.h"
#include "sh/basis.h"
#include "sh/basis_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {

template <class Real>
struct StoreSink {
    Real* out;
    std::size_t stride;

    HWY_INLINE void take(int l, int m, VecOf<Real> q, VecOf<Real> c, VecOf<Real> s) {
        const TagOf<Real> d;
        // From l = 1 on, q knows of z which lanes are NaN.
        const VecOf<Real> first = m == 0 && l > 0 ? q : hn::Mul(q, c);
        hn::StoreU(first, d, out + sh_index(l, m) * stride);
        if (m > 0) hn::StoreU(hn::Mul(q, s), d, out + sh_index(l, -m) * stride);
    }
    HWY_INLINE void end_column(int, VecOf<Real>, VecOf<Real>) {}
};

// in.count is a multiple of the lanes.
template <int kOrder, class Real>
HWY_NOINLINE void evaluate_unrolled(const Directions<Real>& in, Real* out, std::size_t stride) {
    for (std::size_t i = 0; i < in.count; i += hn::Lanes(TagOf<Real>())) {
        const auto unit = load_unit(in, i);
        StoreSink<Real> sink{out + i, stride};
        visit_basis<kOrder>(unit, unit.one, sink);
    }
}

// What one vector of directions carries along a column.
template <class Real>
struct Column {
    using V = VecOf<Real>;
    Unit<V> unit;
    hn::Mask<TagOf<Real>> polar;
    V delta, sign;  // 1 - |z|, and the sign bit of z where polar
    V c, s, q, before, difference;

    HWY_INLINE Column(const Directions<Real>& in, std::size_t i) : unit(load_unit(in, i)) {
        const TagOf<Real> d;
        const V size = hn::Abs(unit.z), one = hn::Set(d, Real(1));
        polar = hn::Ge(size, hn::Set(d, Real(0.5)));
        const V square = hn::MulAdd(unit.x, unit.x, hn::Mul(unit.y, unit.y));
        delta = hn::Div(square, hn::Add(one, size));
        sign = hn::IfThenElseZero(polar, hn::Xor(size, unit.z));
        c = unit.one;
        s = hn::Zero(d);
    }
    HWY_INLINE void begin(Real seed) {
        const TagOf<Real> d;
        q = hn::Set(d, seed);
        before = hn::Zero(d);
        difference = hn::Zero(d);
    }
    // Below the equator Q_lm(z) = (-1)^(l-m) Q_lm(-z): both q and difference change sign.
    HWY_INLINE void climb(const detail::Step<Real>& step) {
        const TagOf<Real> d;
        const V value =
            hn::MulSub(hn::Mul(hn::Set(d, step.a), unit.z), q, hn::Mul(hn::Set(d, step.b), before));
        difference = hn::NegMulAdd(hn::Mul(hn::Set(d, step.bend), delta), q,
                                   hn::Mul(hn::Set(d, step.keep), difference));
        const V other = hn::MulAdd(hn::Set(d, step.grow), q, difference);
        before = q;
        q = hn::IfThenElse(polar, hn::Xor(other, sign), value);
        difference = hn::Xor(difference, sign);
    }
    HWY_INLINE void turn() {
        const V turned = hn::MulSub(unit.x, c, hn::Mul(unit.y, s));
        s = hn::MulAdd(unit.x, s, hn::Mul(unit.y, c));
        c = turned;
    }
};

template <class Real, class... Columns>
HWY_INLINE void loop_columns(int order, Real* out, std::size_t stride, Columns&... columns) {
    const TagOf<Real> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto& table = detail::loop_table<Real>();
    for (int m = 0; m < order; ++m) {
        (columns.begin(table.seed[m]), ...);
        Real* cosines = out + sh_index(m, m) * stride;
        Real* sines = out + sh_index(m, -m) * stride;
        for (int l = m;;) {
            // m = 0 is written last, so that its sine half does not stay.
            std::size_t lane = 0;
            ((hn::StoreU(hn::Mul(columns.q, columns.s), d, sines + lane),
              hn::StoreU(hn::Mul(columns.q, columns.c), d, cosines + lane), lane += lanes),
             ...);
            if (++l == order) break;
            cosines += 2 * static_cast<std::size_t>(l) * stride;
            sines += 2 * static_cast<std::size_t>(l) * stride;
            (columns.climb(table.steps[m][l]), ...);
        }
        (columns.turn(), ...);
    }
}

template <class Real>
HWY_NOINLINE void evaluate_looped(int order, const Directions<Real>& in, Real* out,
                                  std::size_t stride) {
    const std::size_t lanes = hn::Lanes(TagOf<Real>());
    std::size_t i = 0;
    // Two vectors at once hide the latency of the recurrence.
    for (; i + 2 * lanes <= in.count; i += 2 * lanes) {
        Column<Real> first(in, i), second(in, i + lanes);
        loop_columns(order, out + i, stride, first, second);
    }
    if (i < in.count) {
        Column<Real> last(in, i);
        loop_columns(order, out + i, stride, last);
    }
}

// The order as a constant: descends from the largest to the one asked for.
template <int kOrder = kUnrolledOrder, class Real>
void evaluate_order(int order, const Directions<Real>& in, Real* out, std::size_t stride) {
    if (order > kOrder) return evaluate_looped(order, in, out, stride);
    if (order == kOrder) return evaluate_unrolled<kOrder>(in, out, stride);
    if constexpr (kOrder > 1) evaluate_order<kOrder - 1>(order, in, out, stride);
}

void evaluate_whole(int order, const Directions<float>& in, float* out, std::size_t stride) {
    evaluate_order(order, in, out, stride);
}
void evaluate_whole(int order, const Directions<double>& in, double* out, std::size_t stride) {
    evaluate_order(order, in, out, stride);
}

template <class Real>
void evaluate(int order, const Directions<Real>& in, Real* out, std::size_t stride) {
    const std::size_t lanes = hn::Lanes(TagOf<Real>());
    const std::size_t rest = in.count % lanes;
    evaluate_whole(order, in.from(0, in.count - rest), out, stride);
    if (rest == 0) return;
    if (in.count > lanes) {
        // Once more the directions before the rest, to the same bits.
        const std::size_t first = in.count - lanes;
        return evaluate_whole(order, in.from(first, lanes), out + first, stride);
    }
    const Tail<Real, kMaxLanes<Real>> tail(in, 0);
    AlignedVector<Real> values(sh_count(order) * lanes);
    evaluate_whole(order, tail.directions(lanes), values.data(), lanes);
    for (std::size_t slot = 0; slot < sh_count(order); ++slot) {
        std::copy_n(values.data() + slot * lanes, rest, out + slot * stride);
    }
}

void evaluate_float(int order, const Directions<float>& in, float* out, std::size_t stride) {
    evaluate(order, in, out, stride);
}
void evaluate_double(int order, const Directions<double>& in, double* out, std::size_t stride) {
    evaluate(order, in, out, stride);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

template <class Real>
void evaluate_one_by_one(int order, const detail::Directions<Real>& in, Real* out,
                         std::size_t stride) {
    std::vector<Real> basis(sh_count(order));
    for (std::size_t i = 0; i < in.count; ++i) {
        evaluate_basis(order, in.x[i], in.y[i], in.z[i], basis.data());
        for (std::size_t slot = 0; slot < basis.size(); ++slot) {
            out[slot * stride + i] = basis[slot];
        }
    }
}

}  // namespace

HWY_EXPORT(evaluate_float);
HWY_EXPORT(evaluate_double);

void evaluate_basis_batch(int order, std::size_t count, const float* x, const float* y,
                          const float* z, float* out, std::size_t stride) {
    assert(order >= 0 && stride >= count);
    if (order > detail::kVectorOrder) {
        return evaluate_one_by_one<float>(order, {count, x, y, z}, out, stride);
    }
    HWY_DYNAMIC_DISPATCH(evaluate_float)(order, {count, x, y, z}, out, stride);
}

void evaluate_basis_batch(int order, std::size_t count, const double* x, const double* y,
                          const double* z, double* out, std::size_t stride) {
    assert(order >= 0 && stride >= count);
    if (order > detail::kVectorOrder) {
        return evaluate_one_by_one<double>(order, {count, x, y, z}, out, stride);
    }
    HWY_DYNAMIC_DISPATCH(evaluate_double)(order, {count, x, y, z}, out, stride);
}

}  // namespace airlight
#endif
