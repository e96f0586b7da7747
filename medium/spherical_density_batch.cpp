// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/spherical_density_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <cmath>

#include "medium/batch-inl.h"
#include "medium/spherical_density.h"
#include "medium/spherical_density_batch.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::ScalableTag<double>;
using DoubleVec = hn::Vec<DoubleTag>;

// What the rule needs of one curved column (medium/curved_column.h), per lane.
struct ColumnBuffers {
    HWY_ALIGN float step[kMaxLanes];
    HWY_ALIGN float linear[kMaxLanes];
    HWY_ALIGN float square[kMaxLanes];
};

HWY_INLINE void store_float(DoubleVec value, float* at) {
    const DoubleTag dd;
    const hn::Rebind<float, DoubleTag> df;
    hn::StoreU(hn::DemoteTo(df, hn::Min(hn::Max(value, hn::Set(dd, -1e37)), hn::Set(dd, 1e37))), df,
               at);
}

// g = (P + T) / (z (1 + c)), cut where the excess p = g (z c + z (1 + c) g / 2) / (1 + g) is 16.
HWY_INLINE void prepare_column(DoubleVec z, DoubleVec c, DoubleVec t, std::size_t lane,
                               ColumnBuffers* column) {
    const DoubleTag dd;
    const DoubleVec depth = hn::Set(dd, 16.0), half = hn::Set(dd, 0.5);
    const DoubleVec linear = hn::Mul(z, c), square = hn::Mul(half, hn::Add(z, linear));
    const DoubleVec b = hn::Sub(linear, depth);
    const DoubleVec root =
        hn::Sqrt(hn::MulAdd(b, b, hn::Mul(hn::Mul(hn::Set(dd, 4.0), depth), square)));
    const DoubleVec last = hn::Div(hn::Add(depth, depth), hn::Add(b, root));
    const DoubleVec twice = hn::Mul(t, hn::Add(hn::Add(linear, linear), t));
    const DoubleVec rise = hn::Div(twice, hn::Add(hn::Sqrt(hn::MulAdd(z, z, twice)), z));
    const DoubleVec g = hn::Min(last, hn::Div(hn::Mul(half, hn::Add(rise, t)), square));
    store_float(g, column->step + lane);
    store_float(hn::Mul(linear, g), column->linear + lane);
    store_float(hn::Mul(hn::Mul(square, g), g), column->square + lane);
}

// e^-p for p in [0, 80], relative error 2e-7; half the work of an exponential for any argument.
HWY_INLINE Vec decay(Vec p) {
    // e^x for |x| <= ln(2) / 2, minimax, 7e-8.
    constexpr float kPowers[] = {1.000000072e+00f, 9.999996920e-01f, 4.999889481e-01f,
                                 1.666757478e-01f, 4.191538618e-02f, 8.297653484e-03f};
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    // Adding it rounds to an integer, which then stands in the low bits.
    const Vec shift = hn::Set(d, 12582912.0f);
    const Vec shifted = hn::NegMulAdd(p, hn::Set(d, 1.44269504f), shift);
    const Vec whole = hn::Sub(shifted, shift);
    // ln(2) in two parts; the products with the first are exact.
    const Vec x = hn::NegMulAdd(whole, hn::Set(d, -2.12194440e-4f),
                                hn::NegMulAdd(whole, hn::Set(d, 0.693359375f), hn::Neg(p)));
    return hn::BitCast(d, hn::Add(hn::BitCast(di, polynomial<6>(kPowers, x)),
                                  hn::ShiftLeft<23>(hn::BitCast(di, shifted))));
}

