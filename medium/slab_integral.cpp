// SPDX-License-Identifier: Apache-2.0
#include "medium/slab_integral.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/quadrature.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Relative to the sum; what is below cannot be seen in a double.
constexpr double kNegligible = 1e-17;
// Growth of the exponent over one panel that 16 nodes follow to 1e-15.
constexpr double kMostDepthPerPanel = 6;
// Up to here ln(y + rho) is a good variable: the zeros of H lie on |y| = 1.
constexpr double kLogEnd = 0.35;
constexpr double kLogLength = 3;
constexpr double kLongestPanel = 5;
constexpr double kLongestFlatPanel = 1.75;
// Each panel but those cut by the exponent covers a factor of e; none needs this many.
constexpr int kMostPanels = 400;

// A ray that passes the light at 1e-13 of l is as good as one through it, but has a w there.
constexpr double kLeastToward = 1e-26;

// A point of the ray by w - w(0), from which y and H follow without cancellation.
struct Point {
    double y;
    double distance;  // H
};

class SlabSum {
  public:
    SlabSum(const SlabRay& ray, QuadratureRule rule)
        : ray_(ray),
          rule_(rule),
          toward_(ray.power == 0 ? std::max(1 + ray.g, kLeastToward) : 1 + ray.g),
          away_(1 - ray.g) {}

    double run() {
        const double probe = std::min({ray_.end, 1.0, 1 / ray_.thickness});
        const double whole = slab_angle(ray_.g, ray_.end, ray_.beyond);
        const double least = std::exp(-depth({probe, distance(probe)})) *
                             (ray_.power == 2 ? slab_angle(ray_.g, probe, probe - 1) : probe);
        // What lies below adds nothing; a ray that grazes at 1e-300 need not be followed there.
        const double skipped = kNegligible / 10 * least;
        if (ray_.rho < skipped) y_ = skipped;
        if (!log_panels(whole)) turned_panels(whole);
        return sum_;
    }

  private:
    double distance(double y) const { return std::sqrt((y - 1) * (y - 1) + 2 * y * toward_); }

    // 1 - f, also where rho is infinite.
    double outside(double y) const { return ray_.rho == 0 ? 0 : 1 / (1 + y / ray_.rho); }

    double inside(double y) const { return ray_.rho == 0 ? 1 : y / (y + ray_.rho); }

    double depth(const Point& p) const { return ray_.thickness * (p.y + inside(p.y) * p.distance); }

    // d depth / d y
    double slope(const Point& p) const {
        const double opening = ray_.rho == 0 ? 0 : outside(p.y) / (p.y + ray_.rho) * p.distance;
        // Towards the light it vanishes, and rounding must not turn it round.
        const double closing = std::max(-1.0, (p.y + ray_.g) / p.distance);
        return ray_.thickness * (1 + opening + inside(p.y) * closing);
    }

    // How strongly the pole of f shows in the exponent.
    double pole_strength(const Point& p) const {
        return ray_.thickness * p.distance * outside(p.y);
    }

    template <class At>
    double panel(double length, const At& at) const {
        const double half = 0.5 * length;
        double sum = 0;
        for (int i = 0; i < rule_.count; ++i) {
            const double offset = half * rule_.nodes[i].x;
            sum += rule_.nodes[i].w * (at(half - offset) + at(half + offset));
        }
        return half * sum;
    }

    // The longest panel from `from` up to `length` whose depth grows by no more than it may.
    template <class PointAt>
    double cut(double length, double growth, const Point& from, const PointAt& point_at) const {
        const double start = depth(from);
        length = std::min(length, kMostDepthPerPanel / growth);
        while (depth(point_at(length)) - start > 1.3 * kMostDepthPerPanel) length /= 2;
        return length;
    }

