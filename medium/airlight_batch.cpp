// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/airlight_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <cassert>
#include <cmath>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/airlight_batch.h"
#include "medium/ray_integral-inl.h"
#include "medium/ray_integral.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Within these no product or quotient below leaves the range of float; the scalar function has the
// rest: corners, what is outside the domain, and sizes that no picture holds.
constexpr float kLeastGamma = 0x1p-30f, kLeastThickness = 0x1p-40f, kLargestThickness = 0x1p40f;

// Segments with X (1 + 1.5 y) up to this take the four-point rule, 5e-6; from there on the
// difference of two infinite rays keeps a quarter of the first.
constexpr float kShort = 0.85f;

// Linear interpolation in both of H (y + 2) over sqrt(y / (y + 2)) and cos(theta).
struct TabulatedRayIntegral {
    const float* values;  // (cos(theta), sqrt(y / (y + 2)))
    int size;

    HWY_INLINE Vec operator()(Vec y, Vec c) const {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vec r = hn::Div(hn::Set(d, 1.0f), hn::Add(y, hn::Set(d, 2.0f)));
        const Vec last = hn::Set(d, static_cast<float>(size - 1));
        // Lanes that are not served may hold anything.
        const auto first = hn::Zero(di), low = hn::Set(di, size - 2);
        const Vec u = hn::Mul(hn::Sqrt(hn::Mul(y, r)), last), v = hn::Mul(c, last);
        const auto column = hn::Max(first, hn::Min(hn::ConvertTo(di, u), low));
        const auto line = hn::Max(first, hn::Min(hn::ConvertTo(di, v), low));
        const Vec fu = hn::Sub(u, hn::ConvertTo(d, column)),
                  fv = hn::Sub(v, hn::ConvertTo(d, line));
        const auto at = hn::Add(hn::Mul(line, hn::Set(di, size)), column);
        const Vec a = hn::GatherIndex(d, values, at), b = hn::GatherIndex(d, values + 1, at);
        const Vec e = hn::GatherIndex(d, values + size, at);
        const Vec f = hn::GatherIndex(d, values + size + 1, at);
        const Vec near = hn::MulAdd(fu, hn::Sub(b, a), a), far = hn::MulAdd(fu, hn::Sub(f, e), e);
        return hn::Mul(r, hn::MulAdd(fv, hn::Sub(far, near), near));
    }
};

// H(y, theta, X) for X (1 + 1.5 y) <= kShort by the four-point Gauss-Legendre rule.
HWY_INLINE Vec short_ray_integral(Vec y, Vec c, Vec x_end) {
    constexpr float kNodes[] = {0.339981044f, 0.861136312f},
                    kWeights[] = {0.652145155f, 0.347854845f};
    // e^-z to z^6, for z up to .29.
    constexpr float kExponential[] = {1, -1, 1 / 2.0f, -1 / 6.0f, 1 / 24.0f, -1 / 120.0f};
    const Tag d;
    const Vec one = hn::Set(d, 1.0f), two_c = hn::Add(c, c);
    const Vec half = hn::Mul(hn::Set(d, 0.5f), x_end);
    const Vec exponent = hn::Mul(y, half);
    Vec numerators[2], denominators[2];
    for (int i = 0; i < 2; ++i) {
        const Vec offset = hn::Mul(half, hn::Set(d, kNodes[i]));
        const Vec z = hn::Mul(y, offset), squared = hn::Mul(z, z);
        const Vec sinh = hn::Mul(
            z, hn::MulAdd(squared,
                          hn::MulAdd(squared, hn::Set(d, 1 / 120.0f), hn::Set(d, 1 / 6.0f)), one));
        const Vec cosh =
            hn::MulAdd(squared, hn::MulAdd(squared, hn::Set(d, 1 / 24.0f), hn::Set(d, 0.5f)), one);
        const Vec far = hn::Add(half, offset), near = hn::Sub(half, offset);
        const Vec d_far = hn::MulAdd(far, hn::Add(far, two_c), one);
        const Vec d_near = hn::MulAdd(near, hn::Add(near, two_c), one);
        numerators[i] =
            hn::Mul(hn::Set(d, kWeights[i]),
                    hn::MulAdd(hn::Sub(cosh, sinh), d_near, hn::Mul(hn::Add(cosh, sinh), d_far)));
        denominators[i] = hn::Mul(d_far, d_near);
    }
    const Vec sum =
        hn::MulAdd(numerators[0], denominators[1], hn::Mul(numerators[1], denominators[0]));
    return hn::Div(hn::Mul(hn::Mul(sum, half), polynomial<6>(kExponential, exponent)),
                   hn::Mul(denominators[0], denominators[1]));
}

