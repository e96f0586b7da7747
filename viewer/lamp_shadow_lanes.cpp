// SPDX-License-Identifier: Apache-2.0
// LampShadowMap::lit(): each lane has a ray.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "viewer/lamp_shadow_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cassert>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "viewer/lamp_shadow_map.h"
#include "viewer/ray_nodes.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

constexpr std::size_t kMaxLanes = hn::MaxLanes(Tag());
constexpr int kHalvings = 5;

struct Vec3 {
    Vec x, y, z;
};

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// An angle, as a point of the circle or near it.
struct Turn {
    Vec cosine, sine;
};

HWY_INLINE Turn sum(const Turn& a, const Turn& b) {
    return {hn::NegMulAdd(a.sine, b.sine, hn::Mul(a.cosine, b.cosine)),
            hn::MulAdd(a.sine, b.cosine, hn::Mul(a.cosine, b.sine))};
}

// Of an angle in [0, pi].
HWY_INLINE Turn half_of(const Turn& a) {
    const Tag d;
    const Vec half = hn::Set(d, 0.5f);
    const Vec larger = hn::Sqrt(hn::MulAdd(half, hn::Abs(a.cosine), half));
    const Vec smaller = hn::Div(hn::Mul(half, a.sine), larger);
    const Mask wide = hn::Lt(a.cosine, hn::Zero(d));
    return {hn::IfThenElse(wide, smaller, larger), hn::IfThenElse(wide, larger, smaller)};
}

// Rays as the lamp sees them: at the angle u, cos(u) times a point is cos(u) foot + sin(u) ahead,
// and the point lies height tan(u) behind the foot.
struct SeenRays {
    Vec3 foot, ahead;  // ahead is `height` long
    Vec distance_of_foot, height, distance;
};

struct Cube {
    const float* depths;
    int size;

    // Whether the lamp sees the points v / scale.
    HWY_INLINE Mask sees(const Vec3& v, Vec scale) const {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vec ax = hn::Abs(v.x), ay = hn::Abs(v.y), az = hn::Abs(v.z);
        const Vec along = hn::Max(hn::Max(ax, ay), hn::Max(az, hn::Set(d, 1e-30f)));
        const Mask by_x = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az)), by_y = hn::Ge(ay, az);
        const auto pick = [&](Vec x, Vec y, Vec z) {
            return hn::IfThenElse(by_x, x, hn::IfThenElse(by_y, y, z));
        };
        const Vec half = hn::Set(d, 0.5f * static_cast<float>(size));
        const Vec to_texel = hn::Div(half, along);
        const auto texel = [&](Vec across) {
            const auto number = hn::ConvertTo(di, hn::MulAdd(across, to_texel, half));
            return hn::Max(hn::Zero(di), hn::Min(number, hn::Set(di, size - 1)));
        };
        const auto column = texel(pick(v.y, v.z, v.x)), row = texel(pick(v.z, v.x, v.y));
        const Vec of_axis = pick(hn::Zero(d), hn::Set(d, 2.0f), hn::Set(d, 4.0f));
        const Mask behind = hn::Lt(pick(v.x, v.y, v.z), hn::Zero(d));
        const Vec side = hn::Add(of_axis, hn::IfThenElseZero(behind, hn::Set(d, 1.0f)));
        const auto lines = hn::Set(di, size);
        const auto line = hn::Add(hn::Mul(hn::ConvertTo(di, side), lines), row);
        const Vec depth = hn::GatherIndex(d, depths, hn::Add(hn::Mul(line, lines), column));
        // The directions of the sides are 1 along their axis, and so depths are along it.
        const Vec reach = hn::Mul(scale, hn::Set(d, 1 + 2 / static_cast<float>(size)));
        return hn::Not(hn::Gt(along, hn::Mul(depth, reach)));
    }

    HWY_INLINE Mask sees(const SeenRays& rays, const Turn& u) const {
        const auto at = [&](Vec foot, Vec ahead) {
            return hn::MulAdd(u.sine, ahead, hn::Mul(u.cosine, foot));
        };
        return sees({at(rays.foot.x, rays.ahead.x), at(rays.foot.y, rays.ahead.y),
                     at(rays.foot.z, rays.ahead.z)},
                    u.cosine);
    }
};

