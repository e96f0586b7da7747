// SPDX-License-Identifier: Apache-2.0
#include "sh/least_norm.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace airlight {
namespace {

TEST(LeastNorm, OfOneBoundIsTheFootOfItsPlane) {
    LeastNorm programme(2);
    EXPECT_EQ(programme.solve(), (std::vector<double>{0, 0}));
    programme.add({3, 4}, -1);
    EXPECT_EQ(programme.solve(), (std::vector<double>{0, 0}));
    programme.add({3, 4}, 10);
    const std::vector<double> x = programme.solve();
    EXPECT_NEAR(x[0], 1.2, 1e-9);
    EXPECT_NEAR(x[1], 1.6, 1e-9);
}

TEST(LeastNorm, TakesACornerWhereTwoBoundsMeet) {
    LeastNorm programme(2);
    programme.add({1, 0.1}, 1);
    programme.add({0.1, 1}, 1);
    programme.add({1, 0.1}, 1);  // the same again
    const std::vector<double> x = programme.solve();
    EXPECT_NEAR(x[0], 1 / 1.1, 1e-9);
    EXPECT_NEAR(x[1], 1 / 1.1, 1e-9);
}

TEST(LeastNorm, IsFeasibleAndNoFeasiblePointIsShorter) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 200; ++trial) {
        const std::size_t size = 2 + trial % 9;
        // Bounds that a known point satisfies, some of them only just.
        std::vector<double> inside(size);
        for (double& value : inside) value = normal(random);
        LeastNorm programme(size);
        std::vector<std::vector<double>> rows;
        std::vector<double> bounds;
        for (std::size_t i = 0; i < 4 * size; ++i) {
            std::vector<double> row(size);
            double product = 0;
            for (std::size_t k = 0; k < size; ++k) {
                row[k] = normal(random);
                product += row[k] * inside[k];
            }
            rows.push_back(row);
            bounds.push_back(product - (i % 3 == 0 ? 0 : std::abs(normal(random))));
            programme.add(row, bounds.back());
        }
        const std::vector<double> x = programme.solve();
        double along = 0;
        for (std::size_t k = 0; k < size; ++k) along += x[k] * (inside[k] - x[k]);
        EXPECT_GE(along, -1e-8) << trial;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            double product = 0;
            for (std::size_t k = 0; k < size; ++k) product += rows[i][k] * x[k];
            EXPECT_GE(product, bounds[i] - 1e-7) << trial;
        }
    }
}

}  // namespace
}  // namespace airlight
