// SPDX-License-Identifier: Apache-2.0
// H(y, theta, inf) of medium/ray_integral.h in float vectors, compiled once per SIMD target: no
// #pragma once, the guard below turns with the target.
#include "medium/batch-inl.h"
#include "medium/ray_integral_fit.h"

#if defined(AIRLIGHT_MEDIUM_RAY_INTEGRAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_MEDIUM_RAY_INTEGRAL_INL_H
#undef AIRLIGHT_MEDIUM_RAY_INTEGRAL_INL_H
#else
#define AIRLIGHT_MEDIUM_RAY_INTEGRAL_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// sin(gamma / 2), gamma in [0, pi]: relative error 1e-7.
HWY_INLINE Vec sin_half(Vec gamma) {
    // Minimax in relative error, 5e-9.
    constexpr float kSine[] = {-1.666666046e-01f, 8.333088165e-03f, -1.981111252e-04f,
                               2.608932034e-06f};
    const Tag d;
    const Vec h = hn::Mul(gamma, hn::Set(d, 0.5f));
    const Vec squared = hn::Mul(h, h);
    return hn::MulAdd(hn::Mul(h, squared), polynomial<4>(kSine, squared), h);
}

// ln(x) for a positive normal x, absolute error 1e-7 (1 + |ln x|).
HWY_INLINE Vec logarithm(Vec x) {
    // ln(1 + t) = t - t^2 / 2 + t^3 p(t) for 1 + t in [sqrt(1/2), sqrt(2)], minimax, 7e-9.
    constexpr float kLogarithm[] = {3.333416598e-01f,  -2.500169882e-01f, 1.995487315e-01f,
                                    -1.656442344e-01f, 1.497801884e-01f,  -1.437902820e-01f,
                                    8.672134339e-02f};
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const auto bits = hn::BitCast(di, x);
    const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3F3504F3)));
    const Vec t =
        hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent))), hn::Set(d, 1.0f));
    const Vec squared = hn::Mul(t, t);
    const Vec tail = hn::MulAdd(hn::Mul(t, squared), polynomial<7>(kLogarithm, t),
                                hn::MulAdd(hn::Set(d, -0.5f), squared, t));
    return hn::MulAdd(hn::ConvertTo(d, exponent), hn::Set(d, 0.693147180559945f), tail);
}

template <class Fit, int kRow = 0>
HWY_INLINE Vec fit(Vec u, Vec v) {
    const Vec row = polynomial<Fit::kLengths[kRow]>(Fit::kPowers[kRow], u);
    if constexpr (kRow + 1 == Fit::kRows) {
        return row;
    } else {
        return hn::MulAdd(fit<Fit, kRow + 1>(u, v), v, row);
    }
}

// The fit: relative error 4e-6, rounding included, for y in [0, 1e30], c = cos(theta) in [0, 1].
struct FittedRayIntegral {
    HWY_INLINE Vec operator()(Vec y, Vec c) const {
        const Tag d;
        const Vec one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
        const Vec r = hn::Div(one, hn::Add(y, two));
        // y = 0 has the limit of s ln(s), which this is as good as.
        const Vec s = hn::Max(hn::Mul(y, r), hn::Set(d, 1e-30f));
        const Vec u = hn::MulSub(two, s, one), v = hn::MulSub(two, c, one);
        const Vec numerator =
            hn::NegMulAdd(hn::Mul(s, logarithm(s)), fit<detail::FitLogarithmic>(u, v),
                          fit<detail::FitSmooth>(u, v));
        return hn::Div(hn::Mul(r, numerator), fit<detail::FitDenominator>(u, v));
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#endif  // AIRLIGHT_MEDIUM_RAY_INTEGRAL_INL_H
