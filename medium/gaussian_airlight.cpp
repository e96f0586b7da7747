// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_airlight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// A panel whose logarithm spans more is not resolved; one that far below the largest is nothing.
constexpr double kResolvedSpan = 30;
constexpr double kNothing = 50;

/// The upper half of the Gauss-Kronrod pair on [-1, 1].
struct PairNode {
    double x, kronrod, gauss;
};
constexpr PairNode kPair[] = {
    {0.0, 0.20948214108472782801, 0.41795918367346938776},
    {0.2077849550078984676, 0.20443294007529889241, 0.0},
    {0.40584515137739716691, 0.19035057806478540991, 0.38183005050511894495},
    {0.58608723546769113029, 0.16900472663926790283, 0.0},
    {0.74153118559939443986, 0.14065325971552591875, 0.2797053914892766679},
    {0.86486442335976907279, 0.10479001032225018384, 0.0},
    {0.94910791234275852453, 0.063092092629978553291, 0.12948496616886969327},
    {0.99145537112081263921, 0.022935322010529224964, 0.0},
};

/// A stretch of the ray on one side of the light's foot, in q = asinh(|x| / h) counted from its
/// point nearest to the foot; dt / d^2 = dq / d.
struct Panel {
    double x_near;   ///< |x| at its near end
    double d_near;   ///< distance from the light there
    double side;     ///< -1 before the foot, 1 behind it
    double q_begin;  ///< from the near end
    double q_end;
    double log_scale = 0;  ///< the integral is value exp(log_scale)
    double value = 0;
    double error = 0;
    double log_span = 0;
};

class Quadrature {
  public:
    explicit Quadrature(const detail::GaussianRay& ray) : ray_(ray) {}

    void add(double x_from, double x_to) {
        if (!(x_from < x_to)) return;
        Panel panel;
        panel.side = x_from < 0 ? -1 : 1;
        const double h = ray_.height();
        const double near = std::min(std::abs(x_from), std::abs(x_to));
        const double far = std::max(std::abs(x_from), std::abs(x_to));
        panel.x_near = near;
        panel.d_near = std::hypot(near, h);
        const double d_far = std::hypot(far, h);
        const double longer = (far - near) * (1 + (far + near) / (panel.d_near + d_far));
        panel.q_begin = 0;
        panel.q_end = std::log1p(longer / (near + panel.d_near));
        if (!(panel.q_end > 0)) return;
        evaluate(panel);
        panels_.push_back(panel);
    }

    double integral(const GaussianAirlightOptions& options) {
        while (true) {
            double largest = -kInfinity;
            for (const Panel& panel : panels_) largest = std::max(largest, panel.log_scale);
            if (std::isinf(largest)) return 0;
            double sum = 0;
            for (const Panel& panel : panels_) {
                sum += panel.value * std::exp(panel.log_scale - largest);
            }
            const auto to_split = [&](const Panel& panel) {
                if (panel.log_scale < largest - kNothing) return false;
                return panel.log_span > kResolvedSpan ||
                       panel.error * std::exp(panel.log_scale - largest) >
                           0.05 * options.tolerance * sum;
            };
            std::vector<Panel> halves;
            std::size_t kept = 0;
            const std::size_t count = panels_.size();
            for (std::size_t i = 0; i < count; ++i) {
                const Panel panel = panels_[i];
                const double middle = 0.5 * (panel.q_begin + panel.q_end);
                const bool full = kept + halves.size() + (count - i) >=
                                  static_cast<std::size_t>(std::max(options.most_panels, 1));
                if (full || !(panel.q_begin < middle && middle < panel.q_end) || !to_split(panel)) {
                    panels_[kept++] = panel;
                    continue;
                }
                Panel lower = panel, upper = panel;
                lower.q_end = upper.q_begin = middle;
                evaluate(lower);
                evaluate(upper);
                halves.push_back(lower);
                halves.push_back(upper);
            }
            if (halves.empty()) return sum * std::exp(largest);
            panels_.resize(kept);
            panels_.insert(panels_.end(), halves.begin(), halves.end());
        }
    }

  private:
    /// log of beta exp(-T(v, x) - T(x, s)) / d, the integrand in q.
    double log_integrand(const Panel& panel, double q) const {
        const double h = ray_.height();
        const double sum = panel.x_near + panel.d_near;
        const double beyond = 0.5 * (sum * std::expm1(q) - h * (h / sum) * std::expm1(-q));
        const double x = panel.side * (panel.x_near + beyond);
        const double t = std::max(ray_.foot() + x, 0.0);
        const double d = std::hypot(x, h);
        return ray_.log_density(t) - ray_.view_depth(t) - ray_.light_depth(x, d) - std::log(d);
    }

