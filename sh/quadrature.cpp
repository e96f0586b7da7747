// SPDX-License-Identifier: Apache-2.0
#include "sh/quadrature.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace airlight {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLanes = 8;

using Lanes = std::array<double, kLanes>;

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
    const double kappa = n + 0.5;
    const double a = bessel_zero_guess(k) / kappa;
    return a + (a / std::tan(a) - 1) / (8 * a * kappa * kappa);
}

// P_n and P_n - P_{n-1} at cos t, delta = 1 - cos t = 2 sin^2(t/2), in the difference form whose
// rounding does not grow like n^2 beside the pole as that of the three-term recurrence does.
void legendre_lanes(int n, const std::vector<double>& ratio, const Lanes& delta, Lanes& p,
                    Lanes& difference) {
    p.fill(1);
    difference.fill(0);
    for (int l = 0; l < n; ++l) {
        const double r = ratio[static_cast<std::size_t>(l)];
        for (int i = 0; i < kLanes; ++i) {
            difference[i] = r * difference[i] - (1 + r) * delta[i] * p[i];
            p[i] += difference[i];
        }
    }
}

}  // namespace

PolarRule gauss_legendre(int n) {
    assert(n >= 1);
    PolarRule rule = empty_rule(n);
    std::vector<double> ratio(static_cast<std::size_t>(n));  // l / (l + 1)
    for (int l = 0; l < n; ++l) ratio[static_cast<std::size_t>(l)] = l / (l + 1.0);

    const int half = (n + 1) / 2;
    for (int first = 0; first < half; first += kLanes) {
        Lanes angle, delta, p, difference, step, slope;
        for (int i = 0; i < kLanes; ++i) {
            const int k = std::min(first + i, half - 1) + 1;
            // The middle node of an odd rule is known; Newton leaves it where it is.
            angle[i] = 2 * k - 1 == n ? kPi / 2 : gauss_angle_guess(n, k);
        }
        for (int iteration = 0; iteration < 8; ++iteration) {
            for (int i = 0; i < kLanes; ++i) {
                const double s = std::sin(angle[i] / 2);
                delta[i] = 2 * s * s;
            }
            legendre_lanes(n, ratio, delta, p, difference);
            bool close = true;
            for (int i = 0; i < kLanes; ++i) {
                slope[i] = n * (difference[i] - delta[i] * p[i]) / std::sin(angle[i]);
                step[i] = -p[i] / slope[i];
                // The next step would be cot(t)/2 times this one squared: nothing.
                close = close && std::abs(step[i]) < 1e-9 * angle[i];
            }
            if (close) break;
            for (int i = 0; i < kLanes; ++i) angle[i] += step[i];
        }
        for (int i = 0; i < kLanes && first + i < half; ++i) {
            const auto low = static_cast<std::size_t>(first + i);
            const auto high = static_cast<std::size_t>(n - 1) - low;
            // cos and sin of angle + step, without rounding the sum first; so is the weight, whose
            // slope changes by the factor 1 - cot(t) step.
            const double c = std::cos(angle[i]), s = std::sin(angle[i]);
            const double middle = low == high ? 0 : 1;
            const double t = step[i];
            rule.angle[low] = angle[i] + t;
            rule.cosine[low] = middle * (c - t * (s + t * c / 2));
            rule.sine[low] = s + t * (c - t * s / 2);
            const double end_slope = slope[i] * (1 - c / s * t);
            rule.weight[low] = 2 / (end_slope * end_slope);
            if (low == high) continue;
            rule.angle[high] = kPi - rule.angle[low];
            rule.cosine[high] = -rule.cosine[low];
            rule.sine[high] = rule.sine[low];
            rule.weight[high] = rule.weight[low];
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
        rule.cosine[low] = low == high ? 0 : std::cos(angle);
        rule.cosine[high] = -rule.cosine[low];
        rule.sine[low] = rule.sine[high] = std::sin(angle);
        rule.weight[low] = rule.weight[high] = weight;
    }
    return rule;
}

}  // namespace airlight
