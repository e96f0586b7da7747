// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "viewer/shadow_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>

#include "viewer/shadow_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using detail::kShadowLanes;
using detail::Linear;
using detail::ShadowBoxes;
using detail::ShadowQuery;
using detail::ShadowTriangles;

using Tag = hn::CappedTag<double, kShadowLanes>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

HWY_INLINE unsigned bits_of(Mask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Tag(), mask, bytes);
    return bytes[0];
}

struct Boxes {
    Vec middle[3], half[3];

    HWY_INLINE Vec at(const Linear& plane) const {
        const Tag d;
        Vec sum = hn::Set(d, plane.offset);
        for (int i = 0; i < 3; ++i) sum = hn::MulAdd(hn::Set(d, plane.slope[i]), middle[i], sum);
        return sum;
    }
    HWY_INLINE Vec spread(const Linear& plane) const {
        const Tag d;
        Vec sum = hn::Zero(d);
        for (int i = 0; i < 3; ++i) {
            sum = hn::MulAdd(hn::Abs(hn::Set(d, plane.slope[i])), half[i], sum);
        }
        return sum;
    }
    HWY_INLINE Mask reaches(const Linear& plane) const {
        return hn::Ge(hn::Add(at(plane), spread(plane)), hn::Zero(Tag()));
    }
    HWY_INLINE Mask inside(const Linear& plane) const { return hn::Gt(at(plane), spread(plane)); }
};

HWY_ATTR unsigned run_boxes(const ShadowBoxes& boxes, const ShadowQuery& query) {
    const Tag d;
    const hn::Rebind<float, Tag> df;
    const int lanes = static_cast<int>(hn::Lanes(d));
    unsigned bits = 0;
    for (int lane = 0; lane < kShadowLanes; lane += lanes) {
        Boxes b;
        for (int i = 0; i < 3; ++i) {
            b.middle[i] = hn::PromoteTo(d, hn::LoadU(df, boxes.middle[i] + lane));
            b.half[i] = hn::PromoteTo(d, hn::LoadU(df, boxes.half[i] + lane));
        }
        const Vec y = b.at(query.y), spread = b.spread(query.y);
        Mask met = hn::Le(hn::Abs(b.at(query.z)), b.spread(query.z));
        met = hn::And(met, hn::Ge(hn::Add(y, spread), hn::Zero(d)));
        met = hn::And(met, hn::Le(hn::Sub(y, spread), hn::Set(d, query.height)));
        for (int i = 0; i < 3; ++i) {
            met = hn::And(met, hn::Ge(hn::Add(b.middle[i], b.half[i]), hn::Set(d, query.low[i])));
            met = hn::And(met, hn::Le(hn::Sub(b.middle[i], b.half[i]), hn::Set(d, query.high[i])));
        }
        met = hn::And(met, hn::And(b.reaches(query.all.after), b.reaches(query.all.before)));
        if (query.any_covered) {
            met = hn::AndNot(hn::And(b.inside(query.covered.after), b.inside(query.covered.before)),
                             met);
        }
        bits |= bits_of(met) << lane;
    }
    return bits;
}

// In the order of glm::dot; products and sums are rounded one by one, so that targets with fused
// operations agree with those without.
HWY_INLINE Vec value_at(const Linear& plane, const Vec (&x)[3]) {
    const Tag d;
    const Vec sum = hn::Add(
        hn::Add(hn::Mul(hn::Set(d, plane.slope.x), x[0]), hn::Mul(hn::Set(d, plane.slope.y), x[1])),
        hn::Mul(hn::Set(d, plane.slope.z), x[2]));
    return hn::Add(sum, hn::Set(d, plane.offset));
}

// Where the edge between two corners on either side of the plane cuts it. Both triangles of an edge
// go from the corner below to that above.
HWY_INLINE void cut_edge(const ShadowQuery& query, Mask first_above, const Vec (&first)[3],
                         Vec side_first, const Vec (&second)[3], Vec side_second, Vec* x, Vec* y) {
    const Vec from = hn::IfThenElse(first_above, side_second, side_first);
    const Vec to = hn::IfThenElse(first_above, side_first, side_second);
    const Vec part = hn::Div(from, hn::Sub(from, to));
    Vec cut[3];
    for (int i = 0; i < 3; ++i) {
        const Vec below = hn::IfThenElse(first_above, second[i], first[i]);
        const Vec above = hn::IfThenElse(first_above, first[i], second[i]);
        cut[i] = hn::Add(below, hn::Mul(part, hn::Sub(above, below)));
    }
    *x = value_at(query.x, cut);
    *y = value_at(query.y, cut);
}