// The triangle of medium/ray_triangle.h, lengths over that from viewer to source.
struct LaneTriangle {
    Vec c;          // sin(gamma / 2), up to 1
    Vec end;        // length of the ray
    Vec projected;  // of the ray beyond its point nearest to the source
    Vec distance;   // from the source to the end of the ray
};

// A ray no longer than what can be seen of an endless one.
HWY_INLINE Vec seen_length(Vec length, Vec away) {
    return hn::Min(length, hn::Mul(away, hn::Set(Tag(), 1e15f)));
}

// e^-before airlight.
template <class RayIntegral>
HWY_INLINE Vec airlight_of(const RayIntegral& infinite, const LaneTriangle& triangle, Vec t_sv,
                           Vec before) {
    const Tag d;
    const Vec one = hn::Set(d, 1.0f), c = triangle.c, end = triangle.end;
    const Vec distance = triangle.distance, projected = triangle.projected;
    const Vec rho = hn::Add(c, c);
    const Vec y = hn::Mul(rho, t_sv);
    const Vec perimeter = hn::Add(hn::Add(end, distance), one);
    const auto ends_near = hn::Lt(projected, hn::Zero(d));
    // For a ray that ends near, gamma < pi / 2 and the square of cos(gamma / 2) is over half.
    const Vec top = hn::IfThenElse(ends_near, hn::Mul(rho, hn::NegMulAdd(c, c, one)),
                                   hn::Add(distance, projected));
    const Vec bottom = hn::IfThenElse(ends_near, hn::Sub(distance, projected), rho);
    const Vec x_end = hn::Min(hn::Div(hn::Mul(hn::Add(end, end), top), hn::Mul(bottom, perimeter)),
                              hn::Set(d, 1e18f));
    const Vec path = hn::Mul(y, x_end);
    const Vec along = hn::Add(x_end, c);
    const Vec from_end = hn::Sqrt(hn::MulAdd(x_end, hn::Add(along, c), one));
    const Vec whole = infinite(y, c);
    const Vec tail =
        hn::Mul(hn::Div(hn::Exp(d, hn::Neg(path)), from_end),
                infinite(hn::Mul(y, from_end), hn::Min(hn::Div(along, from_end), one)));
    const auto is_short = hn::Le(hn::MulAdd(hn::Set(d, 1.5f), path, x_end), hn::Set(d, kShort));
    const Vec h = hn::IfThenElse(is_short, short_ray_integral(y, c, x_end), hn::Sub(whole, tail));
    // Two equal factors, neither denormal where their product is not.
    const Vec transmittance = hn::Exp(d, hn::Mul(hn::Set(d, -0.5f), hn::Add(t_sv, before)));
    return hn::Mul(
        hn::Mul(hn::Div(h, y), hn::Mul(transmittance, hn::Set(d, static_cast<float>(0.5 / kPi)))),
        transmittance);
}

HWY_INLINE Mask serves_lengths(Vec t_sv, Vec t_vp) {
    return hn::And(within(t_sv, kLeastThickness, kLargestThickness),
                   hn::Ge(t_vp, hn::Set(Tag(), kLeastThickness)));
}

template <class RayIntegral>
struct AirlightKernel {
    static constexpr std::size_t kInputs = 3;
    RayIntegral infinite;

    float operator()(const float (&x)[3]) const { return ::airlight::airlight(x[0], x[1], x[2]); }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[3], Mask* served) const {
        const Vec gamma = x[0], t_sv = x[1], t_vp = x[2];
        *served = hn::And(within(gamma, kLeastGamma, static_cast<float>(detail::kPiOfFloat)),
                          serves_lengths(t_sv, t_vp));
        const Vec one = hn::Set(d, 1.0f), per_sv = hn::Div(one, t_sv);
        const Vec c = hn::Min(sin_half(gamma), one), rho = hn::Add(c, c);
        const Vec rho_squared = hn::Mul(rho, rho);
        const Vec length = seen_length(t_vp, t_sv);
        const Vec end = hn::Mul(length, per_sv);
        const Vec beyond = hn::Mul(hn::Sub(length, t_sv), per_sv);
        const Vec distance = hn::Sqrt(hn::MulAdd(beyond, beyond, hn::Mul(rho_squared, end)));
        const Vec projected = hn::MulAdd(hn::Set(d, 0.5f), rho_squared, beyond);
        return airlight_of(infinite, {c, end, projected, distance}, t_sv, hn::Zero(d));
    }
};

struct AirlightPartKernel {
    static constexpr std::size_t kInputs = 4;
    float extinction;

