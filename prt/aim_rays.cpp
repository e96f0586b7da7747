// SPDX-License-Identifier: Apache-2.0
#include "prt/aim_rays.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/aim_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

bool aim(const glm::mat3& frame, std::size_t count, const float* x, const float* y, const float* z,
         RTCRay* rays) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    bool all_finite = true;
    std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    const hn::FixedTag<float, 4> d;
    const auto infinity = hn::Set(d, kInfinity);
    auto finite = hn::Lt(hn::Zero(d), infinity);
    for (; i + 4 <= count; i += 4, rays += 4) {
        const auto u = hn::LoadU(d, x + i), v = hn::LoadU(d, y + i), w = hn::LoadU(d, z + i);
        const auto turned = [&](int axis) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, frame[0][axis]), u),
                                   hn::Mul(hn::Set(d, frame[1][axis]), v)),
                           hn::Mul(hn::Set(d, frame[2][axis]), w));
        };
        const auto a = turned(0), b = turned(1), c = turned(2);
        finite = hn::And(finite, hn::Lt(hn::Abs(a), infinity));
        finite = hn::And(finite, hn::Lt(hn::Abs(b), infinity));
        finite = hn::And(finite, hn::Lt(hn::Abs(c), infinity));
        // Behind each direction lies the time of its ray.
        const auto ab = hn::InterleaveLower(d, a, b), ct = hn::InterleaveLower(d, c, hn::Zero(d));
        const auto upper_ab = hn::InterleaveUpper(d, a, b),
                   upper_ct = hn::InterleaveUpper(d, c, hn::Zero(d));
        hn::StoreU(hn::ConcatLowerLower(d, ct, ab), d, &rays[0].dir_x);
        hn::StoreU(hn::ConcatUpperUpper(d, ct, ab), d, &rays[1].dir_x);
        hn::StoreU(hn::ConcatLowerLower(d, upper_ct, upper_ab), d, &rays[2].dir_x);
        hn::StoreU(hn::ConcatUpperUpper(d, upper_ct, upper_ab), d, &rays[3].dir_x);
        for (int k = 0; k < 4; ++k) rays[k].tfar = kInfinity;
    }
    all_finite = hn::AllTrue(d, finite);
#endif
    for (; i < count; ++i, ++rays) {
        float direction[3];
        for (int axis = 0; axis < 3; ++axis) {
            direction[axis] = frame[0][axis] * x[i] + frame[1][axis] * y[i] + frame[2][axis] * z[i];
            all_finite = all_finite && std::isfinite(direction[axis]);
        }
        rays->dir_x = direction[0];
        rays->dir_y = direction[1];
        rays->dir_z = direction[2];
        rays->time = 0;
        rays->tfar = kInfinity;
    }
    return all_finite;
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(aim);

namespace detail {

bool aim_rays(const glm::mat3& frame, std::size_t count, const float* x, const float* y,
              const float* z, RTCRay* rays) {
    return HWY_DYNAMIC_DISPATCH(aim)(frame, count, x, y, z, rays);
}

}  // namespace detail
}  // namespace airlight
#endif