HWY_ATTR unsigned run_shadows(const ShadowTriangles& triangles, const ShadowQuery& query,
                              double* begin, double* end) {
    const Tag d;
    const Vec zero = hn::Zero(d), height = hn::Set(d, query.height), foot = hn::Set(d, query.foot);
    const Vec infinite = hn::Set(d, std::numeric_limits<double>::infinity());
    const int lanes = static_cast<int>(hn::Lanes(d));
    unsigned bits = 0;
    for (int lane = 0; lane < kShadowLanes; lane += lanes) {
        Vec corner[3][3], side[3];
        Mask above[3];
        for (int i = 0; i < 3; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                corner[i][axis] = hn::LoadU(d, triangles.corner[i][axis] + lane);
            }
            side[i] = value_at(query.z, corner[i]);
            above[i] = hn::Ge(side[i], zero);
        }
        const Mask differs1 = hn::Xor(above[0], above[1]), differs2 = hn::Xor(above[0], above[2]);
        Mask met = hn::Or(differs1, differs2);
        if (hn::AllFalse(d, met)) continue;
        // The corner that is alone on its side comes first.
        const Mask lone0 = hn::And(differs1, differs2), lone1 = hn::AndNot(differs2, differs1);
        Vec first[3], second[3], third[3];
        for (int axis = 0; axis < 3; ++axis) {
            const Vec a = corner[0][axis], b = corner[1][axis], c = corner[2][axis];
            first[axis] = hn::IfThenElse(lone0, a, hn::IfThenElse(lone1, b, c));
            second[axis] = hn::IfThenElse(lone0, b, a);
            third[axis] = hn::IfThenElse(hn::Or(lone0, lone1), c, b);
        }
        const Vec s0 = side[0], s1 = side[1], s2 = side[2];
        const Vec side_first = hn::IfThenElse(lone0, s0, hn::IfThenElse(lone1, s1, s2));
        const Vec side_second = hn::IfThenElse(lone0, s1, s0);
        const Vec side_third = hn::IfThenElse(hn::Or(lone0, lone1), s2, s1);
        const Mask first_above = hn::Ge(side_first, zero);
        Vec x0, y0, x1, y1;
        cut_edge(query, first_above, first, side_first, second, side_second, &x0, &y0);
        cut_edge(query, first_above, first, side_first, third, side_third, &x1, &y1);
        const Mask turned = hn::Gt(y0, y1);
        const Vec x_low = hn::IfThenElse(turned, x1, x0), x_high = hn::IfThenElse(turned, x0, x1);
        const Vec y_low = hn::IfThenElse(turned, y1, y0), y_high = hn::IfThenElse(turned, y0, y1);
        met = hn::And(met, hn::And(hn::Gt(y_high, zero), hn::Lt(y_low, height)));
        if (hn::AllFalse(d, met)) continue;
        const Vec slope = hn::Div(hn::Sub(x_high, x_low), hn::Sub(y_high, y_low));
        const Vec at_light = hn::Sub(x_high, hn::Mul(slope, hn::Sub(y_high, height)));
        // What lies behind the ray is cut off, and what lies beyond the light throws no shadow.
        const Mask behind = hn::Lt(y_low, zero), beyond = hn::Ge(y_high, height);
        const Vec x_near = hn::IfThenElse(behind, hn::Sub(x_low, hn::Mul(slope, y_low)), x_low);
        const Vec y_near = hn::IfThenElse(behind, zero, y_low);
        const Vec a = hn::Add(foot, hn::Div(hn::Mul(height, x_near), hn::Sub(height, y_near)));
        const Vec b = hn::IfThenElse(
            beyond, hn::IfThenElse(hn::Lt(at_light, zero), hn::Neg(infinite), infinite),
            hn::Add(foot, hn::Div(hn::Mul(height, x_high), hn::Sub(height, y_high))));
        const Vec from = hn::Max(hn::Min(a, b), zero);
        const Vec to = hn::Min(hn::Max(a, b), hn::Set(d, query.distance));
        met = hn::And(met, hn::Lt(from, to));
        hn::StoreU(from, d, begin + lane);
        hn::StoreU(to, d, end + lane);
        bits |= bits_of(met) << lane;
    }
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_boxes);
HWY_EXPORT(run_shadows);

namespace detail {

unsigned boxes_in_question(const ShadowBoxes& boxes, const ShadowQuery& query) {
    return HWY_DYNAMIC_DISPATCH(run_boxes)(boxes, query);
}

unsigned shadows_of(const ShadowTriangles& triangles, const ShadowQuery& query,
                    double (&begin)[kShadowLanes], double (&end)[kShadowLanes]) {
    return HWY_DYNAMIC_DISPATCH(run_shadows)(triangles, query, begin, end);
}

}  // namespace detail
}  // namespace airlight
#endif
