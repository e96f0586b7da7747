// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/psf_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "core/constants.h"
#include "medium/psf.h"
#include "medium/psf_batch.h"
#include "medium/ray_integral-inl.h"
#include "medium/ray_integral.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool kScaled>
struct PsfKernel {
    static constexpr std::size_t kInputs = 2;

    float operator()(const float (&x)[2]) const {
        return kScaled ? psf_scaled(x[0], x[1]) : psf(x[0], x[1]);
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[2], Mask* served) const {
        const Vec t = x[0], gamma = x[1];
        // Within these no product or quotient below leaves the range of float.
        *served = hn::And(within(gamma, 0x1p-30f, static_cast<float>(detail::kPiOfFloat)),
                          within(t, kScaled ? 0.0f : 0x1p-40f, 0x1p40f));
        const Vec c = hn::Min(sin_half(gamma), hn::Set(d, 1.0f));
        const Vec rho = hn::Add(c, c);
        const Vec h = FittedRayIntegral()(hn::Mul(rho, t), c);
        const Vec scaled = hn::Div(hn::Mul(h, hn::Set(d, static_cast<float>(0.5 / kPi))), rho);
        if (kScaled) return scaled;
        // Two equal factors, neither denormal where their product is not.
        const Vec half = hn::Exp(d, hn::Mul(hn::Set(d, -0.5f), t));
        return hn::Mul(hn::Mul(hn::Mul(scaled, t), half), half);
    }
};

HWY_ATTR void run_psf(std::size_t count, const float* t, const float* gamma, float* out) {
    batch(count, {t, gamma}, out, PsfKernel<false>());
}

HWY_ATTR void run_psf_scaled(std::size_t count, const float* t, const float* gamma, float* out) {
    batch(count, {t, gamma}, out, PsfKernel<true>());
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_psf);
HWY_EXPORT(run_psf_scaled);

void psf_batch(std::size_t count, const float* optical_thickness, const float* gamma, float* out) {
    HWY_DYNAMIC_DISPATCH(run_psf)(count, optical_thickness, gamma, out);
}

void psf_scaled_batch(std::size_t count, const float* optical_thickness, const float* gamma,
                      float* out) {
    HWY_DYNAMIC_DISPATCH(run_psf_scaled)(count, optical_thickness, gamma, out);
}

}  // namespace airlight
#endif
