// SPDX-License-Identifier: Apache-2.0
#include "sh/product.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/product_matrix.h"
#include "sh/quadrature.h"
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

double largest(const std::vector<double>& values) {
    double size = 0;
    for (const double value : values) size = std::max(size, std::abs(value));
    return size;
}

double value_at(const std::vector<double>& c, const glm::dvec3& d) {
    const int order = static_cast<int>(std::lround(std::sqrt(c.size())));
    std::vector<double> basis(c.size());
    evaluate_basis(order, d.x, d.y, d.z, basis.data());
    double sum = 0;
    for (std::size_t i = 0; i < c.size(); ++i) sum += c[i] * basis[i];
    return sum;
}

std::vector<double> product(int order, const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out(a.size());
    ShProduct(order).multiply(1, a.data(), b.data(), out.data());
    return out;
}

// The definition, by a rule that is exact for it: shares nothing with the methods but the basis.
std::vector<double> by_quadrature(int order, const std::vector<double>& a,
                                  const std::vector<double>& b) {
    const PolarRule rule = gauss_legendre(2 * order);
    const int columns = 4 * order;
    std::vector<double> out(a.size()), basis(a.size());
    for (std::size_t i = 0; i < rule.cosine.size(); ++i) {
        for (int j = 0; j < columns; ++j) {
            const double phi = 2 * kPi * j / columns;
            const glm::dvec3 d(rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi),
                               rule.cosine[i]);
            evaluate_basis(order, d.x, d.y, d.z, basis.data());
            const double value =
                value_at(a, d) * value_at(b, d) * rule.weight[i] * 2 * kPi / columns;
            for (std::size_t k = 0; k < out.size(); ++k) out[k] += value * basis[k];
        }
    }
    return out;
}

// Orders of every method: all of the tree's, those the rows are specialised for, and others.
const std::vector<int> kOrders = {1, 2, 3, 4, 5, 6, 7, 8, 11};

std::vector<ShProduct> every_method(int order) {
    std::vector<ShProduct> out;
    for (const auto& info : kShProductMethods) {
        if (info.method == ShProductMethod::tree && (order < 2 || order > 5)) continue;
        out.emplace_back(order, info.method);
    }
    return out;
}

TEST(ShProduct, EveryMethodIsTheIntegralThatDefinesIt) {
    for (const int order : kOrders) {
        const auto a = random_vectors<double>(sh_count(order), 1);
        const auto b = random_vectors<double>(sh_count(order), 2);
        const std::vector<double> exact = by_quadrature(order, a, b);
        for (const ShProduct& method : every_method(order)) {
            SCOPED_TRACE(std::string(sh_product_method_name(method.method())));
            std::vector<double> out(a.size());
            method.multiply(1, a.data(), b.data(), out.data());
            for (std::size_t k = 0; k < out.size(); ++k) {
                // The rule here sums 8 order^2 points of order^2 terms each, in no careful way.
                EXPECT_NEAR(out[k], exact[k], 2e-14 * largest(exact)) << order << " " << k;
            }
        }
    }
}

// Every method and target, in float: the sum in double within 2e-6 of the largest coefficient, for
// all counts, layouts, in place, and nothing written beside the results.
TEST(ShProduct, FloatBatchesAreTheirProductsOnEveryTarget) {
    double worst = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : kOrders) {
            const std::size_t size = sh_count(order);
            const TripleProducts triples(order);
            for (const ShProduct& method : every_method(order)) {
                SCOPED_TRACE(std::string(sh_product_method_name(method.method())) + " order " +
                             std::to_string(order));
                for (const std::size_t count : {0, 1, 7, 16, 33}) {
                    const std::size_t stride = count + 3;
                    const auto a = random_vectors<float>(count * size, 3);
                    const auto b = random_vectors<float>(count * size, 4);
                    std::vector<float> out(count * size + 1, 7.0f);
                    std::vector<float> plane_a(stride * size, 5.0f), plane_b = plane_a;
                    std::vector<float> plane_out = plane_a;
                    for (std::size_t v = 0; v < count; ++v) {
                        for (std::size_t k = 0; k < size; ++k) {
                            plane_a[k * stride + v] = a[v * size + k];
                            plane_b[k * stride + v] = b[v * size + k];
                        }
                    }
                    method.multiply(count, a.data(), b.data(), out.data());
                    method.multiply_planes(count, stride, plane_a.data(), plane_b.data(),
                                           plane_out.data());
                    EXPECT_EQ(out.back(), 7.0f);
                    for (std::size_t v = 0; v < count; ++v) {
                        const std::vector<double> x(&a[v * size], &a[v * size] + size);
                        const std::vector<double> y(&b[v * size], &b[v * size] + size);
                        std::vector<double> exact(size);
                        triples.multiply(x.data(), y.data(), exact.data());
                        for (std::size_t k = 0; k < size; ++k) {
                            const double bound = 2e-6 * largest(exact);
                            ASSERT_NEAR(out[v * size + k], exact[k], bound);
                            ASSERT_NEAR(plane_out[k * stride + v], exact[k], bound);
                            worst = std::max(
                                worst, std::abs(out[v * size + k] - exact[k]) / largest(exact));
                        }
                    }
                    for (std::size_t k = 0; k < size; ++k) {
                        for (std::size_t v = count; v < stride; ++v) {
                            ASSERT_EQ(plane_out[k * stride + v], 5.0f);
                        }
                    }
                    auto in_place = b;
                    method.multiply(count, a.data(), in_place.data(), in_place.data());
                    EXPECT_TRUE(std::equal(in_place.begin(), in_place.end(), out.begin()));
                    method.multiply_planes(count, stride, plane_a.data(), plane_b.data(),
                                           plane_a.data());
                    EXPECT_EQ(plane_a, plane_out);
                }
            }
        }
    }
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

