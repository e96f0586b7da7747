// SPDX-License-Identifier: Apache-2.0
#include "sh/zonal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Gauss-Legendre in cos(angle) over [low, 1] alone, for functions that end at cos(angle) = low.
PolarRule cap_rule(int n, double low) {
    PolarRule rule = gauss_legendre(n);
    for (std::size_t i = 0; i < rule.weight.size(); ++i) {
        const double half = (1 - low) / 2;
        rule.cosine[i] = low + half * (1 + rule.cosine[i]);
        rule.angle[i] = std::acos(rule.cosine[i]);
        rule.sine[i] = std::sin(rule.angle[i]);
        rule.weight[i] *= half;
    }
    return rule;
}

std::vector<double> legendre(int order, double x) {
    std::vector<double> result;
    long double p = 1, previous = 0;
    for (int l = 0; l < order; ++l) {
        result.push_back(static_cast<double>(p));
        const long double next =
            ((2 * l + 1) * static_cast<long double>(x) * p - l * previous) / (l + 1);
        previous = p;
        p = next;
    }
    return result;
}

TEST(ZonalEigenvalue, AndCoefficientAreInverse) {
    // The clamped cosine: g_1 = sqrt(pi/3), lambda_1 = 2 pi / 3.
    EXPECT_DOUBLE_EQ(zonal_eigenvalue(1, std::sqrt(kPi / 3)), 2 * kPi / 3);
    for (const int l : {0, 1, 7, 4095}) {
        EXPECT_NEAR(zonal_coefficient(l, zonal_eigenvalue(l, 0.7)), 0.7, 4 * kEps);
    }
}

TEST(ZonalEigenvalues, OfAConeAreItsClosedForm) {
    constexpr int kOrder = 500;
    const double edge = 0.2;
    const PolarRule rule = cap_rule(kOrder / 2 + 1, edge);
    const std::vector<double> ones(rule.weight.size(), 1.0);
    const std::vector<double> lambda = zonal_eigenvalues(rule, ones, kOrder);
    const std::vector<double> p = legendre(kOrder + 1, edge);
    EXPECT_NEAR(lambda[0], 2 * kPi * (1 - edge), 16 * kEps);
    for (std::size_t l = 1; l < kOrder; ++l) {
        const double exact = 2 * kPi * (p[l - 1] - p[l + 1]) / (2.0 * static_cast<double>(l) + 1);
        // The angles of this rule carry the rounding of the map to the cap, eps/2 each.
        EXPECT_NEAR(lambda[l], exact, 64 * kEps) << l;
    }
}

TEST(ZonalEigenvalues, OfTheClampedCosineAreItsClosedForm) {
    const PolarRule rule = cap_rule(16, 0);
    const std::vector<double> lambda = zonal_eigenvalues(rule, rule.cosine, 8);
    const double exact[8] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24, 0, kPi / 64, 0};
    for (std::size_t l = 0; l < 8; ++l) EXPECT_NEAR(lambda[l], exact[l], 16 * kEps) << l;
}

TEST(ZonalEigenvalues, OfASmoothLobeRebuildIt) {
    constexpr double kSharpness = 40;
    const auto lobe = [](double gamma) {
        const double s = std::sin(gamma / 2);
        return std::exp(-2 * kSharpness * s * s);
    };
    const std::vector<double> lambda = zonal_eigenvalues(lobe, 128, 160);
    const double exact = 2 * kPi * (1 - std::exp(-2 * kSharpness)) / kSharpness;
    EXPECT_NEAR(lambda[0], exact, 16 * kEps * exact);
    // sum_l (2l+1)/4pi |lambda_l| is the lobe's peak, 1.
    for (const double gamma : {0.0, 1e-9, 0.1, 1.0, 2.0, kPi - 1e-9, kPi}) {
        EXPECT_NEAR(zonal_evaluate(lambda, gamma), lobe(gamma), 1e-14) << gamma;
    }
    EXPECT_EQ(zonal_evaluate(lambda, std::vector<double>{}).size(), 0u);
}

TEST(ZonalEvaluate, KeepsTheDigitsOfHighDegreesBesideThePoles) {
    constexpr int kOrder = 4096;
    for (const double offset : {0.0, 1e-6, 1e-4, 1e-3, 0.02}) {
        // P_l(cos gamma) in extended precision, by the difference form.
        const long double s = std::sin(static_cast<long double>(offset) / 2);
        long double p = 1, difference = 0;
        for (int l = 0; l + 1 < kOrder; ++l) {
            difference = (l * difference - (2 * l + 1) * 2 * s * s * p) / (l + 1);
            p += difference;
        }
        std::vector<double> lambda(kOrder, 0.0);
        lambda.back() = 4 * kPi / (2.0 * kOrder - 1);
        // Measured: 2e-15; the three-term recurrence loses 1e-11 here.
        EXPECT_NEAR(zonal_evaluate(lambda, offset), static_cast<double>(p), 1e-14) << offset;
        // pi - offset rounds to 2 eps, times l offset / 2 of the slope there.
        EXPECT_NEAR(zonal_evaluate(lambda, kPi - offset), -static_cast<double>(p), 4e-13) << offset;
    }
}

template <class Real>
void expect_convolution_is_brute_force(double tolerance) {
    constexpr int kOrder = 6;
    constexpr std::size_t kChannels = 3;
    const std::size_t count = sh_count(kOrder);
    std::mt19937 random(7);
    std::uniform_real_distribution<Real> uniform(-1, 1);
    std::vector<Real> coefficients(kChannels * count);
    for (Real& c : coefficients) c = uniform(random);
    const std::vector<Real> before = coefficients;

    const auto kernel = [](double gamma) { return 0.3 + std::pow(std::cos(gamma), 3); };
    zonal_convolve(zonal_eigenvalues(kernel, kOrder, 16), kChannels, coefficients.data());

    const double center[3] = {0.48, -0.6, 0.64};
    std::vector<double> y(count), result(kChannels, 0.0);
    const PolarRule rule = gauss_legendre(12);
    constexpr int kColumns = 24;
    for (std::size_t i = 0; i < rule.angle.size(); ++i) {
        for (int k = 0; k < kColumns; ++k) {
            const double phi = 2 * kPi * k / kColumns;
            const double d[3] = {rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi),
                                 rule.cosine[i]};
            const double dot = d[0] * center[0] + d[1] * center[1] + d[2] * center[2];
            const double weight =
                rule.weight[i] * 2 * kPi / kColumns * kernel(std::acos(std::min(1.0, dot)));
            evaluate_basis(kOrder, d[0], d[1], d[2], y.data());
            for (std::size_t c = 0; c < kChannels; ++c) {
                for (std::size_t j = 0; j < count; ++j) {
                    result[c] += weight * y[j] * before[c * count + j];
                }
            }
        }
    }
    evaluate_basis(kOrder, center[0], center[1], center[2], y.data());
    for (std::size_t c = 0; c < kChannels; ++c) {
        double convolved = 0;
        for (std::size_t j = 0; j < count; ++j) convolved += y[j] * coefficients[c * count + j];
        EXPECT_NEAR(convolved, result[c], tolerance) << c;
        EXPECT_GT(std::abs(result[c]), 100 * tolerance);
    }
}

TEST(ZonalConvolve, IsTheIntegralOverTheSphere) {
    // 36 terms of size 1 at rounding; in float each is rounded once, to 6e-8.
    expect_convolution_is_brute_force<double>(1e-13);
    expect_convolution_is_brute_force<float>(1e-5);
}

}  // namespace
}  // namespace airlight
