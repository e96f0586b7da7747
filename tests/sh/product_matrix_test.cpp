// SPDX-License-Identifier: Apache-2.0
#include "sh/product_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "sh/index.h"
#include "sh/product.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

template <class T>
std::vector<T> random_vectors(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<T> out(count);
    for (T& value : out) value = static_cast<T>(uniform(random));
    return out;
}

double norm(const double* v, std::size_t size) {
    double square = 0;
    for (std::size_t i = 0; i < size; ++i) square += v[i] * v[i];
    return std::sqrt(square);
}

TEST(ShProductMatrix, IsSymmetricAndMultipliesByTheLight) {
    for (const int order : {1, 3, 6}) {
        const std::size_t size = sh_count(order);
        const TripleProducts triples(order);
        const auto light = random_vectors<double>(size, 1), v = random_vectors<double>(size, 2);
        const ShProductMatrix matrix(triples, light.data());
        for (std::size_t j = 0; j < size; ++j) {
            for (std::size_t k = 0; k < size; ++k) {
                EXPECT_NEAR(matrix.data()[j * size + k], matrix.data()[k * size + j], 1e-15);
            }
        }
        std::vector<double> exact(size), out(size);
        triples.multiply(light.data(), v.data(), exact.data());
        matrix.multiply(1, v.data(), out.data());
        for (std::size_t k = 0; k < size; ++k) EXPECT_NEAR(out[k], exact[k], 1e-14);
    }
}

// <L|V|B> by the sum over Gamma, by matrix and vector, and by product and dot, every target, count
// and type.
template <class T>
void check_integrals(double tolerance) {
    double worst = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : {1, 2, 3, 4, 5, 6, 8}) {
            const std::size_t size = sh_count(order);
            const TripleProducts triples(order);
            const auto light = random_vectors<T>(size, 3);
            const std::vector<double> light_in_double(light.begin(), light.end());
            const ShProductMatrix matrix(triples, light.data());
            for (const std::size_t count : {0, 1, 8, 31, 65}) {
                const auto v = random_vectors<T>(count * size, 4);
                const auto b = random_vectors<T>(count * size, 5);
                std::vector<T> by_matrix(count + 1, T{7}), products(v.size()),
                    dots(count + 1, T{7});
                matrix.integral(count, v.data(), b.data(), by_matrix.data());
                ShProduct(order).multiply(count, v.data(), b.data(), products.data());
                sh_dot(order, light.data(), count, products.data(), dots.data());
                EXPECT_EQ(by_matrix.back(), T{7});
                EXPECT_EQ(dots.back(), T{7});
                auto multiplied = v;
                matrix.multiply(count, multiplied.data(), multiplied.data());
                for (std::size_t i = 0; i < count; ++i) {
                    const std::vector<double> x(&v[i * size], &v[i * size] + size);
                    const std::vector<double> y(&b[i * size], &b[i * size] + size);
                    const double exact =
                        triples.integral(light_in_double.data(), x.data(), y.data());
                    const double scale = norm(light_in_double.data(), size) * norm(x.data(), size) *
                                         norm(y.data(), size);
                    double by_multiply = 0;
                    for (std::size_t k = 0; k < size; ++k) {
                        by_multiply += double{multiplied[i * size + k]} * y[k];
                    }
                    for (const double value :
                         {double{by_matrix[i]}, double{dots[i]}, by_multiply}) {
                        worst = std::max(worst, std::abs(value - exact) / scale);
                    }
                }
            }
        }
    }
    EXPECT_LT(worst, tolerance);
    testing::Test::RecordProperty("worst", std::to_string(worst * 1e18) + "e-18");
}

TEST(ShProductMatrix, AllWaysToTheTripleIntegralAgreeInDouble) {
    check_integrals<double>(1e-15);
}

TEST(ShProductMatrix, AllWaysToTheTripleIntegralAgreeInFloat) {
    check_integrals<float>(4e-7);
}

}  // namespace
}  // namespace airlight