    void evaluate(Panel& panel) const {
        const double half = 0.5 * (panel.q_end - panel.q_begin);
        const double middle = panel.q_begin + half;
        constexpr int kNodes = 15;
        double logs[kNodes + 2];
        logs[0] = log_integrand(panel, middle);
        for (int i = 1; i < 8; ++i) {
            logs[2 * i - 1] = log_integrand(panel, middle - half * kPair[i].x);
            logs[2 * i] = log_integrand(panel, middle + half * kPair[i].x);
        }
        logs[kNodes] = log_integrand(panel, panel.q_begin);
        logs[kNodes + 1] = log_integrand(panel, panel.q_end);
        const auto [low, high] = std::minmax_element(logs, logs + kNodes + 2);
        panel.log_scale = *high;
        panel.log_span = *high - *low;
        panel.value = panel.error = 0;
        if (std::isinf(*high)) {
            panel.log_span = 0;
            return;
        }
        double f[kNodes], gauss = 0;
        for (int i = 0; i < kNodes; ++i) {
            const PairNode& node = kPair[(i + 1) / 2];
            f[i] = std::exp(logs[i] - *high);
            panel.value += node.kronrod * f[i];
            gauss += node.gauss * f[i];
        }
        // The error estimate of QUADPACK: the rules' difference against the integrand's variation.
        double variation = 0;
        for (int i = 0; i < kNodes; ++i) {
            variation += kPair[(i + 1) / 2].kronrod * std::abs(f[i] - 0.5 * panel.value);
        }
        const double difference = std::abs(panel.value - gauss);
        panel.error = difference;
        if (variation > 0) {
            panel.error = variation * std::min(1.0, std::pow(200 * difference / variation, 1.5));
        }
        panel.value *= half;
        panel.error *= half;
    }

    const detail::GaussianRay& ray_;
    std::vector<Panel> panels_;
};

/// Breakpoints of t: around every blob's density on the ray, in its own width there and as far out
/// as it can be seen over the uniform part (a rule that spans more would not see it), where the
/// viewer's sight ends in a dense medium, and around the light in units of its distance.
std::vector<double> breakpoints(const detail::GaussianRay& ray, double end) {
    std::vector<double> points = {0, end};
    for (const auto& blob : ray.blobs()) {
        const double peak = std::clamp(blob.m, 0.0, end);
        const double outside = blob.a * std::abs(peak - blob.m);
        const double width = 1 / (blob.a * std::max(1.0, 2 * outside));
        for (const double at : {-7.0, -3.5, -1.5, 0.0, 1.5, 3.5, 7.0})
            points.push_back(peak + at * width);
        // A tail falls like an exponential, and not so soon.
        if (outside < 0.5) continue;
        for (const double at : {-40.0, -16.0, 16.0, 40.0}) points.push_back(peak + at * width);
    }
    if (ray.view_depth(end) > 8) {
        for (const double depth : {1.0, 8.0}) points.push_back(ray.distance_of_depth(depth, end));
    }
    points.push_back(ray.foot());
    for (const double at : {-3.0, 3.0}) points.push_back(ray.foot() + at * ray.height());
    points.erase(std::remove_if(points.begin(), points.end(),
                                [end](double t) { return !(t >= 0 && t <= end); }),
                 points.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

}  // namespace

double gaussian_airlight(const GaussianMedium& medium, const AirlightRay& ray,
                         const GaussianAirlightOptions& options) {
    const detail::GaussianRay through(medium, ray.viewer, ray.light, ray.direction);
    if (!through.valid() || !(ray.dist >= 0)) return kNan;
    if (ray.dist == 0 || (through.blobs().empty() && through.beta0() == 0)) return 0;
    const double foot = through.foot();
    if (through.height() == 0 && foot >= 0 && foot <= ray.dist) return kInfinity;
    const double end = std::min(ray.dist, through.last_distance());
    Quadrature quadrature(through);
    const std::vector<double> points = breakpoints(through, end);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        quadrature.add(points[i] - foot, points[i + 1] - foot);
    }
    return quadrature.integral(options) / (4 * kPi);
}

}  // namespace airlight
