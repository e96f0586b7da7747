// SPDX-License-Identifier: Apache-2.0
#include "sh/window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr int kLights = 200;  // 10^4 were tried once, for the figure in the header

/// A light of that colour from (x, y, z): what a sun becomes, the hardest to bring above 0.
std::vector<double> sun(int order, double x, double y, double z) {
    std::vector<double> c(sh_count(order));
    evaluate_basis(order, x, y, z, c.data());
    return c;
}

double value(int order, const std::vector<double>& c, double x, double y, double z) {
    std::vector<double> basis(sh_count(order));
    evaluate_basis(order, x, y, z, basis.data());
    double sum = 0;
    for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * basis[k];
    return sum;
}

TEST(ShWindow, HannAndLanczosAreTheirFormulas) {
    EXPECT_EQ(hann_window(0).size(), 0u);
    EXPECT_EQ(hann_window(1), std::vector<double>{1});
    EXPECT_EQ(lanczos_window(1), std::vector<double>{1});
    const std::vector<double> hann = hann_window(6), lanczos = lanczos_window(6);
    EXPECT_DOUBLE_EQ(hann[3], 0.5);
    EXPECT_DOUBLE_EQ(lanczos[3], 2 / kPi);
    for (int l = 1; l < 6; ++l) {
        EXPECT_LT(hann[l], hann[l - 1]);
        EXPECT_LT(hann[l], lanczos[l]);
    }
}

TEST(ShWindow, SmoothingGoesFromNothingToTheMean) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(smoothing_window(4, 0), std::vector<double>(4, 1.0));
    EXPECT_EQ(smoothing_window(3, inf), (std::vector<double>{1, 0, 0}));
    EXPECT_DOUBLE_EQ(smoothing_window(3, 0.5)[2], 1 / 19.0);
    EXPECT_TRUE(smoothing_window(0, 1).empty());
    EXPECT_THROW(smoothing_window(3, -1e-300), Error);
    EXPECT_THROW(smoothing_window(3, std::nan("")), Error);
}

TEST(ShWindow, LeastValueOfHugeAndTinyCoefficientsIsScaled) {
    const std::vector<double> c = sun(4, 0.6, 0, 0.8);
    const double least = least_value(4, c.data());
    for (const double scale : {1e306, 1e-300}) {
        std::vector<double> other = c;
        for (double& x : other) x *= scale;
        EXPECT_NEAR(least_value(4, other.data()) / scale, least, 1e-9);
    }
    std::vector<double> bad = c;
    bad[5] = std::nan("");
    EXPECT_TRUE(std::isnan(least_value(4, bad.data())));
}

TEST(ShWindow, LeastValueIsThatOfEverySample) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const int order : {1, 2, 3, 6, 9, 16}) {
        std::vector<double> c(sh_count(order));
        for (double& x : c) x = normal(random);
        const double least = least_value(order, c.data());
        double sampled = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 100000; ++i) {
            sampled =
                std::min(sampled, value(order, c, normal(random), normal(random), normal(random)));
        }
        EXPECT_LE(least, sampled + 1e-9 * order);
        // Samples lie 0.006 apart: the least is not far below the lowest of them.
        EXPECT_GT(least, sampled - 0.01 * order) << order;
    }
}

TEST(ShWindow, LeastValueOfALightIsTheOneOnItsMeridian) {
    const int order = 6;
    const std::vector<double> c = sun(order, 0.36, 0.48, 0.8);
    double least = 1;
    const std::vector<double> pole = sun(order, 0, 0, 1);
    for (int i = 0; i <= 1000000; ++i) {
        const double t = kPi * i / 1000000;
        least = std::min(least, value(order, pole, std::sin(t), 0, std::cos(t)));
    }
    EXPECT_NEAR(least_value(order, c.data()), least, 1e-9);
}

