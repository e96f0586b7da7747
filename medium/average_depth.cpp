// SPDX-License-Identifier: Apache-2.0
#include "medium/average_depth.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "core/error.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRootPi = 1.7724538509055160273;

/// exp(-u^2) sum u^2k / (k! (2k + 1)), whose terms are all positive.
double near_zero(double u) {
    // The sum of the terms from the last to the first: t_k = 1 / (k! (2k + 1)).
    const double square = u * u;
    double sum = 0;
    for (int k = 17; k > 0; --k) sum = (sum + 1.0 / (2 * k + 1)) * square / k;
    return 0.5 * kRootPi * std::exp(-square) * (1 + sum);
}

/// T(u) = sum over odd n of exp(-(u - n h)^2) / (2 u n), the trapezoidal rule for Dawson's
/// function; it errs by exp(-(pi / 2h)^2), 7e-18 at h = 1/4. For u > 1 the terms of negative n are
/// small.
double middle(double u) {
    // exp(-k^2 / 4): Gaussians further away than 6.5 cannot be seen.
    constexpr double kFalloff[] = {
        0.7788007830714049,     0.36787944117144233,    0.10539922456186433,
        0.01831563888873418,    0.0019304541362277093,  0.00012340980408667956,
        4.785117392129009e-06,  1.1253517471925912e-07, 1.6052280551856116e-09,
        1.3887943864964021e-11, 7.287724095819692e-14,  2.3195228302435696e-16};
    // With g = u - n h for the odd n next to u, exp(-(g - k/2)^2) = exp(-g^2) exp(g)^k exp(-k^2/4).
    const int nearest = 2 * static_cast<int>(2 * u) + 1;
    const double gap = u - 0.25 * nearest;
    const double up = std::exp(gap), down = 1 / up;
    double sum = 1.0 / nearest, above = 1, below = 1;
    int k = 1;
    for (const double falloff : kFalloff) {
        above *= up;
        below *= down;
        sum += falloff * (above / (nearest + 2 * k) + below / (nearest - 2 * k));
        ++k;
    }
    return 0.5 * std::exp(-gap * gap) * sum / u;
}

/// sqrt(pi) / (4 u^2) (1 + 1 / (2 u^2) + 1 3 / (2 u^2)^2 + ...)
double far_out(double u) {
    const double step = 0.5 / u / u;
    double sum = 0, term = 1;
    for (int k = 0; k < 30 && term > 1e-17; ++k) {
        sum += term;
        term *= (2 * k + 1) * step;
    }
    return 0.5 * kRootPi / u * (0.5 / u) * sum;
}

}  // namespace

double mean_gaussian_depth(double u) {
    if (!(u >= 0)) return kNan;
    if (u < 1) return near_zero(u);
    return u < 7 ? middle(u) : far_out(u);
}

float mean_gaussian_depth(float u) {
    return static_cast<float>(mean_gaussian_depth(double{u}));
}

MeanDepthTable::MeanDepthTable(int size, double max_u) : max_u_(max_u) {
    if (size < 2) {
        throw Error(ErrorCode::usage,
                    "a table of " + std::to_string(size) + " points: at least 2 are needed");
    }
    if (!(max_u > 0 && max_u < kInfinity)) {
        throw Error(ErrorCode::usage, "the table ends at " + std::to_string(max_u) +
                                          ": a positive finite number is needed");
    }
    values_.resize(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
        values_[static_cast<std::size_t>(i)] = mean_gaussian_depth(max_u * i / (size - 1));
    }
}

double MeanDepthTable::operator()(double u) const {
    if (!(u >= 0)) return kNan;
    if (u >= max_u_) return 0.5 * kRootPi / u * (0.5 / u);
    const double place = u / max_u_ * static_cast<double>(values_.size() - 1);
    const std::size_t cell = std::min(static_cast<std::size_t>(place), values_.size() - 2);
    const double part = place - static_cast<double>(cell);
    return values_[cell] + part * (values_[cell + 1] - values_[cell]);
}

double average_optical_depth(double beta0, double reach, const GaussianBlob* blobs,
                             std::size_t count, const glm::dvec3& point) {
    const double sum_of_coordinates = std::abs(point.x) + std::abs(point.y) + std::abs(point.z);
    if (!(beta0 >= 0 && beta0 < kInfinity && reach >= 0) || std::isnan(sum_of_coordinates)) {
        return kNan;
    }
    double sum = beta0 == 0 ? 0 : beta0 * reach;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = blobs[i].scale, c = blobs[i].amplitude;
        if (!(a >= 0 && a < kInfinity && c >= 0 && c < kInfinity)) return kNan;
        if (c == 0) continue;
        const double mean = mean_gaussian_depth(a * glm::length(point - blobs[i].center));
        sum += a == 0 ? kInfinity : c * mean / a;
    }
    return sum;
}

}  // namespace airlight