    // Whether the rest is negligible.
    bool log_panels(double whole) {
        if (ray_.rho == 0) return false;
        const double end = std::min(ray_.end, kLogEnd);
        for (int i = 0; i < kMostPanels && y_ < end; ++i) {
            const Point from = {y_, distance(y_)};
            const double gap = y_ + ray_.rho;
            if (gap > 0.25 || pole_strength(from) < kNegligible) return false;
            if (negligible(from, whole)) return true;
            const auto point_at = [&](double v) {
                const double y = std::min(y_ + gap * std::expm1(v), end);
                return Point{y, distance(y)};
            };
            const double to_end = std::log1p((end - y_) / gap);
            const double length =
                cut(std::min(to_end, kLogLength), slope(from) * gap, from, point_at);
            sum_ += gap * panel(length, [&](double v) {
                        const Point p = point_at(v);
                        const double weight = std::exp(v - depth(p));
                        return ray_.power == 2 ? weight / (p.distance * p.distance) : weight;
                    });
            y_ = length == to_end ? end : point_at(length).y;
        }
        return false;
    }

    double turn_at(double y, double beyond, double h) const {
        const double grown = y < 1 ? 2 * y / (h - beyond) : (beyond + h) / toward_;
        return std::log1p(grown);
    }

    Point point_at_turn(double w) const {
        const double grown = std::expm1(w), factor = 1 + grown;
        return {grown * (2 + grown * toward_) / (2 * factor),
                0.5 * (factor * toward_ + away_ / factor)};
    }

    void turned_panels(double whole) {
        if (!(y_ < ray_.end)) return;
        // w at the point next to the light, as seen from the start.
        const double nearest = 0.5 * std::log(away_ / toward_);
        const double end_distance = std::hypot(ray_.beyond, std::sqrt(2 * ray_.end * toward_));
        const double end =
            std::isinf(ray_.end) ? 690 : turn_at(ray_.end, ray_.beyond, end_distance);
        double w = turn_at(y_, y_ - 1, distance(y_));
        for (int i = 0; i < kMostPanels && w < end; ++i) {
            const Point from = point_at_turn(w);
            if (negligible(from, whole)) return;
            const double past = w - nearest;
            double length = past < -2 ? 1.25 - 0.375 * past : 2 + std::max(past, 0.0);
            length = std::min(length, ray_.power == 2 ? kLongestPanel : kLongestFlatPanel);
            if (ray_.rho > 0 && pole_strength(from) > kNegligible) {
                length = std::min(length, 1.5 * (from.y + ray_.rho) / from.distance);
            }
            const auto point_at = [&](double v) { return point_at_turn(w + v); };
            length = cut(std::min(length, end - w), slope(from) * from.distance, from, point_at);
            sum_ += panel(length, [&](double v) {
                const Point p = point_at(v);
                const double e = std::exp(-depth(p));
                return ray_.power == 2 ? e / p.distance : e * p.distance;
            });
            w += length;
        }
    }

    // A bound of the rest, for the exponent grows and past the light so it does by T dy or more.
    bool negligible(const Point& p, double whole) const {
        const double past = p.y + ray_.g;
        double rest = 0;
        if (ray_.power == 2) {
            rest = past > 0 ? std::min(whole, 1 / past) : whole;
        } else {
            rest = std::max(-past, 0.0) + std::min(1 / ray_.thickness, ray_.end - p.y);
        }
        return std::exp(-depth(p)) * rest <= kNegligible * sum_;
    }

    SlabRay ray_;
    QuadratureRule rule_;
    double toward_;  // 1 + g
    double away_;    // 1 - g
    double y_ = 0;
    double sum_ = 0;
};

}  // namespace

double slab_angle(double g, double end, double beyond) {
    const double q = std::sqrt((1 - g) * (1 + g));
    if (std::isinf(end)) {
        if (q > 0) return std::atan2(q, g) / q;
        return g > 0 ? 1 : kInfinity;
    }
    // 1 + g S
    const double along = g < 0 ? (1 + g) * end - beyond : 1 + g * end;
    if (along > 0 && q * end < 1e-9 * along) return end / along;
    return q > 0 ? std::atan2(q * end, along) / q : kInfinity;
}

double slab_integral(const SlabRay& ray, int nodes) {
    return SlabSum(ray, gauss_legendre(nodes)).run();
}

}  // namespace detail
}  // namespace airlight