TEST(ShWindow, AutomaticIsTheWeakestThatKeepsTheBound) {
    for (const int order : {2, 3, 6, 16}) {
        for (const double bound : {-0.3, 0.0, 0.5}) {
            std::vector<double> c = sun(order, 0.6, 0, 0.8);
            const std::vector<double> grey(c.size(), 0.0);
            std::vector<double> both = c;
            both.insert(both.end(), grey.begin(), grey.end());
            both[c.size()] = 1;
            const AutomaticWindow window = automatic_window(order, 2, both.data(), bound);
            ASSERT_EQ(window.factors, smoothing_window(order, window.strength));
            const auto least_after = [&](double strength) {
                std::vector<double> smooth = c;
                apply_window(smoothing_window(order, strength), 1, smooth.data());
                return least_value(order, smooth.data()) / (smooth[0] / std::sqrt(4 * kPi));
            };
            EXPECT_GE(least_after(window.strength), bound);
            EXPECT_GT(window.strength, 0);
            EXPECT_LT(least_after(0.999 * window.strength), bound) << order << ' ' << bound;
        }
    }
}

TEST(ShWindow, AutomaticKeepsTheBoundOfRandomLights) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    const int order = 3;
    for (int trial = 0; trial < kLights; ++trial) {
        std::vector<double> c(sh_count(order));
        const int suns = trial % 4;
        for (int k = 0; k < suns; ++k) {
            const std::vector<double> one =
                sun(order, normal(random), normal(random), normal(random));
            const double power = std::exp(2 * normal(random));
            for (std::size_t j = 0; j < c.size(); ++j) c[j] += power * one[j];
        }
        const double grain = std::exp(3 * normal(random));
        for (double& x : c) x += (suns ? 0.1 : 1) * grain * normal(random);
        c[0] = std::abs(c[0]) + 0.01 * grain;
        const AutomaticWindow window = automatic_window(order, 1, c.data());
        const auto least_after = [&](double strength) {
            std::vector<double> smooth = c;
            apply_window(smoothing_window(order, strength), 1, smooth.data());
            return least_value(order, smooth.data()) / smooth[0];
        };
        EXPECT_GE(least_after(window.strength), 0) << trial;
        if (window.strength == 0) continue;
        for (const double part : {0.99, 0.97, 0.9, 0.7}) {
            EXPECT_LT(least_after(part * window.strength), 0) << trial << ' ' << part;
        }
    }
}

TEST(ShWindow, AutomaticTakesNearlyAllWhereTheMeanIsNearlyNothing) {
    std::vector<double> c(sh_count(3));
    c[0] = 1e-250;
    c[2] = 1;
    AutomaticWindow window = automatic_window(3, 1, c.data(), 0.5);
    EXPECT_LT(window.factors[1], 1e-250);
    EXPECT_GT(window.factors[1], 1e-251);
    c[0] = 1e-307;
    window = automatic_window(3, 1, c.data(), 0.5);
    EXPECT_EQ(window.factors[0], 1);
    EXPECT_LT(window.factors[1], 1e-300);
    EXPECT_GE(window.factors[1], 0);
}

TEST(ShWindow, AutomaticLeavesAloneWhatIsAboveTheBound) {
    std::vector<double> c(sh_count(6));
    c[0] = 1;
    c[3] = 0.1;
    const AutomaticWindow window = automatic_window(6, 1, c.data());
    EXPECT_EQ(window.strength, 0);
    EXPECT_EQ(window.factors, std::vector<double>(6, 1.0));
}

TEST(ShWindow, AutomaticRefusesWhatCannotBeDone) {
    std::vector<double> c(sh_count(3));
    EXPECT_EQ(automatic_window(3, 1, c.data()).strength, 0);
    c[0] = -1;
    EXPECT_THROW(automatic_window(3, 1, c.data()), Error);
    c[0] = 1;
    EXPECT_THROW(automatic_window(3, 1, c.data(), 1), Error);
    EXPECT_THROW(automatic_window(3, 1, c.data(), std::nan("")), Error);
    EXPECT_THROW(automatic_window(0, 1, c.data()), Error);
    EXPECT_THROW(automatic_window(17, 1, std::vector<double>(sh_count(17), 1.0).data()), Error);
    c[7] = std::nan("");
    try {
        automatic_window(3, 1, c.data());
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "coefficient 7 of channel 0 is not finite");
    }
}

}  // namespace
}  // namespace airlight
