// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/march_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "bench/march_batch.h"
#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/ray_integral-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct MarchKernel {
    static constexpr std::size_t kInputs = 3;
    int steps;

    float operator()(const float (&x)[3]) const { return ::airlight::airlight(x[0], x[1], x[2]); }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[3], Mask* served) const {
        const Vec t_sv = x[1], t_vp = x[2];
        *served = within(t_vp, 1e-6f, 1e6f);
        const Vec sine = sin_half(x[0]);
        const Vec two_kappa = hn::Mul(hn::Mul(hn::Set(d, 4.0f), t_sv), hn::Mul(sine, sine));
        const Vec step = hn::Mul(t_vp, hn::Set(d, 1.0f / static_cast<float>(steps)));
        Vec sum = hn::Zero(d);
        Vec t = hn::Mul(hn::Set(d, 0.5f), step);
        for (int i = 0; i < steps; ++i, t = hn::Add(t, step)) {
            const Vec beyond = hn::Sub(t, t_sv);
            const Vec squared = hn::MulAdd(beyond, beyond, hn::Mul(two_kappa, t));
            const Vec path = hn::Add(beyond, hn::Sqrt(squared));
            sum = hn::Add(sum, hn::Div(hn::Exp(d, hn::Neg(path)), squared));
        }
        const Vec scale = hn::Mul(step, hn::Set(d, static_cast<float>(0.25 / kPi)));
        return hn::Mul(hn::Mul(sum, scale), hn::Exp(d, hn::Neg(t_sv)));
    }
};

HWY_ATTR void run_march(std::size_t count, const float* gamma, const float* t_sv, const float* t_vp,
                        int steps, float* out) {
    batch(count, {gamma, t_sv, t_vp}, out, MarchKernel{steps});
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_march);

void airlight_march_batch(std::size_t count, const float* gamma, const float* t_sv,
                          const float* t_vp, int steps, float* out) {
    HWY_DYNAMIC_DISPATCH(run_march)(count, gamma, t_sv, t_vp, steps, out);
}

}  // namespace airlight
#endif
