// SPDX-License-Identifier: Apache-2.0
#include "sh/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// The largest |sum_i w_i P_k(x_i) - int P_k| over k <= degree.
double worst_moment(const PolarRule& rule, int degree) {
    const std::size_t n = rule.weight.size();
    std::vector<long double> p(n, 1), previous(n, 0);
    double worst = 0;
    for (int k = 0; k <= degree; ++k) {
        long double sum = k == 0 ? -2 : 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += rule.weight[i] * p[i];
            const long double x = rule.cosine[i];
            const long double next = ((2 * k + 1) * x * p[i] - k * previous[i]) / (k + 1);
            previous[i] = p[i];
            p[i] = next;
        }
        worst = std::max(worst, std::abs(static_cast<double>(sum)));
    }
    return worst;
}

TEST(GaussLegendre, IntegratesEveryDegreeBelowTwiceItsNodes) {
    // Each node's rounding by eps/2 moves P_k by up to k eps/2 in the mean.
    for (int n = 1; n <= 80; ++n) {
        EXPECT_LT(worst_moment(gauss_legendre(n), 2 * n - 1), (1 + n) * kEps) << n;
    }
    EXPECT_LT(worst_moment(gauss_legendre(1000), 1999), 1000 * kEps);
}

TEST(GaussLegendre, MatchesGoldenNodesAndWeights) {
    struct Golden {
        int n;
        int index;
        double angle, weight;
    };
    // mpmath, 40 digits.
    const Golden rows[] = {
        {7, 0, 0.3204050902900619825, 0.1294849661688696933},
        {7, 3, 1.570796326794896619, 0.4179591836734693878},
        {32, 0, 0.07399171309970959769, 0.0070186100094700966},
        {600, 0, 0.004004704878971939674, 0.00002057885378962236891},
        {600, 1, 0.009192468730139275126, 0.00004790310784019442089},
        {600, 99, 0.5218555024026926705, 0.002607908136646528808},
        {600, 299, 1.568180513668689805, 0.005231608353770980338},
        {10000, 0, 0.0002404705321427790922, 7.420019273239322797e-8},
        {10000, 4999, 1.570639255016002404, 0.0003141435539132268276},
    };
    for (const Golden& row : rows) {
        const PolarRule rule = gauss_legendre(row.n);
        const auto i = static_cast<std::size_t>(row.index);
        EXPECT_NEAR(rule.angle[i] / row.angle, 1, kEps) << row.n << " " << row.index;
        EXPECT_NEAR(rule.sine[i] / std::sin(row.angle), 1, 2 * kEps);
        EXPECT_NEAR(rule.cosine[i], std::cos(row.angle), kEps);
        EXPECT_NEAR(rule.weight[i] / row.weight, 1, 4 * kEps) << row.n << " " << row.index;
    }
}

TEST(GaussLegendre, IsSymmetricAndAscending) {
    for (const int n : {1, 2, 3, 16, 17, 601}) {
        const PolarRule rule = gauss_legendre(n);
        const auto size = static_cast<std::size_t>(n);
        ASSERT_EQ(rule.angle.size(), size);
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t mirror = size - 1 - i;
            EXPECT_EQ(rule.cosine[i], -rule.cosine[mirror]);
            EXPECT_EQ(rule.sine[i], rule.sine[mirror]);
            EXPECT_EQ(rule.weight[i], rule.weight[mirror]);
            EXPECT_NEAR(rule.angle[i] + rule.angle[mirror], kPi, 4 * kEps);
            EXPECT_GT(rule.angle[i], i == 0 ? 0 : rule.angle[i - 1]);
            EXPECT_LT(rule.angle[i], kPi);
        }
    }
}

TEST(FejerRows, IntegratesEveryDegreeBelowTheRows) {
    for (int rows = 1; rows <= 80; ++rows) {
        EXPECT_LT(worst_moment(fejer_rows(rows), rows - 1), (4 + rows) * kEps) << rows;
    }
    EXPECT_LT(worst_moment(fejer_rows(1024), 1023), 1024 * kEps);
    // With an even number of rows the next degree is beyond it.
    EXPECT_GT(worst_moment(fejer_rows(8), 8), 1e-3);
}

TEST(FejerRows, LiesOnPixelCentresWithPositiveWeights) {
    for (const int rows : {1, 2, 3, 64, 513, 4096}) {
        const PolarRule rule = fejer_rows(rows);
        ASSERT_EQ(rule.weight.size(), static_cast<std::size_t>(rows));
        for (int j = 0; j < rows; ++j) {
            const auto i = static_cast<std::size_t>(j);
            EXPECT_DOUBLE_EQ(rule.angle[i], (j + 0.5) * kPi / rows);
            // Angles near pi are rounded to 2 eps.
            EXPECT_NEAR(rule.cosine[i], std::cos(rule.angle[i]), 4 * kEps);
            EXPECT_GT(rule.weight[i], 0);
            EXPECT_EQ(rule.weight[i], rule.weight[static_cast<std::size_t>(rows - 1 - j)]);
        }
    }
    // H = 1, 2, 3 by hand.
    EXPECT_DOUBLE_EQ(fejer_rows(1).weight[0], 2);
    EXPECT_DOUBLE_EQ(fejer_rows(2).weight[0], 1);
    EXPECT_DOUBLE_EQ(fejer_rows(3).weight[0], 4.0 / 9);
    EXPECT_DOUBLE_EQ(fejer_rows(3).weight[1], 10.0 / 9);
}

}  // namespace
}  // namespace airlight
