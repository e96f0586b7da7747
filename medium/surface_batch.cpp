// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "medium/surface_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/batch-inl.h"
#include "medium/ray_integral.h"
#include "medium/surface_batch.h"
#include "medium/surface_radiance_tables.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kThickest = static_cast<float>(WarpedSurfaceTable::kThickest);

// The four weights of the cubic through -1, 0, 1, 2 at x.
struct CubicWeights {
    Vec w[4];

    HWY_INLINE explicit CubicWeights(Vec x) {
        const Tag d;
        const Vec one = hn::Set(d, 1.0f);
        const Vec a = hn::Add(x, one), b = hn::Sub(x, one), c = hn::Sub(b, one);
        const Vec xb = hn::Mul(x, b), ac = hn::Mul(a, c);
        w[0] = hn::Mul(hn::Mul(xb, c), hn::Set(d, -1 / 6.0f));
        w[1] = hn::Mul(hn::Mul(ac, b), hn::Set(d, 0.5f));
        w[2] = hn::Mul(hn::Mul(ac, x), hn::Set(d, -0.5f));
        w[3] = hn::Mul(hn::Mul(xb, a), hn::Set(d, 1 / 6.0f));
    }
};

template <bool kByChord>
struct SurfaceKernel {
    static constexpr std::size_t kInputs = 2;
    const float* values;
    int columns, rows;
    bool narrow;

    // What the table does not hold: nothing is left of e^-T there, or it is outside the domain.
    float operator()(const float (&x)[2]) const {
        const bool angle =
            kByChord ? x[1] >= 0 && x[1] <= 1 : !std::isnan(detail::checked_angle(x[1]));
        const bool inside = x[0] > kThickest && angle;
        return inside ? 0 : std::numeric_limits<float>::quiet_NaN();
    }

    HWY_INLINE Vec operator()(Tag d, const Vec (&x)[2], Mask* served) const {
        const hn::RebindToSigned<Tag> di;
        const Vec one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
        const Vec t = x[0];
        Vec theta = x[1];
        float largest = static_cast<float>(detail::kPiOfFloat);
        if (kByChord) largest = 1;
        *served = hn::And(within(t, 0, kThickest), within(x[1], 0, largest));
        if (kByChord) {
            const Vec asin = hn::Asin(d, hn::Sqrt(hn::Min(theta, one)));
            theta = hn::Min(hn::Add(asin, asin), hn::Set(d, static_cast<float>(kPi)));
        }
        const Vec u = hn::Mul(hn::Sqrt(hn::Sqrt(hn::Mul(t, hn::Set(d, 1 / kThickest)))),
                              hn::Set(d, static_cast<float>(columns - 1)));
        const float last = static_cast<float>(rows - 1);
        Vec v;
        // Lanes that are not served may hold anything.
        auto lowest = hn::Zero(di), highest = hn::Set(di, rows - 4);
        if (narrow) {
            v = hn::Mul(hn::Sqrt(hn::Mul(theta, hn::Set(d, static_cast<float>(1 / kPi)))),
                        hn::Set(d, last));
        } else {
            const Vec y = hn::MulSub(theta, hn::Set(d, static_cast<float>(2 / kPi)), one);
            const Vec root = hn::CopySign(hn::Sqrt(hn::Abs(y)), y);
            v = hn::Mul(hn::Add(one, root), hn::Set(d, 0.5f * last));
            // Not across theta = pi/2.
            const auto middle = hn::Set(di, (rows - 1) / 2);
            const auto ahead = hn::Gt(middle, hn::ConvertTo(di, v));
            lowest = hn::IfThenElse(ahead, lowest, middle);
            highest = hn::IfThenElse(ahead, hn::Sub(middle, hn::Set(di, 3)), highest);
        }
        const auto back = hn::Set(di, 1);
        const auto column = hn::Max(
            hn::Zero(di), hn::Min(hn::Sub(hn::ConvertTo(di, u), back), hn::Set(di, columns - 4)));
        const auto row = hn::Max(lowest, hn::Min(hn::Sub(hn::ConvertTo(di, v), back), highest));
        const CubicWeights wu(hn::Sub(hn::Sub(u, hn::ConvertTo(d, column)), one));
        const CubicWeights wv(hn::Sub(hn::Sub(v, hn::ConvertTo(d, row)), one));
        const auto at = hn::Add(hn::Mul(row, hn::Set(di, columns)), column);
        Vec sum = hn::Zero(d);
        for (int i = 0; i < 4; ++i) {
            const float* line = values + i * columns;
            Vec along = hn::Mul(wu.w[0], hn::GatherIndex(d, line, at));
            for (int j = 1; j < 4; ++j) {
                along = hn::MulAdd(wu.w[j], hn::GatherIndex(d, line + j, at), along);
            }
            sum = hn::MulAdd(wv.w[i], along, sum);
        }
        // Three factors, none denormal while their product is not.
        const Vec transmittance = hn::Exp(d, hn::Neg(hn::Mul(half, t)));
        return hn::Mul(hn::Mul(hn::Exp(d, sum), transmittance), transmittance);
    }
};

HWY_ATTR void run_surface(const float* values, int columns, int rows, bool narrow,
                          std::size_t count, const float* t, const float* theta, float* out) {
    batch(count, {t, theta}, out, SurfaceKernel<false>{values, columns, rows, narrow});
}

HWY_ATTR void run_surface_by_chord(const float* values, int columns, int rows, bool narrow,
                                   std::size_t count, const float* t, const float* q, float* out) {
    batch(count, {t, q}, out, SurfaceKernel<true>{values, columns, rows, narrow});
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_surface);
HWY_EXPORT(run_surface_by_chord);

SurfaceBatchTable::SurfaceBatchTable(double exponent, int size) : exponent_(exponent) {
    const WarpedSurfaceTable table(exponent, size, SurfaceInterpolation::cubic);
    columns_ = table.columns();
    rows_ = table.rows();
    values_.assign(table.values().begin(), table.values().end());
}

void SurfaceBatchTable::surface_batch(std::size_t count, const float* t_sp, const float* theta_s,
                                      float* out) const {
    HWY_DYNAMIC_DISPATCH(run_surface)
    (values_.data(), columns_, rows_, exponent_ >= WarpedSurfaceTable::kFirstNarrow, count, t_sp,
     theta_s, out);
}

void SurfaceBatchTable::surface_batch_by_chord(std::size_t count, const float* t_sp, const float* q,
                                               float* out) const {
    HWY_DYNAMIC_DISPATCH(run_surface_by_chord)
    (values_.data(), columns_, rows_, exponent_ >= WarpedSurfaceTable::kFirstNarrow, count, t_sp, q,
     out);
}

}  // namespace airlight
#endif
