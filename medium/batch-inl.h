// SPDX-License-Identifier: Apache-2.0
// The loop of every batch call, compiled once per SIMD target (see Highway's foreach_target.h): it
// has no #pragma once, the guard below turns with the target.
//
// A Kernel holds
//     static constexpr std::size_t kInputs;
//     Vec operator()(Tag d, const Vec (&x)[kInputs], Mask* served) const;
//     float operator()(const float (&x)[kInputs]) const;
// The first computes one vector and tells which lanes it serves; the second, scalar, does the
// others. A lane never sees its neighbours, so a result depends on its own inputs alone.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#if defined(AIRLIGHT_MEDIUM_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_MEDIUM_BATCH_INL_H
#undef AIRLIGHT_MEDIUM_BATCH_INL_H
#else
#define AIRLIGHT_MEDIUM_BATCH_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

constexpr std::size_t kMaxLanes = hn::MaxLanes(Tag());

template <class Kernel>
HWY_NOINLINE Vec repaired(const Kernel& kernel, const Vec (&x)[Kernel::kInputs], Vec value,
                          Mask served) {
    const Tag d;
    HWY_ALIGN float inputs[Kernel::kInputs][kMaxLanes];
    HWY_ALIGN float values[kMaxLanes], flags[kMaxLanes];
    for (std::size_t k = 0; k < Kernel::kInputs; ++k) hn::Store(x[k], d, inputs[k]);
    hn::Store(value, d, values);
    hn::Store(hn::IfThenElseZero(served, hn::Set(d, 1.0f)), d, flags);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        if (flags[lane] != 0) continue;
        float one[Kernel::kInputs];
        for (std::size_t k = 0; k < Kernel::kInputs; ++k) one[k] = inputs[k][lane];
        values[lane] = kernel(one);
    }
    return hn::Load(d, values);
}

template <class Kernel>
HWY_INLINE Vec batch_vector(const Kernel& kernel, const Vec (&x)[Kernel::kInputs]) {
    const Tag d;
    Mask served;
    const Vec value = kernel(d, x, &served);
    return HWY_LIKELY(hn::AllTrue(d, served)) ? value : repaired(kernel, x, value, served);
}

template <class Kernel>
void batch(std::size_t count, const float* const (&inputs)[Kernel::kInputs], float* out,
           const Kernel& kernel) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    Vec x[Kernel::kInputs];
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        for (std::size_t k = 0; k < Kernel::kInputs; ++k) x[k] = hn::LoadU(d, inputs[k] + i);
        hn::StoreU(batch_vector(kernel, x), d, out + i);
    }
    if (i == count) return;
    const std::size_t rest = count - i;
    HWY_ALIGN float buffer[kMaxLanes];
    for (std::size_t k = 0; k < Kernel::kInputs; ++k) {
        // Lanes past the end repeat the last input.
        std::copy_n(inputs[k] + i, rest, buffer);
        std::fill(buffer + rest, buffer + lanes, buffer[rest - 1]);
        x[k] = hn::Load(d, buffer);
    }
    hn::Store(batch_vector(kernel, x), d, buffer);
    std::copy_n(buffer, rest, out + i);
}

HWY_INLINE Mask within(Vec value, float lo, float hi) {
    const Tag d;
    return hn::And(hn::Ge(value, hn::Set(d, lo)), hn::Le(value, hn::Set(d, hi)));
}

// c[0] + c[1] x + ... + c[kLength - 1] x^(kLength - 1)
template <int kLength>
HWY_INLINE Vec polynomial(const float* c, Vec x) {
    const Tag d;
    Vec sum = hn::Set(d, c[kLength - 1]);
    for (int i = kLength - 2; i >= 0; --i) sum = hn::MulAdd(sum, x, hn::Set(d, c[i]));
    return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_MEDIUM_BATCH_INL_H
