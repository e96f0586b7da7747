// SPDX-License-Identifier: Apache-2.0
#include "sh/low_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

TEST(LowPlaces, ValuesAreThoseOfTheFunctionThereAndNoneNearbyIsLower) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const int order : {1, 2, 3, 6, 9}) {
        const LowPlaces places(order);
        for (int trial = 0; trial < 20; ++trial) {
            std::vector<double> c(sh_count(order)), basis(c.size());
            for (double& x : c) x = normal(random);
            const auto value = [&](double x, double y, double z) {
                evaluate_basis(order, x, y, z, basis.data());
                double sum = 0;
                for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * basis[k];
                return sum;
            };
            const LowPlace lowest = places.lowest(c.data());
            const auto found = places.below(c.data(), lowest.value + 0.5);
            ASSERT_FALSE(found.empty());
            double least = std::numeric_limits<double>::infinity();
            for (const LowPlace& place : found) {
                const auto [x, y, z] = place.direction;
                EXPECT_NEAR(value(x, y, z), place.value, 1e-13 * order);
                EXPECT_LT(place.value, lowest.value + 0.5);
                least = std::min(least, place.value);
                for (int k = 0; k < 50; ++k) {
                    EXPECT_GE(value(x + 1e-3 * normal(random), y + 1e-3 * normal(random),
                                    z + 1e-3 * normal(random)),
                              place.value - 1e-9 * order);
                }
            }
            EXPECT_NEAR(least, lowest.value, 1e-9);
        }
    }
}

}  // namespace
}  // namespace airlight