// int_0^1 e^{-p} (1 + p / z) / (1 + g x) dx by twelve Gauss-Legendre points.
HWY_INLINE Vec column_mean(const ColumnBuffers& column, Vec per_z) {
    constexpr float kX[6][2] = {{0.00921968288f, 0.990780317f}, {0.0479413718f, 0.952058628f},
                                {0.115048663f, 0.884951337f},   {0.206341023f, 0.793658977f},
                                {0.316084251f, 0.683915749f},   {0.437383296f, 0.562616704f}};
    constexpr float kWeights[6] = {0.0235876682f, 0.053469663f, 0.0800391643f,
                                   0.101583713f,  0.116746268f, 0.124573523f};
    const Tag d;
    const Vec one = hn::Set(d, 1.0f);
    const Vec step = hn::Load(d, column.step);
    const Vec linear = hn::Load(d, column.linear), square = hn::Load(d, column.square);
    Vec sum = hn::Zero(d);
    for (int i = 0; i < 6; ++i) {
        // One division for both points of a pair.
        const Vec x[] = {hn::Set(d, kX[i][0]), hn::Set(d, kX[i][1])};
        const Vec below[] = {hn::MulAdd(step, x[0], one), hn::MulAdd(step, x[1], one)};
        const Vec both = hn::Div(one, hn::Mul(below[0], below[1]));
        Vec pair = hn::Zero(d);
        for (int k = 0; k < 2; ++k) {
            const Vec v = hn::Mul(both, below[1 - k]);
            const Vec p = hn::Mul(hn::Mul(x[k], v), hn::MulAdd(square, x[k], linear));
            pair = hn::MulAdd(decay(p), hn::Mul(hn::MulAdd(p, per_z, one), v), pair);
        }
        sum = hn::MulAdd(hn::Set(d, kWeights[i]), pair, sum);
    }
    return sum;
}

struct SphericalKernel {
    static constexpr std::size_t kInputs = 3;
    float radius, scale_height;
    bool at_altitude;

