// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/height_density_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "medium/compensated-inl.h"
#include "medium/height_density.h"
#include "medium/height_density_batch.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// (1 - e^-y) / y for y >= 0; y may be infinite.
HWY_INLINE Vec mean_decay(Vec y) {
    // To y^7 for y <= 1/2: 2e-7.
    constexpr float kPowers[] = {1,          -1 / 2.0f,   1 / 6.0f,   -1 / 24.0f,
                                 1 / 120.0f, -1 / 720.0f, 1 / 5040.0f};
    const Tag d;
    const Vec lost = hn::Sub(hn::Set(d, 1.0f), hn::Exp(d, hn::Neg(y)));
    return hn::IfThenElse(hn::Lt(y, hn::Set(d, 0.5f)), polynomial<7>(kPowers, y), hn::Div(lost, y));
}

struct ExponentialHeightKernel {
    static constexpr std::size_t kInputs = 4;

    float operator()(const float (&x)[4]) const {
        return exponential_height_depth(x[0], x[1], x[2], x[3]);
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[4], Mask* served) const {
        const Vec height = x[0], up = x[1], falloff = x[3];
        const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const Vec dist = hn::Min(x[2], hn::Set(d, 0x1p60f));
        const TwoVec climb = two_product(up, dist);
        const Vec y = hn::Mul(falloff, climb.value);
        // The exponent at the densest end, with the digits that cancel in it.
        const auto thins = hn::Ge(y, zero);
        const TwoVec sum = two_sum(height, hn::IfThenZeroElse(thins, climb.value));
        const TwoVec end =
            two_sum(sum.value, hn::Add(sum.error, hn::IfThenZeroElse(thins, climb.error)));
        const TwoVec exponent = two_product(falloff, end.value);
        const Vec rest = hn::MulAdd(falloff, end.error, exponent.error);
        // Within these no product or quotient leaves the range of float, nor the two parts of the
        // exponent a tolerable error; past y = 100 the end of a longer ray cannot be seen.
        *served = hn::And(
            hn::And(
                hn::And(within(height, -0x1p60f, 0x1p60f), within(up, -1.0f, 1.0f)),
                hn::And(within(falloff, -0x1p30f, 0x1p30f), hn::Ge(x[2], hn::Set(d, 0x1p-60f)))),
            hn::And(hn::And(hn::Or(hn::Le(x[2], dist), hn::Ge(y, hn::Set(d, 100.0f))),
                            hn::Ge(y, hn::Set(d, -0x1p24f))),
                    hn::Ge(exponent.value, hn::Set(d, -150.0f))));
        const Vec correction =
            hn::Sub(one, hn::IfThenElseZero(hn::Lt(exponent.value, hn::Set(d, 1000.0f)), rest));
        // Two equal factors, neither denormal where their product is not.
        const Vec root = hn::Exp(d, hn::Mul(hn::Set(d, -0.5f), exponent.value));
        const Vec column = hn::Mul(dist, mean_decay(hn::Abs(y)));
        return hn::Mul(hn::Mul(hn::Mul(column, root), correction), root);
    }
};

HWY_ATTR void run_exponential_height(std::size_t count, const float* height, const float* up,
                                     const float* distance, const float* falloff, float* out) {
    batch(count, {height, up, distance, falloff}, out, ExponentialHeightKernel());
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_exponential_height);

void exponential_height_depth_batch(std::size_t count, const float* height, const float* up,
                                    const float* distance, const float* falloff, float* out) {
    HWY_DYNAMIC_DISPATCH(run_exponential_height)(count, height, up, distance, falloff, out);
}

}  // namespace airlight
#endif
