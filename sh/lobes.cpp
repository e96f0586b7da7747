// SPDX-License-Identifier: Apache-2.0
#include "sh/lobes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"

namespace airlight {
namespace {

constexpr double kLargest = 1e300;
constexpr double kNextAbovePi = 3.14159274101257324;
// Below, the cone is a point as far as any degree can tell.
constexpr double kPoint = 1e-100;

std::vector<double> table(int order) {
    assert(order >= 0);
    return std::vector<double>(static_cast<std::size_t>(order), 0.0);
}

double checked(double value, double low, double high, const char* what) {
    if (value >= low && value <= high) return value;
    throw Error(ErrorCode::data,
                fmt::format("{} must be in [{}, {}], got {}", what, low, high, value));
}

double checked_half_angle(double half_angle) {
    if (half_angle > kPi && half_angle <= kNextAbovePi) return kPi;
    return checked(half_angle, 0, kPi, "the half angle of a cone");
}

// lambda_l / lambda_0 of the cone, l >= 1. With P_l1 of normalized_legendre(),
// sin(a) P_l'(cos a) = P_l1 / sqrt((2l+1) / (4 pi l (l+1))).
std::vector<double> cone_ratios(double half_angle, int order) {
    std::vector<double> ratio = table(order);
    if (half_angle < kPoint) {
        std::fill(ratio.begin(), ratio.end(), 1.0);
        return ratio;
    }
    if (order < 2) return ratio;
    normalized_legendre(order, std::cos(half_angle), std::sin(half_angle), 1, ratio.data() + 1);
    // 2 pi sin(a) / (4 pi sin^2(a/2)) = cos(a/2) / sin(a/2).
    const double scale = std::cos(half_angle / 2) / std::sin(half_angle / 2);
    for (int l = 1; l < order; ++l) {
        const double ll = double(l) * (l + 1);
        ratio[static_cast<std::size_t>(l)] *= scale / std::sqrt((2.0 * l + 1) * ll / (4 * kPi));
    }
    return ratio;
}

// e^-k i_l(k) 2 k as its finite sum; for k >= l^2 the terms of either sum fall and hardly cancel.
double bessel_sum(int l, double k) {
    double sum = 0, mirrored = 0, term = 1;
    for (int j = 0; j <= l && term > 1e-20; ++j) {
        sum += j % 2 == 0 ? term : -term;
        mirrored += term;
        term *= (double(l) + j + 1) / (2 * k) * (double(l) - j) / (j + 1);
    }
    return sum + (l % 2 == 0 ? -1 : 1) * std::exp(-2 * k) * mirrored;
}

}  // namespace

std::vector<double> delta_eigenvalues(int order) {
    assert(order >= 0);
    return std::vector<double>(static_cast<std::size_t>(order), 1.0);
}

std::vector<double> clamped_cosine_eigenvalues(int order) {
    return phong_eigenvalues(1, order);
}

std::vector<double> phong_eigenvalues(double exponent, int order, LobeScale scale) {
    checked(exponent, 0, kLargest, "the exponent of a Phong lobe");
    std::vector<double> lambda = table(order);
    const bool unit = scale == LobeScale::integral;
    for (std::size_t l = 0; l < lambda.size(); ++l) {
        const auto degree = static_cast<double>(l);
        if (l == 0) {
            lambda[l] = unit ? 1 : 2 * kPi / (exponent + 1);
        } else if (l == 1) {
            lambda[l] = (unit ? exponent + 1 : 2 * kPi) / (exponent + 2);
        } else {
            lambda[l] = lambda[l - 2] * ((exponent - (degree - 2)) / (exponent + (degree + 1)));
        }
    }
    return lambda;
}

std::vector<double> cone_eigenvalues(double half_angle, int order, LobeScale scale) {
    half_angle = checked_half_angle(half_angle);
    std::vector<double> lambda = cone_ratios(half_angle, order);
    if (lambda.empty()) return lambda;
    lambda[0] = 1;
    if (scale == LobeScale::peak) {
        const double sine = std::sin(half_angle / 2);
        for (double& value : lambda) value *= 4 * kPi * sine * sine;
    }
    return lambda;
}

std::vector<double> cone_complement_eigenvalues(double half_angle, int order, LobeScale scale) {
    // The complement is the cone about the opposite axis, which changes the sign of odd degrees;
    // that keeps the digits of both where one of them is small.
    half_angle = checked_half_angle(half_angle);
    if (scale == LobeScale::integral) {
        std::vector<double> lambda = cone_eigenvalues(kPi - half_angle, order, scale);
        for (std::size_t l = 1; l < lambda.size(); l += 2) lambda[l] = -lambda[l];
        return lambda;
    }
    std::vector<double> lambda = cone_eigenvalues(half_angle, order, scale);
    for (double& value : lambda) value = -value;
    if (!lambda.empty()) {
        const double cosine = std::cos(half_angle / 2);
        lambda[0] = 4 * kPi * cosine * cosine;
    }
    return lambda;
}

std::vector<double> gaussian_eigenvalues(double sharpness, int order, LobeScale scale) {
    const double k = checked(sharpness, 0, kLargest, "the sharpness of a Gaussian lobe");
    std::vector<double> lambda = table(order);
    if (order == 0) return lambda;
    // 2 pi (1 - e^-2k) / k, whose limit is 4 pi; denormal k have lost their digits.
    const double first = k < 1e-290 ? 4 * kPi : -2 * kPi * std::expm1(-2 * k) / k;
    lambda[0] = scale == LobeScale::integral ? 1 : first;
    if (k == 0) return lambda;
    const double n = order;
    if (k >= std::max(20.0, n * n)) {
        const double norm = lambda[0] / bessel_sum(0, k);
        for (int l = 1; l < order; ++l) {
            lambda[static_cast<std::size_t>(l)] = norm * bessel_sum(l, k);
        }
        return lambda;
    }
    // Downwards, an error of a ratio is multiplied by its square: over the degrees from `start` to
    // `order` by (i_start / i_order)^2, about e^{-(start^2 - order^2) / k}.
    const double start = std::ceil(std::sqrt(n * n + 40 * k)) + 20;
    double ratio = k / (start + 0.5 + std::hypot(start + 0.5, k));
    for (double l = start - 1; l >= 1; --l) {
        ratio = 1 / ((2 * l + 1) / k + ratio);
        if (l < n) lambda[static_cast<std::size_t>(l)] = ratio;
    }
    for (std::size_t l = 1; l < lambda.size(); ++l) lambda[l] *= lambda[l - 1];
    return lambda;
}

}  // namespace airlight
