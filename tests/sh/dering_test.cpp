// SPDX-License-Identifier: Apache-2.0
#include "sh/dering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/rotation.h"
#include "sh/window.h"

namespace airlight {
namespace {

constexpr DeringMethod kMethods[] = {DeringMethod::smoothing, DeringMethod::bands,
                                     DeringMethod::nearest};

/// A sky of noise and a sun, as seen from somewhere.
std::vector<double> light(int order, std::mt19937& random, double noise) {
    std::normal_distribution<double> normal;
    std::vector<double> c(sh_count(order));
    evaluate_basis(order, normal(random), normal(random), normal(random), c.data());
    for (double& x : c) x += noise * normal(random);
    c[0] = std::abs(c[0]) + 0.1;
    return c;
}

double squared_change(int order, const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < sh_count(order); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

TEST(Dering, KeepsTheMeanAndTheBoundAndChangesNoMoreThanTheMilderMethods) {
    std::mt19937 random(1);
    for (const int order : {2, 3, 5}) {
        for (const double least : {-0.2, 0.0, 0.5}) {
            for (const double noise : {0.0, 0.05, 0.4}) {
                const std::vector<double> c = light(order, random, noise);
                double before = std::numeric_limits<double>::infinity();
                for (const DeringMethod method : kMethods) {
                    const std::vector<double> d = dering(method, order, 1, c.data(), least);
                    EXPECT_EQ(d[0], c[0]);
                    EXPECT_GE(least_value(order, d.data()), least * c[0] / std::sqrt(4 * kPi))
                        << name_of(method) << ' ' << order;
                    const double change = squared_change(order, c, d);
                    EXPECT_LE(change, before * (1 + 1e-5)) << name_of(method);
                    if (noise == 0 && least >= 0 && order > 2) {
                        EXPECT_GT(change, 0);
                    }
                    before = change;
                }
            }
        }
    }
}

TEST(Dering, NearestIsNearerThanAnyOtherFunctionAboveTheBound) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (const int order : {2, 3, 5}) {
        const std::vector<double> c = light(order, random, 0.1);
        const std::vector<double> d = dering(DeringMethod::nearest, order, 1, c.data());
        const double whole = squared_change(order, c, d);
        for (int trial = 0; trial < 60; ++trial) {
            // The functions above the bound are convex, so none may lie on the side of c.
            std::vector<double> other = d;
            const double size = std::pow(10, -3.0 * trial / 60);
            for (std::size_t k = 1; k < other.size(); ++k) other[k] += size * normal(random);
            other = dering(DeringMethod::smoothing, order, 1, other.data());
            double towards = 0;
            for (std::size_t k = 1; k < d.size(); ++k) {
                towards += (d[k] - c[k]) * (other[k] - d[k]);
            }
            EXPECT_GE(towards, -1e-5 * whole) << order << ' ' << trial;
        }
    }
}

TEST(Dering, BandsAreTheBestOfAllWindows) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    for (const int order : {2, 3, 5}) {
        std::vector<double> c = light(order, random, 0.1);
        const std::vector<double> second = light(order, random, 0.1);
        c.insert(c.end(), second.begin(), second.end());
        const std::vector<double> w = least_change_window(order, 2, c.data());
        const auto norm = [&](int l) {
            double sum = 0;
            for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
                sum += c[k] * c[k] + c[sh_count(order) + k] * c[sh_count(order) + k];
            }
            return sum;
        };
        double whole = 0;
        for (int l = 0; l < order; ++l) whole += norm(l) * (1 - w[l]) * (1 - w[l]);
        EXPECT_EQ(w[0], 1);
        for (int trial = 0; trial < 60; ++trial) {
            std::vector<double> other = w;
            const double size = std::pow(10, -3.0 * trial / 60);
            for (int l = 1; l < order; ++l) {
                other[l] = std::min(1.0, std::max(0.0, w[l] + size * (2 * uniform(random) - 1)));
            }
            std::vector<double> windowed = c;
            apply_window(other, 2, windowed.data());
            const AutomaticWindow rest = automatic_window(order, 2, windowed.data());
            double towards = 0;
            for (int l = 1; l < order; ++l) {
                EXPECT_GE(w[l], 0);
                EXPECT_LE(w[l], 1);
                towards += norm(l) * (w[l] - 1) * (other[l] * rest.factors[l] - w[l]);
            }
            EXPECT_GE(towards, -1e-5 * whole) << order << ' ' << trial;
        }
    }
}

