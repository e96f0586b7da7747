// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_table.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "medium/quadrature.h"
#include "medium/ray_integral.h"

namespace airlight {
namespace {

// A cubic times a sine over half a turn at most: twelve nodes reach rounding.
template <class F>
double integrate(double a, double b, const F& f) {
    const detail::QuadratureRule rule = detail::gauss_legendre(12);
    const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        const double offset = half * rule.nodes[i].x;
        sum += rule.nodes[i].w * (f(centre + offset) + f(centre - offset));
    }
    return half * sum;
}

void check(const std::vector<double>& angles, const std::vector<double>& values) {
    if (angles.size() != values.size() || angles.size() < 2) {
        throw Error(ErrorCode::data,
                    "a phase table needs two or more angles and as many values, "
                    "not " +
                        std::to_string(angles.size()) + " and " + std::to_string(values.size()));
    }
    bool all_zero = true;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const std::string entry = " of phase table entry " + std::to_string(i);
        if (std::isnan(detail::checked_angle(angles[i]))) {
            throw Error(ErrorCode::data,
                        "angle " + std::to_string(angles[i]) + entry + " is not in [0, pi]");
        }
        if (i > 0 && !(angles[i] > angles[i - 1])) {
            throw Error(ErrorCode::data, "angle " + std::to_string(angles[i]) + entry +
                                             " is not above the one before it");
        }
        if (!(values[i] >= 0 && std::isfinite(values[i]))) {
            throw Error(ErrorCode::data, "value " + std::to_string(values[i]) + entry +
                                             " is not a finite number >= 0");
        }
        all_zero = all_zero && values[i] == 0;
    }
    if (all_zero) throw Error(ErrorCode::data, "all values of the phase table are 0");
}

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
    const std::size_t n = x.size();
    std::vector<double> slopes(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        const double rise = (y[i] - y[i - 1]) / before, next = (y[i + 1] - y[i]) / after;
        if (!(rise * next > 0)) continue;
        const double share = (before + 2 * after) / (3 * (before + after));
        slopes[i] = 1 / (share / rise + (1 - share) / next);
    }
    return slopes;
}

}  // namespace

PhaseTable::PhaseTable(const std::vector<double>& angles, const std::vector<double>& values,
                       PhaseInterpolation interpolation) {
    check(angles, values);
    knots_ = angles;
    // Relative to the largest, so that no sum overflows or vanishes.
    const double largest = *std::max_element(values.begin(), values.end());
    std::vector<double> y;
    for (const double value : values) y.push_back(value / largest);
    knots_.back() = detail::checked_angle(knots_.back());
    if (knots_.front() > 0) {
        knots_.insert(knots_.begin(), 0);
        y.insert(y.begin(), y.front());
    }
    if (knots_.back() < kPi) {
        knots_.push_back(kPi);
        y.push_back(y.back());
    }
    if (knots_[knots_.size() - 2] >= kPi) {
        throw Error(ErrorCode::data, "two angles of the phase table round to pi");
    }
    std::vector<double> slopes(y.size());
    if (interpolation == PhaseInterpolation::monotone) slopes = monotone_slopes(knots_, y);
    for (std::size_t k = 0; k + 1 < y.size(); ++k) {
        const double rise = y[k + 1] - y[k];
        if (interpolation == PhaseInterpolation::linear) {
            cubics_.push_back({y[k], rise, 0, 0});
            continue;
        }
        // Slopes are at most three times a neighbour's; that decides where they overflow.
        const double width = knots_[k + 1] - knots_[k], most = 3 * std::fabs(rise);
        const double left = std::clamp(slopes[k] * width, -most, most);
        const double right = std::clamp(slopes[k + 1] * width, -most, most);
        cubics_.push_back({y[k], left, 3 * rise - 2 * left - right, left + right - 2 * rise});
    }
    below_.push_back(0);
    double moment = 0;
    for (std::size_t k = 0; k < cubics_.size(); ++k) {
        below_.push_back(below_.back() + part(k, knots_[k + 1]));
        moment += integrate(knots_[k], knots_[k + 1], [&](double angle) {
            return kPi * std::sin(2 * angle) * density(angle, k);
        });
    }
    const double total = below_.back();
    if (!(total > 0)) throw Error(ErrorCode::data, "the phase table's integral is 0");
    for (Cubic& c : cubics_) c = {c.a / total, c.b / total, c.c / total, c.d / total};
    for (double& part : below_) part /= total;
    mean_cosine_ = moment / total;
}

std::size_t PhaseTable::interval(double angle) const {
    const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, angle);
    return static_cast<std::size_t>(above - knots_.begin()) - 1;
}

double PhaseTable::part(std::size_t k, double angle) const {
    return integrate(knots_[k], angle,
                     [&](double a) { return 2 * kPi * std::sin(a) * density(a, k); });
}

double PhaseTable::quantile(double xi) const {
    if (xi <= 0) return 0;
    if (xi >= 1) return kPi;
    const auto above = std::upper_bound(below_.begin() + 1, below_.end() - 1, xi);
    const std::size_t k = static_cast<std::size_t>(above - below_.begin()) - 1;
    const double wanted = xi - below_[k];
    // Newton's method, kept within a bracket that halves where it would leave.
    double low = knots_[k], high = knots_[k + 1], angle = 0.5 * (low + high);
    for (int i = 0; i < 100; ++i) {
        const double excess = part(k, angle) - wanted;
        (excess > 0 ? high : low) = angle;
        const double slope = 2 * kPi * std::sin(angle) * density(angle, k);
        double next = angle - excess / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == angle || std::fabs(next - angle) <= 1e-16 * angle) return next;
        angle = next;
    }
    return angle;
}

}  // namespace airlight