    float operator()(const float (&x)[4]) const {
        const double sigma = extinction, foot = x[0], height = x[1], begin = x[2], length = x[3];
        return static_cast<float>(std::exp(-sigma * begin) *
                                  ::airlight::airlight(std::atan2(height, foot),
                                                       sigma * std::hypot(height, foot),
                                                       sigma * length));
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[4], Mask* served) const {
        const Vec foot = x[0], height = x[1], sigma = hn::Set(d, extinction);
        const Vec squared = hn::Mul(height, height);
        const Vec away = hn::Sqrt(hn::MulAdd(foot, foot, squared));
        // 2 away^2 sin(gamma / 2)^2 is away (away - foot), and that times away + foot is away
        // height^2.
        const Vec sum = hn::Add(away, hn::Abs(foot)), twice = hn::Add(away, away);
        const Vec wide = hn::Sqrt(hn::Div(sum, twice));
        const Vec narrow = hn::Div(height, hn::Sqrt(hn::Mul(twice, sum)));
        const Vec c = hn::IfThenElse(hn::Lt(foot, hn::Zero(d)), wide, narrow);
        const Vec t_sv = hn::Mul(sigma, away);
        *served = hn::And(hn::And(hn::Ge(c, hn::Set(d, kLeastGamma)),
                                  within(away, kLeastThickness, kLargestThickness)),
                          serves_lengths(t_sv, hn::Mul(sigma, x[3])));
        const Vec per_away = hn::Div(hn::Set(d, 1.0f), away);
        const Vec length = seen_length(x[3], away), beyond = hn::Sub(length, foot);
        const Vec distance = hn::Sqrt(hn::MulAdd(beyond, beyond, squared));
        return airlight_of(FittedRayIntegral(),
                           {hn::Min(c, hn::Set(d, 1.0f)), hn::Mul(length, per_away),
                            hn::Mul(beyond, per_away), hn::Mul(distance, per_away)},
                           t_sv, hn::Mul(sigma, x[2]));
    }
};

HWY_ATTR void run_airlight(std::size_t count, const float* gamma, const float* t_sv,
                           const float* t_vp, float* out) {
    batch(count, {gamma, t_sv, t_vp}, out, AirlightKernel<FittedRayIntegral>{});
}

HWY_ATTR void run_airlight_parts(float extinction, std::size_t count, const float* foot,
                                 const float* height, const float* begin, const float* length,
                                 float* out) {
    batch(count, {foot, height, begin, length}, out, AirlightPartKernel{extinction});
}

HWY_ATTR void run_airlight_table(const float* values, int size, std::size_t count,
                                 const float* gamma, const float* t_sv, const float* t_vp,
                                 float* out) {
    batch(count, {gamma, t_sv, t_vp}, out, AirlightKernel<TabulatedRayIntegral>{{values, size}});
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_airlight);
HWY_EXPORT(run_airlight_parts);
HWY_EXPORT(run_airlight_table);

void airlight_batch(std::size_t count, const float* gamma, const float* t_sv, const float* t_vp,
                    float* out) {
    HWY_DYNAMIC_DISPATCH(run_airlight)(count, gamma, t_sv, t_vp, out);
}

void airlight_parts_batch(std::size_t count, float extinction, const float* foot,
                          const float* height, const float* begin, const float* length,
                          float* out) {
    HWY_DYNAMIC_DISPATCH(run_airlight_parts)(extinction, count, foot, height, begin, length, out);
}

AirlightBatchTable::AirlightBatchTable(int size)
    : size_(size), values_(static_cast<std::size_t>(size) * size) {
    assert(size >= 2);
    for (int row = 0; row < size; ++row) {
        const double c = static_cast<double>(row) / (size - 1);
        const double sine = std::sqrt((1 - c) * (1 + c));
        const detail::RayAngle angle = {std::atan2(sine, c), c, sine};
        for (int column = 0; column < size; ++column) {
            const double u = static_cast<double>(column) / (size - 1);
            const double y = 2 * u * u / ((1 - u) * (1 + u));
            values_[static_cast<std::size_t>(row) * size + column] = static_cast<float>(
                column + 1 < size ? detail::infinite_ray_integral(y, angle) * (y + 2) : 1);
        }
    }
}

void AirlightBatchTable::airlight_batch(std::size_t count, const float* gamma, const float* t_sv,
                                        const float* t_vp, float* out) const {
    HWY_DYNAMIC_DISPATCH(run_airlight_table)(values_.data(), size_, count, gamma, t_sv, t_vp, out);
}

}  // namespace airlight
#endif
