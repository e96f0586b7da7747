// SPDX-License-Identifier: Apache-2.0
#include "envmap/phase_singularity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/constants.h"
#include "sh/quadrature.h"

namespace airlight {
namespace {

constexpr int kTerms = 28;
// Coefficients b_j that the tails of the moments take, at 1 / kReach^2 each.
constexpr int kTailTerms = 90;
constexpr double kReach = 1.3;

// Coefficients of (1 + c w)^power.
std::vector<double> binomial(double c, double power) {
    std::vector<double> series = {1};
    for (int k = 1; k < kTailTerms; ++k) {
        series.push_back(series.back() * c * (power - (k - 1)) / k);
    }
    return series;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size(), 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; i + j < a.size(); ++j) result[i + j] += a[i] * b[j];
    }
    return result;
}

// b_j.
std::vector<double> tail_series(const PhaseFunction& phase, double ratio) {
    std::vector<double> series;
    double factor = 0;
    if (phase.kind() == PhaseKind::rayleigh) {
        std::vector<double> square(kTailTerms, 0.0);
        square[0] = square[2] = 1;
        series = product(square, binomial(1, -3));
        factor = 3 / (4 * kPi);
    } else {
        const double g = phase.g(), sum = 1 + g;
        series = product(binomial(1, 0.5), binomial(ratio * ratio, -1.5));
        factor = (1 - g) / (2 * kPi * sum * sum);
    }
    for (double& b : series) b *= factor;
    return series;
}

}  // namespace

std::optional<PhaseSingularity> PhaseSingularity::of(const PhaseFunction& phase) {
    if (phase.kind() != PhaseKind::rayleigh && phase.kind() != PhaseKind::henyey_greenstein) {
        return std::nullopt;
    }
    // G has its singularities at u = +-i and +-i ratio.
    const double ratio = (1 - phase.g()) / (1 + phase.g());
    const double reach = std::max(1.0, ratio);
    const std::vector<double> b = tail_series(phase, ratio);
    std::vector<double> moments(kTerms, 0.0);
    const PolarRule rule = gauss_legendre(20);
    const double end = kReach * reach, first = 0.25 * std::min(1.0, ratio);
    for (double from = 0; from < end;) {
        const double to = std::min(end, std::max(first, 1.5 * from));
        for (std::size_t i = 0; i < rule.weight.size(); ++i) {
            const double u = from + 0.5 * (to - from) * (1 + rule.cosine[i]);
            double term = 0.5 * (to - from) * rule.weight[i] * 2 / (1 + u * u) *
                          phase.at_angle(2 * std::atan(u));
            for (double& moment : moments) {
                moment += term;
                term *= u * u;
            }
        }
        from = to;
    }
    PhaseSingularity result;
    double factorial = 1;  // (2j)!
    for (int j = 0; j < kTerms; ++j) {
        // Finite part of sum_k b_k int_end^inf u^{2j-2k-2} du.
        for (int k = kTailTerms; k-- > 0;) {
            const int power = 2 * k + 1 - 2 * j;
            moments[j] += b[k] * std::pow(end, -power) / power;
        }
        result.even_.push_back(moments[j] / factorial);
        factorial *= 2 * j + 1;
        result.odd_.push_back(b[j] / factorial);
        factorial *= 2 * j + 2;
    }
    result.limit_ = 15 / reach;
    return result;
}

double PhaseSingularity::even(double h) const {
    double sum = 0;
    for (std::size_t j = even_.size(); j-- > 0;) sum = sum * h * h + even_[j];
    return sum;
}

double PhaseSingularity::odd(double h) const {
    double sum = 0;
    for (std::size_t j = odd_.size(); j-- > 0;) sum = sum * h * h + odd_[j];
    return h * sum;
}

}  // namespace airlight
