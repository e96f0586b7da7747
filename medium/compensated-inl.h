// SPDX-License-Identifier: Apache-2.0
// Sums and products of float vectors with their rounding errors, compiled once per SIMD target: no
// #pragma once, the guard below turns with the target.
#include "medium/batch-inl.h"

#if defined(AIRLIGHT_MEDIUM_COMPENSATED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_MEDIUM_COMPENSATED_INL_H
#undef AIRLIGHT_MEDIUM_COMPENSATED_INL_H
#else
#define AIRLIGHT_MEDIUM_COMPENSATED_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct TwoVec {
    Vec value;
    Vec error;  // what rounding took from it
};

// Exact unless something over- or underflows.
HWY_INLINE TwoVec two_sum(Vec a, Vec b) {
    const Vec sum = hn::Add(a, b);
    const Vec b_part = hn::Sub(sum, a);
    return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part))};
}

HWY_INLINE TwoVec two_product(Vec a, Vec b) {
    const Vec product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
    return {product, hn::MulSub(a, b, product)};
#else
    // Halves of twelve bits, whose products are exact.
    const Tag d;
    const Vec mask = hn::BitCast(d, hn::Set(hn::RebindToSigned<Tag>(), -4096));
    const Vec a_high = hn::And(a, mask), b_high = hn::And(b, mask);
    const Vec a_low = hn::Sub(a, a_high), b_low = hn::Sub(b, b_high);
    const Vec rest = hn::Add(hn::Sub(hn::Mul(a_high, b_high), product), hn::Mul(a_high, b_low));
    return {product, hn::Add(hn::Add(rest, hn::Mul(a_low, b_high)), hn::Mul(a_low, b_low))};
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_MEDIUM_COMPENSATED_INL_H
