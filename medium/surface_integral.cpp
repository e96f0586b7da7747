// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_integral.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/constants.h"
#include "medium/ray_integral.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kHalfPi = 0.5 * kPi;
constexpr double kLogarithmic = 1e17;
constexpr double kNarrowLobe = 16;
constexpr double kSmoothLobe = 20;
constexpr double kSmoothKink = 24;
// Logarithms of the parts of the lobe's peak that are not looked at, and where ranges end.
constexpr double kUnseen = -43;
constexpr double kEndOfLobe = -48;

// Tanh-sinh nodes on [0, 1] with their distances from both ends.
struct Node {
    double left, right, weight;
};
constexpr int kNodesPerSide = 130;
constexpr double kNodeStep = 0.025;

const std::array<Node, 2 * kNodesPerSide + 1>& tanh_sinh_nodes() {
    static const auto kNodes = [] {
        std::array<Node, 2 * kNodesPerSide + 1> nodes;
        for (int j = -kNodesPerSide; j <= kNodesPerSide; ++j) {
            const double t = j * kNodeStep, u = kPi * std::sinh(t);
            const double left = 1 / (1 + std::exp(-u)), right = 1 / (1 + std::exp(u));
            nodes[j + kNodesPerSide] = {left, right, kNodeStep * kPi * std::cosh(t) * left * right};
        }
        return nodes;
    }();
    return kNodes;
}

class Integral {
  public:
    Integral(double t, double theta, const LobeRing& ring, int fineness)
        : t_(t),
          theta_(theta),
          ring_(ring),
          n_(ring.exponent()),
          fineness_(fineness),
          front_(theta <= kHalfPi),
          delta_(std::abs(kHalfPi - theta)),
          opposite_(kPi - delta_),
          unit_(1 / std::max(1.0, t)) {}

    double value() const {
        double lo = front_ ? 0 : delta_, hi = front_ ? opposite_ : kPi;
        if (n_ >= kNarrowLobe) {
            const double window = std::acos(std::exp(kEndOfLobe / n_));
            lo = std::max(lo, theta_ - window);
            hi = std::min(hi, theta_ + window);
            if (n_ >= kSmoothLobe && lo > 0 && hi < kPi) return trapezoids();
        }
        std::array<double, 6> cuts;
        int count = 0;
        cuts[count++] = lo;
        const double kink = front_ ? delta_ : opposite_;
        if (n_ < kSmoothKink && kink > lo && kink < hi) cuts[count++] = kink;
        if (n_ >= kNarrowLobe && lo == 0 && theta_ > 0) cuts[count++] = 0.5 * theta_;
        cuts[count++] = hi;
        std::sort(cuts.begin(), cuts.begin() + count);
        double sum = 0;
        for (int i = 0; i + 1 < count; ++i) {
            const double from = cuts[i], to = cuts[i + 1];
            // Most of a long logarithmic range is a plateau; the lobe lies at its end.
            if (length(from, to) > 3 && to / 8 > from) {
                sum += tanh_sinh(from, to / 8) + tanh_sinh(to / 8, to);
            } else if (to > from) {
                sum += tanh_sinh(from, to);
            }
        }
        return sum;
    }

  private:
    double length(double from, double to) const { return std::log1p((to - from) / (from + unit_)); }

    // The integrand at gamma = `from` + step; what vanishes at `from` is formed from the step.
    double at(double from, double step) const {
        double log_p, p;
        if (n_ < kNarrowLobe) {
            p = std::sin(front_ ? (opposite_ - from) - step : (from - delta_) + step);
            if (!(p > 0)) return 0;
            log_p = std::log(p);
        } else {
            // Relative to the peak, where n ulps of p would show.
            const double s = std::sin(0.5 * ((from - theta_) + step));
            log_p = std::log1p(-2 * s * s);
            p = 1 - 2 * s * s;
        }
        if (!(n_ * log_p > kUnseen)) return 0;
        const double m = std::sin(front_ ? (delta_ - from) - step : (from - opposite_) + step);
        const RayAngle angle = ray_angle(from + step);
        const double h = infinite_ray_integral(2 * t_ * angle.cos_theta, angle);
        return h * angle.sin_theta * std::exp(n_ * log_p) * ring_(std::min(1.0, m / p));
    }

    double trapezoids() const {
        const double step = 0.55 / (std::sqrt(n_) * fineness_);
        const int last = static_cast<int>(std::acos(std::exp(kUnseen / n_)) / step);
        double sum = 0;
        for (int j = -last; j <= last; ++j) sum += at(theta_, j * step);
        return sum * step;
    }

    double tanh_sinh(double from, double to) const {
        const double range = length(from, to);
        const int stride = (n_ < 3 && range < 6 ? 4 : 2) / fineness_;
        const auto& nodes = tanh_sinh_nodes();
        double sum = 0;
        for (int j = kNodesPerSide % stride; j < static_cast<int>(nodes.size()); j += stride) {
            const Node& node = nodes[j];
            // From the end that is closer, in the logarithm or in the angle itself.
            if (node.left < 0.5 || range * node.right > 1) {
                const double step = (from + unit_) * std::expm1(range * node.left);
                sum += node.weight * (from + unit_ + step) * at(from, step);
            } else {
                const double step = (to + unit_) * std::expm1(-range * node.right);
                sum += node.weight * (to + unit_ + step) * at(to, step);
            }
        }
        return sum * range * stride;
    }

    double t_, theta_;
    const LobeRing& ring_;
    double n_;
    int fineness_;
    bool front_;  // the source is on the lit side
    double delta_, opposite_;
    double unit_;  // scale of the logarithmic variable
};

}  // namespace

double surface_integral(double t, double theta, const LobeRing& ring, int fineness) {
    assert(t >= 0 && std::isfinite(t) && theta >= 0 && theta <= kPi);
    assert(fineness == 1 || fineness == 2);
    if (t <= kLogarithmic) return Integral(t, theta, ring, fineness).value();
    const double constant = kLogarithmic * Integral(kLogarithmic, theta, ring, fineness).value();
    const double cosine = std::max(0.0, std::cos(theta));
    const double slope = 2 * kPi * std::pow(cosine, ring.exponent());
    return (constant + slope * std::log(t / kLogarithmic)) / t;
}

}  // namespace detail
}  // namespace airlight
