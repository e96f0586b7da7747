// SPDX-License-Identifier: Apache-2.0
// What every function on the sphere obeys, for random ones of every small order and both
// precisions. That of the basis itself is in basis_sums_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>
#include <vector>

#include "sh/index.h"
#include "sh/product.h"
#include "sh/product_matrix.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/sh/exact_basis.h"

namespace airlight {
namespace {

constexpr std::size_t kVectors = 5;
constexpr int kOrders[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16};

template <class Real>
class ShProperties : public testing::Test {
  public:
    static constexpr double kEps = std::numeric_limits<Real>::epsilon();

    std::vector<Real> vectors(int order) {
        std::vector<Real> out(kVectors * sh_count(order));
        for (Real& value : out) value = uniform_(random_);
        return out;
    }
    glm::dquat turn() {
        std::normal_distribution<double> normal;
        return glm::normalize(
            glm::dquat(normal(random_), normal(random_), normal(random_), normal(random_)));
    }
    std::vector<double> direction() {
        std::normal_distribution<double> normal;
        return {normal(random_), normal(random_), normal(random_)};
    }

  private:
    std::mt19937 random_{17};
    std::uniform_real_distribution<Real> uniform_{-1, 1};
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ShProperties, Precisions);

template <class Real>
std::vector<Real> rotated(const ShRotation& rotation, const std::vector<Real>& in) {
    std::vector<Real> out(in.size());
    rotation.rotate(kVectors, in.data(), out.data());
    return out;
}

template <class Real>
std::vector<Real> multiplied(const ShProduct& product, const std::vector<Real>& a,
                             const std::vector<Real>& b) {
    std::vector<Real> out(a.size());
    product.multiply(kVectors, a.data(), b.data(), out.data());
    return out;
}

// In the order of kShProductMethods; trees are for few orders.
std::vector<ShProduct> products(int order) {
    std::vector<ShProduct> out;
    for (const auto& info : kShProductMethods) {
        if (info.method == ShProductMethod::tree && (order < 2 || order > 5)) continue;
        out.emplace_back(order, info.method);
    }
    return out;
}

// A vector of a lower order, filled up with zeros.
template <class Real>
std::vector<Real> extended(const std::vector<Real>& in, int order, int to) {
    std::vector<Real> out(kVectors * sh_count(to));
    for (std::size_t v = 0; v < kVectors; ++v) {
        std::copy_n(&in[v * sh_count(order)], sh_count(order), &out[v * sh_count(to)]);
    }
    return out;
}

template <class Real>
double largest(const std::vector<Real>& values) {
    double size = 0;
    for (const Real value : values) size = std::max(size, std::abs(static_cast<double>(value)));
    return size;
}

// The largest difference over the largest number.
template <class Real>
double difference(const std::vector<Real>& a, const std::vector<Real>& b) {
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double apart = std::abs(static_cast<double>(a[k]) - b[k]);
        if (!(apart <= worst)) worst = apart;
    }
    return worst / largest(a);
}

template <class Real>
long double value_at(const Real* c, const std::vector<long double>& basis) {
    long double sum = 0;
    for (std::size_t k = 0; k < basis.size(); ++k) sum += c[k] * basis[k];
    return sum;
}

TYPED_TEST(ShProperties, RotationKeepsTheEnergyOfEveryDegree) {
    for (const int order : kOrders) {
        const auto before = this->vectors(order);
        const auto after = rotated(ShRotation(order, this->turn()), before);
        for (std::size_t v = 0; v < kVectors; ++v) {
            for (int l = 0; l < order; ++l) {
                double first = 0, second = 0;
                for (std::size_t k = sh_index(l, -l); k <= sh_index(l, l); ++k) {
                    first += std::pow(static_cast<double>(before[v * sh_count(order) + k]), 2);
                    second += std::pow(static_cast<double>(after[v * sh_count(order) + k]), 2);
                }
                // Sums of up to 31 products, rounded at random.
                EXPECT_NEAR(second / first, 1, 8 * this->kEps) << order << " " << l;
            }
        }
    }
}

// R(f g) = (R f) (R g), what is cut off from the order on included: a rotation mixes no degrees.
TYPED_TEST(ShProperties, ProductsTurnWithTheirFactors) {
    for (const int order : kOrders) {
        const ShRotation rotation(order, this->turn());
        const auto a = this->vectors(order), b = this->vectors(order);
        for (const ShProduct& product : products(order)) {
            const auto first = rotated(rotation, multiplied(product, a, b));
            const auto second = multiplied(product, rotated(rotation, a), rotated(rotation, b));
            // Measured: up to 6 + order, by the grid, whose sums are the longest.
            EXPECT_LT(difference(first, second), 2 * (6 + order) * this->kEps)
                << order << " " << sh_product_method_name(product.method());
        }
    }
}

// The same for the matrix of products with one function.
TYPED_TEST(ShProperties, MatricesOfProductsTurnWithTheirLight) {
    for (const int order : kOrders) {
        const ShRotation rotation(order, this->turn());
        const TripleProducts triples(order);
        const auto lights = this->vectors(order), v = this->vectors(order);
        const auto turned = rotated(rotation, lights);
        std::vector<TypeParam> first(v.size()), second(v.size());
        ShProductMatrix(triples, lights.data()).multiply(kVectors, v.data(), first.data());
        ShProductMatrix(triples, turned.data())
            .multiply(kVectors, rotated(rotation, v).data(), second.data());
        EXPECT_LT(difference(rotated(rotation, first), second), 16 * this->kEps) << order;
    }
}

TYPED_TEST(ShProperties, ConvolutionCommutesWithRotation) {
    for (const int order : kOrders) {
        const ShRotation rotation(order, this->turn());
        const auto numbers = this->vectors(order);
        const std::vector<double> lambda(numbers.begin(), numbers.begin() + order);
        auto first = this->vectors(order);
        auto second = rotated(rotation, first);
        zonal_convolve(lambda, kVectors, first.data());
        zonal_convolve(lambda, kVectors, second.data());
        EXPECT_LT(difference(rotated(rotation, first), second), 8 * this->kEps) << order;
    }
}

// Two functions of order n have a product of order 2n - 1, whose values are theirs, multiplied.
TYPED_TEST(ShProperties, ProductsHaveTheProductOfTheValues) {
    for (const int factor_order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
        const int order = 2 * factor_order - 1;
        const auto a = extended(this->vectors(factor_order), factor_order, order);
        const auto b = extended(this->vectors(factor_order), factor_order, order);
        for (const ShProduct& product : products(order)) {
            const auto c = multiplied(product, a, b);
            for (int i = 0; i < 20; ++i) {
                const std::vector<double> d = this->direction();
                const auto basis = exact_basis(order, d[0], d[1], d[2]);
                for (std::size_t v = 0; v < kVectors; ++v) {
                    const std::size_t at = v * basis.size();
                    const auto expected =
                        static_cast<double>(value_at(&a[at], basis) * value_at(&b[at], basis));
                    // order^2 coefficients whose errors, some eps of the largest, meet a basis of
                    // the norm order / sqrt(4 pi).
                    EXPECT_NEAR(static_cast<double>(value_at(&c[at], basis)), expected,
                                4 * this->kEps * order * largest(c))
                        << order << " " << sh_product_method_name(product.method());
                }
            }
        }
    }
}

}  // namespace
}  // namespace airlight
