// SPDX-License-Identifier: Apache-2.0
#include "sh/sphere_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

// The largest error over the sphere of looking one random band up, over its largest value.
double error_of_band(int degree, int order, int rows) {
    const std::size_t count = sh_count(order);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<double> coefficients(3 * count), basis(count);
    for (std::size_t c = 0; c < 3; ++c) {
        for (int m = -degree; m <= degree; ++m) {
            coefficients[c * count + sh_index(degree, m)] = normal(random);
        }
    }
    SphereMap map(order, rows);
    map.fill(coefficients.data());
    double worst = 0, largest = 0;
    for (int i = 0; i < 2000; ++i) {
        glm::dvec3 d(normal(random), normal(random), normal(random));
        // Every other direction beside a pole or the seam, where rows and columns wrap.
        if (i % 4 == 1) d *= glm::dvec3(1e-3, 1e-3, 1);
        if (i % 4 == 3) d = {-std::abs(d.x), 1e-3 * d.y, d.z};
        const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        evaluate_basis(order, d.x / length, d.y / length, d.z / length, basis.data());
        const glm::dvec3 value = map(d);
        for (int c = 0; c < 3; ++c) {
            double exact = 0;
            for (std::size_t k = 0; k < count; ++k) {
                exact += coefficients[static_cast<std::size_t>(c) * count + k] * basis[k];
            }
            worst = std::max(worst, std::abs(value[c] - exact));
            largest = std::max(largest, std::abs(exact));
        }
    }
    return worst / largest;
}

TEST(SphereMap, LooksBandsUpWithinItsStatedError) {
    for (const int order : {8, 32}) {
        const double top = error_of_band(order - 1, order, 4 * order);
        const double half = error_of_band(order / 2, order, 4 * order);
        RecordProperty("top" + std::to_string(order), std::to_string(top));
        RecordProperty("half" + std::to_string(order), std::to_string(half));
        EXPECT_LT(top, 0.009);
        EXPECT_LT(half, 0.0012);
        // Fourth order in the spacing: twice the rows leave a sixteenth.
        EXPECT_LT(error_of_band(order - 1, order, 8 * order), top / 10);
    }
}

TEST(SphereMap, KeepsConstantsExactly) {
    std::vector<double> coefficients(3 * sh_count(4), 0.0);
    const double y00 = 0.28209479177387814;
    for (std::size_t c = 0; c < 3; ++c) coefficients[c * 16] = static_cast<double>(c + 1) / y00;
    SphereMap map(4, 16);
    map.fill(coefficients.data());
    for (const glm::dvec3& d : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -2), glm::dvec3(-1, 0, 0),
                                glm::dvec3(-1, -1e-300, 0), glm::dvec3(0.1, -5, 3)}) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(map(d)[c], c + 1, 1e-14);
    }
}

}  // namespace
}  // namespace airlight