    float operator()(const float (&x)[3]) const {
        return at_altitude ? spherical_depth_at_altitude(radius, scale_height, x[0], x[1], x[2])
                           : spherical_depth(radius, scale_height, x[0], x[1], x[2]);
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[3], Mask* served) const {
        HWY_ALIGN float start[kMaxLanes], cosine[kMaxLanes], distance[kMaxLanes];
        HWY_ALIGN float z_lane[kMaxLanes], second[kMaxLanes];
        HWY_ALIGN float exponent_lane[kMaxLanes], exponent_rest[kMaxLanes];
        ColumnBuffers columns[2];
        hn::Store(x[0], d, start);
        hn::Store(x[1], d, cosine);
        hn::Store(x[2], d, distance);

        // Lengths in units of the scale height; in double, where r - R keeps its digits.
        const DoubleTag dd;
        const hn::Rebind<float, DoubleTag> df;
        const DoubleVec zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
        const DoubleVec per_height = hn::Set(dd, 1 / double{scale_height});
        const DoubleVec sphere = hn::Set(dd, double{radius});
        for (std::size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
            const DoubleVec given = hn::PromoteTo(dd, hn::LoadU(df, start + lane));
            const DoubleVec c = hn::PromoteTo(dd, hn::LoadU(df, cosine + lane));
            const DoubleVec t =
                hn::Min(hn::Mul(hn::PromoteTo(dd, hn::LoadU(df, distance + lane)), per_height),
                        hn::Set(dd, 1e30));
            const DoubleVec r = hn::Mul(at_altitude ? hn::Add(given, sphere) : given, per_height);
            const DoubleVec altitude =
                hn::Mul(at_altitude ? given : hn::Sub(given, sphere), per_height);
            const DoubleVec sine = hn::Sqrt(hn::Mul(hn::Sub(one, c), hn::Add(one, c)));
            const DoubleVec along = hn::Mul(r, c), end = hn::Add(along, t);
            const DoubleVec periapsis = hn::Mul(r, sine);
            const auto rises = hn::Ge(c, zero);
            const auto turns = hn::AndNot(rises, hn::Gt(end, zero));
            // The lowest point: the start, the end or the periapsis.
            const DoubleVec end_distance =
                hn::Sqrt(hn::MulAdd(end, end, hn::Mul(periapsis, periapsis)));
            const DoubleVec low =
                hn::IfThenElse(rises, r, hn::IfThenElse(turns, periapsis, end_distance));
            const DoubleVec fall =
                hn::IfThenElse(turns, hn::Div(hn::Mul(along, hn::Neg(c)), hn::Add(one, sine)),
                               hn::Div(hn::Mul(t, hn::Add(along, end)), hn::Add(end_distance, r)));
            const DoubleVec exponent = hn::Add(altitude, hn::IfThenZeroElse(rises, fall));
            const DoubleVec low_cosine = hn::IfThenElse(
                rises, c, hn::IfThenZeroElse(turns, hn::Div(hn::Neg(end), end_distance)));
            prepare_column(low, low_cosine, hn::IfThenElse(turns, hn::Neg(along), t), lane,
                           &columns[0]);
            prepare_column(low, zero, hn::Max(end, zero), lane, &columns[1]);
            store_float(low, z_lane + lane);
            store_float(exponent, exponent_lane + lane);
            const DoubleVec rounded = hn::PromoteTo(dd, hn::LoadU(df, exponent_lane + lane));
            store_float(hn::Sub(exponent, rounded), exponent_rest + lane);
            store_float(hn::IfThenElseZero(turns, one), second + lane);
        }

        const Vec z = hn::Load(d, z_lane), exponent = hn::Load(d, exponent_lane);
        const Vec two = hn::Load(d, second);
        const bool is_profile =
            radius >= 0 && radius <= 0x1p60f && scale_height >= 0x1p-30f && scale_height <= 0x1p30f;
        *served = hn::And(hn::And(within(x[1], -1.0f, 1.0f), hn::Gt(x[2], hn::Set(d, 0x1p-60f))),
                          hn::And(within(z, is_profile ? 20.0f : HUGE_VALF, 0x1p30f),
                                  hn::Ge(exponent, hn::Set(d, -100.0f))));

        const Vec per_z = hn::Div(hn::Set(d, 1.0f), z);
        Vec sum = hn::Mul(hn::Load(d, columns[0].step), column_mean(columns[0], per_z));
        if (!hn::AllTrue(d, hn::Eq(two, hn::Zero(d)))) {
            const Vec beyond =
                hn::Mul(hn::Load(d, columns[1].step), column_mean(columns[1], per_z));
            sum = hn::Add(sum, hn::IfThenElseZero(hn::Gt(two, hn::Zero(d)), beyond));
        }
        const Vec rest =
            hn::IfThenElseZero(hn::Lt(exponent, hn::Set(d, 1000.0f)), hn::Load(d, exponent_rest));
        // Two equal factors, neither denormal where their product is not.
        const Vec root = hn::Exp(d, hn::Mul(hn::Set(d, -0.5f), exponent));
        const Vec column = hn::Mul(hn::Mul(hn::Set(d, scale_height), z), sum);
        return hn::Mul(hn::Mul(hn::NegMulAdd(column, rest, column), root), root);
    }
};

HWY_ATTR void run_spherical(float radius, float scale_height, bool at_altitude, std::size_t count,
                            const float* start, const float* cos_zenith, const float* distance,
                            float* out) {
    batch(count, {start, cos_zenith, distance}, out,
          SphericalKernel{radius, scale_height, at_altitude});
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_spherical);

void spherical_depth_at_altitude_batch(float radius, float scale_height, std::size_t count,
                                       const float* altitude, const float* cos_zenith,
                                       const float* distance, float* out) {
    HWY_DYNAMIC_DISPATCH(run_spherical)
    (radius, scale_height, true, count, altitude, cos_zenith, distance, out);
}

void spherical_depth_batch(float radius, float scale_height, std::size_t count,
                           const float* center_distance, const float* cos_zenith,
                           const float* distance, float* out) {
    HWY_DYNAMIC_DISPATCH(run_spherical)
    (radius, scale_height, false, count, center_distance, cos_zenith, distance, out);
}

}  // namespace airlight
#endif