TEST(Dering, TurnsWithTheLight) {
    std::mt19937 random(4);
    const int order = 4;
    const std::vector<double> c = light(order, random, 0.1);
    const ShRotation rotation(order, glm::normalize(glm::dquat(0.6, 0.3, -0.5, 0.2)));
    std::vector<double> turned = c;
    rotation.rotate(1, turned.data(), turned.data());
    for (const DeringMethod method : kMethods) {
        std::vector<double> first = dering(method, order, 1, c.data());
        rotation.rotate(1, first.data(), first.data());
        const std::vector<double> second = dering(method, order, 1, turned.data());
        for (std::size_t k = 0; k < c.size(); ++k) EXPECT_NEAR(first[k], second[k], 1e-4);
    }
}

TEST(Dering, LeavesAloneWhatNeedsNoChange) {
    std::vector<double> c(2 * sh_count(3));
    c[0] = 1;
    c[2] = 0.1;
    for (const DeringMethod method : kMethods) {
        EXPECT_EQ(dering(method, 3, 2, c.data()), c);
        const std::vector<double> one = {2};
        EXPECT_EQ(dering(method, 1, 1, one.data()), one);
    }
    // A channel that needs none beside one that does, in the method that looks at each alone.
    c[sh_count(3)] = 1;
    c[sh_count(3) + 2] = 5;
    const std::vector<double> d = dering(DeringMethod::nearest, 3, 2, c.data());
    EXPECT_EQ(std::vector<double>(d.begin(), d.begin() + 9),
              std::vector<double>(c.begin(), c.begin() + 9));
}

TEST(Dering, HoldsTheBoundAtAnyScale) {
    std::mt19937 random(5);
    for (const double scale : {1e-290, 1e290}) {
        for (const double mean : {1.0, 1e-9, 1e-14}) {
            std::vector<double> c = light(3, random, 0.1);
            for (double& x : c) x *= scale;
            c[0] *= mean;
            for (const DeringMethod method : kMethods) {
                const std::vector<double> d = dering(method, 3, 1, c.data());
                EXPECT_EQ(d[0], c[0]);
                EXPECT_GE(least_value(3, d.data()), 0) << name_of(method) << mean;
            }
        }
    }
}

TEST(Dering, StaysFiniteWhereNumbersHaveNoDigitsLeft) {
    std::vector<double> c(9);
    c[0] = 5e-324;
    c[2] = 2.5e-323;
    for (const DeringMethod method : kMethods) {
        const std::vector<double> d = dering(method, 3, 1, c.data());
        EXPECT_EQ(d[0], c[0]);
        // The least number apart from 0 is a mean of itself away from its neighbours.
        EXPECT_LE(std::abs(d[2]), c[0]) << name_of(method);
    }
}

TEST(Dering, RefusesWhatCannotBeDone) {
    std::vector<double> c(sh_count(3));
    c[0] = -1;
    for (const DeringMethod method : kMethods) {
        c[0] = -1;
        EXPECT_THROW(dering(method, 3, 1, c.data()), Error);
        c[0] = 1;
        EXPECT_THROW(dering(method, 3, 1, c.data(), 1), Error);
        EXPECT_THROW(dering(method, 0, 1, c.data()), Error);
        c[4] = std::numeric_limits<double>::infinity();
        EXPECT_THROW(dering(method, 3, 1, c.data()), Error);
        c[4] = 0;
    }
}

}  // namespace
}  // namespace airlight
