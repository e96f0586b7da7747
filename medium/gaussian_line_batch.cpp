// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/gaussian_line_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "medium/compensated-inl.h"
#include "medium/gaussian_density.h"
#include "medium/gaussian_line_batch.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// e^{x^2} erfc(x) for x >= 0, relative error 4e-7.
HWY_INLINE Vec scaled_erfc_vector(Vec x) {
    // (1 + 2 x) erfcx(x) in powers of (x - 2.5) / (x + 2.5), minimax, 1.3e-7.
    constexpr float kPowers[] = {
        1.264838072e+00f, -1.223579168e-01f, -9.901851882e-02f, 1.576503510e-01f, -1.030179460e-01f,
        3.265571303e-02f, 1.082612498e-03f,  -4.151079862e-03f, 3.054976348e-04f, 3.925243570e-04f};
    const Tag d;
    const Vec k = hn::Set(d, 2.5f);
    const Vec t = hn::Div(hn::Sub(x, k), hn::Add(x, k));
    return hn::Div(polynomial<10>(kPowers, t), hn::MulAdd(hn::Set(d, 2.0f), x, hn::Set(d, 1.0f)));
}

// int_{-1/2}^{1/2} e^{-delta s - (w s)^2} ds for w, delta in [0, 1], by four Gauss-Legendre points.
HWY_INLINE Vec short_mean(Vec w, Vec delta) {
    constexpr float kNodes[] = {0.339981044f / 2, 0.861136312f / 2},
                    kWeights[] = {0.652145155f, 0.347854845f};
    constexpr float kExponential[] = {1, -1, 1 / 2.0f, -1 / 6.0f, 1 / 24.0f, -1 / 120.0f};
    constexpr float kCosh[] = {1, 1 / 2.0f, 1 / 24.0f, 1 / 720.0f};
    const Tag d;
    Vec sum = hn::Zero(d);
    for (int i = 0; i < 2; ++i) {
        const Vec z = hn::Mul(delta, hn::Set(d, kNodes[i])), s = hn::Mul(w, hn::Set(d, kNodes[i]));
        const Vec pair = hn::Mul(polynomial<4>(kCosh, hn::Mul(z, z)),
                                 polynomial<6>(kExponential, hn::Mul(s, s)));
        sum = hn::MulAdd(pair, hn::Set(d, kWeights[i]), sum);
    }
    return sum;
}

struct GaussianLineKernel {
    static constexpr std::size_t kInputs = 5;

    float operator()(const float (&x)[5]) const {
        return gaussian_line(x[0], x[1], x[2], x[3], x[4]);
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[5], Mask* served) const {
        const Vec a = x[0], c = x[1], rho = x[2], m = x[3];
        const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
        // Within these no product or quotient below leaves the range of float.
        *served = hn::And(hn::And(within(a, 0x1p-30f, 0x1p30f), within(c, 0x1p-60f, 0x1p60f)),
                          hn::And(hn::And(within(rho, 0.0f, 0x1p30f), within(m, -0x1p30f, 0x1p30f)),
                                  hn::Ge(x[4], hn::Set(d, 0x1p-30f))));
        const Vec per_a = hn::Div(one, a);
        // Beyond this distance nothing is left.
        const Vec dist =
            hn::Min(x[4], hn::MulAdd(hn::Set(d, 16.0f), per_a, hn::Abs(hn::Add(m, m))));

        // Lengths in units of 1 / a, from the point of the line next to the center.
        const TwoVec end = two_sum(dist, hn::Neg(m));
        const Vec w = hn::Mul(a, dist);
        const Vec from = hn::Abs(hn::Mul(a, m)), to = hn::Abs(hn::Mul(a, end.value));
        const Vec near = hn::Min(from, to), far = hn::Max(from, to);
        // The middle of the segment, twice.
        const TwoVec middle = two_sum(hn::Mul(half, dist), hn::Neg(m));
        const Vec delta = hn::Mul(hn::Mul(hn::Add(w, w), a), hn::Abs(middle.value));
        const auto peak_inside = hn::And(hn::Ge(m, zero), hn::Ge(end.value, zero));
        const auto is_short = hn::And(hn::Lt(w, one), hn::Lt(delta, one));

        // The exponent a^2 (rho^2 + t^2) at the densest place, with the digits that exp needs.
        const auto starts_near = hn::Lt(from, to);
        const Vec at_end = hn::IfThenElse(starts_near, m, end.value);
        const Vec at_end_error = hn::IfThenZeroElse(starts_near, end.error);
        const Vec t =
            hn::IfThenElse(is_short, middle.value, hn::IfThenZeroElse(peak_inside, at_end));
        const Vec t_error =
            hn::IfThenElse(is_short, middle.error, hn::IfThenZeroElse(peak_inside, at_end_error));
        const TwoVec across = two_product(a, rho), along = two_product(a, t);
        const Vec along_error = hn::MulAdd(a, t_error, along.error);
        const TwoVec across_squared = two_product(across.value, across.value);
        const TwoVec along_squared = two_product(along.value, along.value);
        const TwoVec exponent = two_sum(across_squared.value, along_squared.value);
        const Vec cross_terms =
            hn::MulAdd(across.value, across.error, hn::Mul(along.value, along_error));
        const Vec rest =
            hn::Add(hn::Add(exponent.error, hn::Add(across_squared.error, along_squared.error)),
                    hn::Add(cross_terms, cross_terms));
        const Vec correction =
            hn::Sub(one, hn::IfThenElseZero(hn::Lt(exponent.value, hn::Set(d, 1000.0f)), rest));
        // Two equal factors, neither denormal where their product is not.
        const Vec root = hn::Exp(d, hn::Mul(hn::Set(d, -0.5f), exponent.value));

        const Vec at_near = scaled_erfc_vector(near);
        const Vec at_far = hn::Mul(hn::Exp(d, hn::Neg(delta)), scaled_erfc_vector(far));
        const Vec both = hn::NegMulAdd(hn::Exp(d, hn::Neg(hn::Mul(near, near))),
                                       hn::Add(at_near, at_far), hn::Set(d, 2.0f));
        const Vec sum = hn::IfThenElse(peak_inside, both, hn::Sub(at_near, at_far));
        const Vec length = hn::IfThenElse(is_short, hn::Mul(dist, short_mean(w, delta)),
                                          hn::Mul(hn::Mul(hn::Set(d, 0.886226925f), per_a), sum));
        return hn::Mul(hn::Mul(hn::Mul(hn::Mul(c, length), root), correction), root);
    }
};

HWY_ATTR void run_gaussian_line(std::size_t count, const float* a, const float* c,
                                const float* rho_perp, const float* m_proj, const float* dist,
                                float* out) {
    batch(count, {a, c, rho_perp, m_proj, dist}, out, GaussianLineKernel());
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_gaussian_line);

void gaussian_line_batch(std::size_t count, const float* a, const float* c, const float* rho_perp,
                         const float* m_proj, const float* dist, float* out) {
    HWY_DYNAMIC_DISPATCH(run_gaussian_line)(count, a, c, rho_perp, m_proj, dist, out);
}

}  // namespace airlight
#endif
