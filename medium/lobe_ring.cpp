// SPDX-License-Identifier: Apache-2.0
#include "medium/lobe_ring.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/constants.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kFirstPowerSeries = 3;
constexpr double kLastPowerSeries = 24;
// Terms and nodes below this part of the sum are left out.
constexpr double kNegligible = 1e-17;
constexpr int kMostSamples = 256;
constexpr int kMostTerms = 240;

// sin^2(pi j / kMostSamples), j = 0 ... kMostSamples / 2.
const std::array<double, kMostSamples / 2 + 1>& squared_sines() {
    static const auto kTable = [] {
        std::array<double, kMostSamples / 2 + 1> table;
        for (int j = 0; j <= kMostSamples / 2; ++j) {
            const double sine = std::sin(kPi * j / kMostSamples);
            table[j] = sine * sine;
        }
        return table;
    }();
    return kTable;
}

// 1 - 1/k, for the recurrence of the Legendre polynomials.
const std::array<double, kMostTerms>& legendre_steps() {
    static const auto kTable = [] {
        std::array<double, kMostTerms> table{};
        for (int k = 1; k < kMostTerms; ++k) table[k] = 1 - 1.0 / k;
        return table;
    }();
    return kTable;
}

// The closed form for n = 1, 2 ((1 - r) atan(1 / sqrt r) + sqrt r), cancels for a short arc.
double arc_of_cosine(double r) {
    const double x = 1 / std::sqrt(r);
    if (x > 0.3) return 2 * ((1 - r) * std::atan(x) + std::sqrt(r));
    double sum = 0, power = x;
    for (int k = 1; power > kNegligible * sum; k += 4) {
        sum += power * (1.0 / k + 1.0 / (k + 2));
        power *= x * x;
        sum -= power * (1.0 / (k + 2) + 1.0 / (k + 4));
        power *= x * x;
    }
    return 2 * sum;
}

}  // namespace

LobeRing::LobeRing(double exponent) : n_(exponent) {
    assert(exponent >= 1 && exponent <= 1000);
    if (n_ == 1) return;
    // With this step the rule's error on the weight alone, 2 |Gamma(q/2 + i pi/h)|^2 / Gamma(q/2)^2
    // with q = 2n+1, is under 2e-16 for every n.
    const double power = 2 * n_ + 1;
    const double step = 1 / std::sqrt(1.87 * power + 20.5);
    for (int j = 0; j < static_cast<int>(arc_square_.size()); ++j) {
        const double sine = std::sinh(j * step);
        const double square = sine * sine;
        const double weight = std::exp(-0.5 * power * std::log1p(square));
        // 0.3 stands for the thinner tail with k' = 0: nothing divides it.
        if (weight < 0.3 * kNegligible) break;
        arc_square_[j] = square;
        arc_weight_[j] = 4 * step * (j == 0 ? 0.5 : 1.0) * weight;
        arc_nodes_ = j + 1;
    }
    if (n_ > kLastPowerSeries) return;
    const bool power_series = n_ >= kFirstPowerSeries;
    double term = power_series ? 1.0 : std::exp(std::lgamma(2 * n_ + 2) - 2 * std::lgamma(n_ + 2));
    double sum = 0;
    for (int k = 0; k < static_cast<int>(coefficient_.size()); ++k) {
        coefficient_[k] = term;
        terms_ = k + 1;
        sum += term;
        const double ratio = power_series ? (n_ - k) / (k + 1) : (n_ - k) / (n_ + k + 2);
        term *= ratio * ratio;
        if (!power_series) term *= (2 * k + 3.0) / (2 * k + 1.0);
        // The rest is worth k / (2n+1) and k / (4n+2) terms.
        if (k > n_ && term * k < 1e-15 * sum) break;
    }
}

double LobeRing::arc(double r) const {
    if (n_ == 1) return arc_of_cosine(r);
    const double complement = r / (1 + r);
    double sum = 0;
    for (int j = 0; j < arc_nodes_; ++j) {
        sum += arc_weight_[j] / std::sqrt(1 + complement * arc_square_[j]);
    }
    return sum / std::sqrt(1 + r);
}

double LobeRing::circle(double ratio) const {
    if (n_ == 1) return kPi * (1 + ratio);
    if (n_ > kLastPowerSeries) return trapezoids(ratio);
    const double root = std::sqrt(ratio);
    const double z = (1 - root) / (1 + root);
    const double sum = n_ >= kFirstPowerSeries ? power_sum(z * z) : legendre_sum(z * z);
    return 2 * kPi * std::pow(0.5 * (1 + root), 2 * n_) * sum;
}

double LobeRing::power_sum(double zeta) const {
    double sum = coefficient_[terms_ - 1];
    for (int k = terms_ - 2; k >= 0; --k) sum = sum * zeta + coefficient_[k];
    return sum;
}

double LobeRing::legendre_sum(double zeta) const {
    const double x = 2 * zeta - 1;
    const auto& step = legendre_steps();
    double previous = 1, current = x;
    double sum = coefficient_[0] + coefficient_[1] * x;
    for (int k = 2; k < terms_; ++k) {
        const double next = current * x + (current * x - previous) * step[k];
        previous = current;
        current = next;
        sum += coefficient_[k] * current;
    }
    return sum;
}

double LobeRing::trapezoids(double ratio) const {
    const double m = 1 - ratio;
    // The Fourier coefficients fall like those of e^{x cos phi}, I_j(x), or faster.
    const double x = 0.5 * n_ * m;
    const double wanted = std::sqrt(80 * x) + 16;
    int samples = 16;
    while (samples < wanted && samples < kMostSamples) samples *= 2;
    const int stride = kMostSamples / samples;
    const auto& square = squared_sines();
    double sum = 0.5;
    for (int j = stride; j <= kMostSamples / 2; j += stride) {
        const double value = std::exp(n_ * std::log1p(-m * square[j]));
        if (value < kNegligible) break;
        sum += j < kMostSamples / 2 ? value : 0.5 * value;
    }
    return 4 * kPi / samples * sum;
}

}  // namespace detail
}  // namespace airlight