// Rays of one vector, and the borders on them.
class LitFinder {
  public:
    LitFinder(const Cube& cube, const glm::vec3& to_lamp, int points)
        : cube_(cube), to_lamp_(to_lamp), points_(points) {}

    HWY_INLINE void operator()(const RayColumns& rays, std::size_t first,
                               std::vector<LitPart>& parts) {
        const Tag d;
        mark(seen_rays(
            {hn::Load(d, rays.x + first), hn::Load(d, rays.y + first), hn::Load(d, rays.z + first)},
            hn::Load(d, rays.distance + first)));
        borders_ = 0;
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
            if (rays.distance[first + lane] > 0) list_borders(lane);
        }
        for (std::size_t begin = 0; begin < borders_; begin += hn::Lanes(d))
            halve(rays, first, begin);
        const float* place = places_;
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
            const float distance = rays.distance[first + lane];
            if (!(distance > 0)) continue;
            const std::uint64_t seen = seen_by(lane);
            LitPart part{static_cast<std::uint32_t>(first + lane), 0, double(distance)};
            bool open = seen & 1;
            for (std::uint64_t left = changes(seen); left != 0; left &= left - 1) {
                (open ? part.end : part.begin) = double(*place++);
                if (open) parts.push_back(part);
                open = !open;
            }
            part.end = double(distance);
            if (open) parts.push_back(part);
        }
    }

  private:
    HWY_INLINE SeenRays seen_rays(const Vec3& direction, Vec distance) const {
        const Tag d;
        const Vec3 to_lamp{hn::Set(d, to_lamp_.x), hn::Set(d, to_lamp_.y), hn::Set(d, to_lamp_.z)};
        const Vec along = dot(direction, to_lamp);
        const Vec3 foot{hn::MulSub(along, direction.x, to_lamp.x),
                        hn::MulSub(along, direction.y, to_lamp.y),
                        hn::MulSub(along, direction.z, to_lamp.z)};
        const Vec least = hn::Mul(hn::Set(d, static_cast<float>(kLeastHeight)),
                                  hn::Add(hn::Set(d, 1.0f), hn::Abs(along)));
        const Vec height = hn::Max(hn::Sqrt(dot(foot, foot)), least);
        return {foot,
                {hn::Mul(height, direction.x), hn::Mul(height, direction.y),
                 hn::Mul(height, direction.z)},
                along,
                height,
                distance};
    }

    // Which of the points the lamp sees, to bits.
    HWY_INLINE void mark(const SeenRays& rays) {
        const Tag d;
        const hn::RebindToUnsigned<Tag> du;
        const auto at = [&](Vec behind) {
            const Vec away =
                hn::Sqrt(hn::MulAdd(behind, behind, hn::Mul(rays.height, rays.height)));
            return Turn{hn::Div(rays.height, away), hn::Div(behind, away)};
        };
        // Beyond this the lamp sees the end of the ray where it sees that of an endless one.
        const Vec end = hn::Min(rays.distance, hn::Set(d, 1e15f));
        const Turn first = at(hn::Neg(rays.distance_of_foot));
        const Turn last = at(hn::Sub(end, rays.distance_of_foot));
        Turn step = sum(last, {first.cosine, hn::Neg(first.sine)});
        step.sine = hn::Max(step.sine, hn::Zero(d));
        for (int n = 1; n < points_; n *= 2) step = half_of(step);
        Turn u = sum(first, half_of(step));
        auto bits = hn::Zero(du);
        for (int i = 0; i < points_; ++i) {
            const auto bit = hn::Set(du, std::uint32_t(1) << (i % 32));
            bits = hn::Or(bits, hn::IfThenElseZero(hn::RebindMask(du, cube_.sees(rays, u)), bit));
            hn::Store(u.cosine, d, cosines_ + static_cast<std::size_t>(i) * hn::Lanes(d));
            hn::Store(u.sine, d, sines_ + static_cast<std::size_t>(i) * hn::Lanes(d));
            if (i % 32 == 31 || i + 1 == points_) {
                hn::Store(bits, du, seen_[i / 32]);
                bits = hn::Zero(du);
            }
            u = sum(u, step);
        }
    }

    std::uint64_t seen_by(std::size_t lane) const {
        return seen_[0][lane] | std::uint64_t(points_ > 32 ? seen_[1][lane] : 0) << 32;
    }

    // Points that are not as the one before.
    std::uint64_t changes(std::uint64_t seen) const {
        const std::uint64_t all = ~std::uint64_t(0) >> (64 - points_);
        return (seen ^ (seen << 1)) & all & ~std::uint64_t(1);
    }

    HWY_INLINE void list_borders(std::size_t lane) {
        const std::uint64_t seen = seen_by(lane);
        for (std::uint64_t left = changes(seen); left != 0; left &= left - 1) {
            const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
            const std::size_t here = (i - ((seen >> i) & 1 ? 0 : 1)) * hn::Lanes(Tag()) + lane;
            const std::size_t there = (i - ((seen >> i) & 1 ? 1 : 0)) * hn::Lanes(Tag()) + lane;
            lane_[borders_] = static_cast<std::int32_t>(lane);
            seen_cosine_[borders_] = cosines_[here];
            seen_sine_[borders_] = sines_[here];
            unseen_cosine_[borders_] = cosines_[there];
            unseen_sine_[borders_++] = sines_[there];
        }
    }

    // The middle of two near angles is their sum, but for a factor that sees() does not ask for.
    HWY_INLINE void halve(const RayColumns& columns, std::size_t first, std::size_t begin) {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const auto lane = hn::And(hn::Load(di, lane_ + begin),
                                  hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d) - 1)));
        const auto of = [&](const float* column) {
            return hn::GatherIndex(d, column + first, lane);
        };
        const SeenRays rays =
            seen_rays({of(columns.x), of(columns.y), of(columns.z)}, of(columns.distance));
        Turn seen{hn::Load(d, seen_cosine_ + begin), hn::Load(d, seen_sine_ + begin)};
        Turn unseen{hn::Load(d, unseen_cosine_ + begin), hn::Load(d, unseen_sine_ + begin)};
        const Vec half = hn::Set(d, 0.5f);
        const auto middle = [&] {
            return Turn{hn::Mul(half, hn::Add(seen.cosine, unseen.cosine)),
                        hn::Mul(half, hn::Add(seen.sine, unseen.sine))};
        };
        for (int i = 0; i < kHalvings; ++i) {
            const Turn u = middle();
            const Mask there = cube_.sees(rays, u);
            seen = {hn::IfThenElse(there, u.cosine, seen.cosine),
                    hn::IfThenElse(there, u.sine, seen.sine)};
            unseen = {hn::IfThenElse(there, unseen.cosine, u.cosine),
                      hn::IfThenElse(there, unseen.sine, u.sine)};
        }
        const Turn u = middle();
        const Vec place = hn::MulAdd(rays.height, hn::Div(u.sine, u.cosine), rays.distance_of_foot);
        hn::Store(hn::Max(hn::Zero(d), hn::Min(place, rays.distance)), d, places_ + begin);
    }

    static constexpr std::size_t kMost = LampShadowMap::kMostPoints * kMaxLanes;

    Cube cube_;
    glm::vec3 to_lamp_;
    int points_;
    HWY_ALIGN std::uint32_t seen_[2][kMaxLanes];
    HWY_ALIGN float cosines_[kMost], sines_[kMost];  // (point, lane)
    std::size_t borders_ = 0;
    // Of each border, the lane and the angles on its sides; then its place.
    HWY_ALIGN std::int32_t lane_[kMost];
    HWY_ALIGN float seen_cosine_[kMost], seen_sine_[kMost];
    HWY_ALIGN float unseen_cosine_[kMost], unseen_sine_[kMost], places_[kMost];
};

HWY_ATTR void find_lit(const float* depths, int size, const glm::vec3& to_lamp,
                       const RayColumns& rays, int points, std::vector<LitPart>& parts) {
    LitFinder finder({depths, size}, to_lamp, points);
    for (std::size_t i = 0; i < rays.count; i += hn::Lanes(Tag())) finder(rays, i, parts);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(find_lit);

void LampShadowMap::lit(const glm::dvec3& origin, const RayColumns& rays, int points,
                        std::vector<LitPart>& parts) const {
    assert(points > 0 && points <= kMostPoints && (points & (points - 1)) == 0);
    HWY_DYNAMIC_DISPATCH(find_lit)
    (depths_.data(), size_, glm::vec3(lamp_ - origin), rays, points, parts);
}

}  // namespace airlight
#endif
