// SPDX-License-Identifier: Apache-2.0
#include "sh/quadrature.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr int kLanes = 8;

template <class Real>
using Lanes = std::array<Real, kLanes>;

PolarRule empty_rule(int n) {
    const auto size = static_cast<std::size_t>(n);
    return {std::vector<double>(size), std::vector<double>(size), std::vector<double>(size),
            std::vector<double>(size)};
}

// McMahon's k-th positive zero of J_0, 5e-5 off at k = 1 and better after.
double bessel_zero_guess(int k) {
    const double b = (k - 0.25) * kPi;
    const double e = 1 / (8 * b);
    const double e2 = e * e;
    return b + e * (1 - e2 * (124.0 / 3 - e2 * (120928.0 / 15)));
}

double gauss_angle_guess(int n, int k) {
    // The middle node of an odd rule is known; Newton leaves it where it is.
    if (2 * k - 1 == n) return kPi / 2;
    const double kappa = n + 0.5;
    const double a = bessel_zero_guess(k) / kappa;
    return a + (a / std::tan(a) - 1) / (8 * a * kappa * kappa);
}

template <class Real>
struct NewtonStep {
    Lanes<Real> step;   // -P_n / P_n'
    Lanes<Real> slope;  // P_n' = d P_n(cos t) / dt
};

// P_n at cos t from delta = 1 - cos t = 2 sin^2(t/2), in the difference form whose rounding does
// not grow like n^2 beside the pole as that of the three-term recurrence does.
template <class Real>
NewtonStep<Real> newton_step(const std::vector<Real>& ratio, const Lanes<double>& angle) {
    Lanes<Real> delta, p, difference;
    p.fill(1);
    difference.fill(0);
    for (int i = 0; i < kLanes; ++i) {
        const Real s = std::sin(Real(angle[i]) / 2);
        delta[i] = 2 * s * s;
    }
    for (const Real r : ratio) {
        for (int i = 0; i < kLanes; ++i) {
            difference[i] = r * difference[i] - (1 + r) * delta[i] * p[i];
            p[i] += difference[i];
        }
    }
    NewtonStep<Real> result;
    for (int i = 0; i < kLanes; ++i) {
        const Real n = static_cast<Real>(ratio.size());
        result.slope[i] = n * (difference[i] - delta[i] * p[i]) / std::sin(Real(angle[i]));
        result.step[i] = -p[i] / result.slope[i];
    }
    return result;
}

// l / (l + 1) for l = 0 ... n - 1.
template <class Real>
std::vector<Real> recurrence_ratios(int n) {
    std::vector<Real> ratio(static_cast<std::size_t>(n));
    for (int l = 0; l < n; ++l) ratio[static_cast<std::size_t>(l)] = l / (l + Real(1));
    return ratio;
}

}  // namespace

PolarRule gauss_legendre(int n) {
    assert(n >= 1);
    PolarRule rule = empty_rule(n);
    const std::vector<double> ratio = recurrence_ratios<double>(n);
    const std::vector<long double> fine_ratio = recurrence_ratios<long double>(n);

    const int half = (n + 1) / 2;
    for (int first = 0; first < half; first += kLanes) {
        Lanes<double> angle;
        for (int i = 0; i < kLanes; ++i) {
            angle[i] = gauss_angle_guess(n, std::min(first + i, half - 1) + 1);
        }
        for (bool close = false; !close;) {
            const NewtonStep<double> newton = newton_step(ratio, angle);
            close = true;
            for (int i = 0; i < kLanes; ++i) {
                angle[i] += newton.step[i];
                // What is left is under cot(t)/2 times the square of the step: for the last one.
                close = close && std::abs(newton.step[i]) < 1e-6 * angle[i];
            }
        }
        // The last step and the slope in extended precision, where the platform has it, as the
        // rounding of n recurrence steps would cost the weights up to 1e-14.
        const NewtonStep<long double> last = newton_step(fine_ratio, angle);
        for (int i = 0; i < kLanes && first + i < half; ++i) {
            const auto low = static_cast<std::size_t>(first + i);
            const auto high = static_cast<std::size_t>(n - 1) - low;
            // Every result at angle + step without rounding that sum first; P'' = -cot(t) P' there.
            const auto t = static_cast<double>(last.step[i]);
            const double c = std::cos(angle[i]), s = std::sin(angle[i]);
            const double slope = static_cast<double>(last.slope[i]) * (1 - c / s * t);
            rule.angle[low] = angle[i] + t;
            rule.cosine[low] = c - t * s;
            rule.cosine[high] = -rule.cosine[low];
            if (low == high) rule.cosine[low] = 0;
            rule.sine[low] = rule.sine[high] = s + t * c;
            rule.weight[low] = rule.weight[high] = 2 / (slope * slope);
            if (low != high) rule.angle[high] = kPi - rule.angle[low];
        }
    }
    return rule;
}

PolarRule fejer_rows(int rows) {
    assert(rows >= 1);
    PolarRule rule = empty_rule(rows);
    const auto period = 2 * static_cast<std::size_t>(rows);
    std::vector<double> sine_squared(period);  // sin^2(i pi / (2 rows)), of period 2 rows
    for (std::size_t i = 0; i <= period / 2; ++i) {
        const std::size_t mirror = period - i;
        const double s = std::sin(kPi * static_cast<double>(i) / static_cast<double>(period));
        sine_squared[i] = s * s;
        if (mirror < period) sine_squared[mirror] = s * s;
    }
    const int terms = rows / 2;
    for (int j = 0; 2 * j < rows; ++j) {
        const auto low = static_cast<std::size_t>(j);
        const auto high = static_cast<std::size_t>(rows - 1) - low;
        double sum = 0;
        // Smallest terms first.
        for (int k = terms; k >= 1; --k) {
            const std::size_t phase = static_cast<std::size_t>(k) * (2 * low + 1) % period;
            sum += sine_squared[phase] / (4.0 * k * k - 1);
        }
        const double angle = (j + 0.5) * kPi / rows;
        const double weight = 2.0 / rows * (1 / (2.0 * terms + 1) + 4 * sum);
        rule.angle[low] = angle;
        rule.angle[high] = (rows - 1 - j + 0.5) * kPi / rows;
        rule.cosine[low] = std::cos(angle);
        rule.cosine[high] = -rule.cosine[low];
        if (low == high) rule.cosine[low] = 0;
        rule.sine[low] = rule.sine[high] = std::sin(angle);
        rule.weight[low] = rule.weight[high] = weight;
    }
    return rule;
}

}  // namespace airlight