TEST(ShProduct, DoubleBatchesAreTheirProductsOnEveryTarget) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : kOrders) {
            const std::size_t size = sh_count(order), count = 11;
            const auto a = random_vectors<double>(count * size, 5);
            const auto b = random_vectors<double>(count * size, 6);
            std::vector<double> exact(a.size()), out(a.size()), planes(a.size());
            ShProduct(order, ShProductMethod::sparse)
                .multiply(count, a.data(), b.data(), exact.data());
            ShProduct(order).multiply(count, a.data(), b.data(), out.data());
            // Planes of one vector each are the vectors, too.
            std::vector<double> plane_a(a.size()), plane_b(a.size());
            for (std::size_t v = 0; v < count; ++v) {
                for (std::size_t k = 0; k < size; ++k) {
                    plane_a[k * count + v] = a[v * size + k];
                    plane_b[k * count + v] = b[v * size + k];
                }
            }
            ShProduct(order).multiply_planes(count, count, plane_a.data(), plane_b.data(),
                                             planes.data());
            for (std::size_t v = 0; v < count; ++v) {
                for (std::size_t k = 0; k < size; ++k) {
                    EXPECT_NEAR(out[v * size + k], exact[v * size + k], 2e-15 * largest(exact));
                    EXPECT_EQ(planes[k * count + v], out[v * size + k]);
                }
            }
        }
    }
}

// Where the degrees of both add up to less than the order, nothing is cut off.
TEST(ShProduct, IsTheProductOfTheValuesWhereItsDegreesFit) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (const auto& [order_a, order_b, order] :
         {std::array<int, 3>{2, 2, 3}, {2, 3, 4}, {3, 3, 5}, {4, 3, 6}, {4, 5, 8}, {1, 6, 6}}) {
        auto a = random_vectors<double>(sh_count(order), 8);
        auto b = random_vectors<double>(sh_count(order), 9);
        std::fill(a.begin() + static_cast<std::ptrdiff_t>(sh_count(order_a)), a.end(), 0.0);
        std::fill(b.begin() + static_cast<std::ptrdiff_t>(sh_count(order_b)), b.end(), 0.0);
        const std::vector<double> c = product(order, a, b);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 d(normal(random), normal(random), normal(random));
            EXPECT_NEAR(value_at(c, d), value_at(a, d) * value_at(b, d), 1e-14);
        }
    }
}

TEST(ShProduct, Commutes) {
    for (const int order : {3, 4, 5, 6, 8}) {
        const auto a = random_vectors<double>(sh_count(order), 10);
        const auto b = random_vectors<double>(sh_count(order), 11);
        const std::vector<double> ab = product(order, a, b), ba = product(order, b, a);
        for (std::size_t k = 0; k < ab.size(); ++k) {
            EXPECT_NEAR(ab[k], ba[k], 1e-15 * largest(ab));
        }
    }
}

TEST(ShProduct, WithTheConstantOneIsTheOtherFactor) {
    for (const int order : {1, 3, 5, 8}) {
        const auto a = random_vectors<double>(sh_count(order), 12);
        std::vector<double> one(sh_count(order));
        one[0] = std::sqrt(4 * kPi);
        const std::vector<double> c = product(order, a, one);
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(c[k], a[k], 2e-15);
    }
}

// int a b = sqrt(4 pi) (a b)_00 = a . b.
TEST(ShProduct, ItsIntegralIsTheDotProduct) {
    for (const int order : {3, 5, 6, 8}) {
        const auto a = random_vectors<double>(sh_count(order), 15);
        const auto b = random_vectors<double>(sh_count(order), 16);
        double dot = 0;
        sh_dot(order, a.data(), 1, b.data(), &dot);
        EXPECT_NEAR(std::sqrt(4 * kPi) * product(order, a, b)[0], dot, 1e-14);
    }
}

TEST(ShProduct, MethodsHaveNames) {
    for (const auto& info : kShProductMethods) {
        EXPECT_EQ(sh_product_method_name(info.method), info.name);
        EXPECT_EQ(sh_product_method_from_name(info.name), info.method);
    }
    EXPECT_FALSE(sh_product_method_from_name("none"));
}

TEST(ShProduct, RefusesOrdersThatTheMethodDoesNotHave) {
    const auto refused = [](int order, ShProductMethod method) {
        try {
            ShProduct(order, method);
        } catch (const Error& error) {
            return error.code() == ErrorCode::usage;
        }
        return false;
    };
    for (const auto& info : kShProductMethods) {
        EXPECT_TRUE(refused(0, info.method));
        EXPECT_TRUE(refused(256, info.method));
    }
    EXPECT_TRUE(refused(1, ShProductMethod::tree));
    EXPECT_TRUE(refused(6, ShProductMethod::tree));
    EXPECT_EQ(ShProduct(5).method(), ShProductMethod::tree);
    EXPECT_EQ(ShProduct(6).method(), ShProductMethod::rows);
}

}  // namespace
}  // namespace airlight
