// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/quadrature.h"
#include "tests/medium/batch_check.h"
#include "tests/sh/exact_basis.h"

namespace airlight {
namespace {

template <class Real>
struct Points {
    std::vector<Real> x, y, z;
    std::vector<double> weight;

    std::size_t count() const { return x.size(); }
    void add(double a, double b, double c, double w) {
        x.push_back(static_cast<Real>(a));
        y.push_back(static_cast<Real>(b));
        z.push_back(static_cast<Real>(c));
        weight.push_back(w);
    }
};

// A rule on the sphere that is exact for products of two functions of this order.
template <class Real>
Points<Real> gauss_points(int order) {
    const PolarRule rule = gauss_legendre(order);
    Points<Real> points;
    const int columns = 2 * order;
    for (std::size_t i = 0; i < rule.angle.size(); ++i) {
        for (int k = 0; k < columns; ++k) {
            const double phi = 2 * kPi * (k + 0.25) / columns;
            points.add(rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi), rule.cosine[i],
                       rule.weight[i] * 2 * kPi / columns);
        }
    }
    return points;
}

template <class Real>
Points<Real> random_points(std::size_t count) {
    Points<Real> points;
    std::mt19937 bits(3);
    std::normal_distribution<double> normal;
    while (points.count() < count) {
        const double a = normal(bits), b = normal(bits), c = normal(bits);
        const double length = std::sqrt(a * a + b * b + c * c);
        points.add(a / length, b / length, c / length, 1);
    }
    return points;
}

template <class Real>
std::vector<Real> random_numbers(std::size_t count, unsigned seed) {
    std::mt19937 bits(seed);
    std::uniform_real_distribution<Real> unit(-1, 1);
    std::vector<Real> values(count);
    for (Real& value : values) value = unit(bits);
    return values;
}

template <class Real>
std::vector<double> project(int order, const Points<Real>& p, int channels,
                            const std::vector<Real>& values) {
    std::vector<double> out(sh_count(order) * channels);
    project_basis_batch(order, p.count(), p.x.data(), p.y.data(), p.z.data(), channels,
                        values.data(), out.data());
    return out;
}

template <class Real>
std::vector<Real> reconstruct(int order, const Points<Real>& p, int channels,
                              const std::vector<Real>& coefficients) {
    std::vector<Real> out(p.count() * channels, Real(-7));
    reconstruct_basis_batch(order, p.count(), p.x.data(), p.y.data(), p.z.data(), channels,
                            coefficients.data(), out.data());
    return out;
}

template <class Real>
class BasisSums : public testing::Test {
  public:
    // 1e-12 is the project's tolerance for double; in float, the 1e-6 of rounded weights and basis.
    static constexpr double kTolerance = sizeof(Real) == 4 ? 2e-6 : 1e-12;
    static constexpr double kEps = std::numeric_limits<Real>::epsilon();
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BasisSums, Precisions);

TYPED_TEST(BasisSums, ProjectionOfTheBasisIsTheUnitMatrix) {
    for (const int order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16}) {
        const auto points = gauss_points<TypeParam>(order);
        const std::size_t slots = sh_count(order), count = points.count();
        std::vector<TypeParam> values(slots * count);
        evaluate_basis_batch(order, count, points.x.data(), points.y.data(), points.z.data(),
                             values.data(), count);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] *= static_cast<TypeParam>(points.weight[k % count]);
        }
        const std::vector<double> gram = project(order, points, static_cast<int>(slots), values);
        for (std::size_t k = 0; k < gram.size(); ++k) {
            ASSERT_NEAR(gram[k], k / slots == k % slots ? 1 : 0, this->kTolerance)
                << order << ": " << k / slots << " " << k % slots;
        }
        // One channel takes another path.
        for (const std::size_t slot : {std::size_t{0}, slots / 2, slots - 1}) {
            const std::vector<TypeParam> own(values.begin() + slot * count,
                                             values.begin() + (slot + 1) * count);
            const std::vector<double> row = project(order, points, 1, own);
            for (std::size_t k = 0; k < slots; ++k) {
                ASSERT_NEAR(row[k], k == slot ? 1 : 0, this->kTolerance) << order << ": " << slot;
            }
        }
    }
}

TYPED_TEST(BasisSums, ReconstructionAndProjectionUndoEachOtherAndKeepTheEnergy) {
    for (const int order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16, 33, 65}) {
        const auto points = gauss_points<TypeParam>(order);
        const std::size_t slots = sh_count(order), count = points.count();
        for (const int channels : {1, 2, 3, 5}) {
            const auto coefficients = random_numbers<TypeParam>(slots * channels, 1);
            std::vector<TypeParam> values = reconstruct(order, points, channels, coefficients);
            std::vector<double> energy(channels), parseval(channels);
            for (std::size_t k = 0; k < values.size(); ++k) {
                const double weight = points.weight[k % count];
                energy[k / count] += weight * values[k] * values[k];
                values[k] = static_cast<TypeParam>(weight * values[k]);
            }
            const std::vector<double> back = project(order, points, channels, values);
            for (std::size_t k = 0; k < back.size(); ++k) {
                parseval[k / slots] += static_cast<double>(coefficients[k]) * coefficients[k];
                // Random errors of the values, at most sqrt(slots) larger than a coefficient.
                ASSERT_NEAR(back[k], coefficients[k], this->kTolerance * std::max(1, order / 8))
                    << order << " " << channels << " " << k;
            }
            for (int c = 0; c < channels; ++c) {
                EXPECT_NEAR(energy[c] / parseval[c], 1, this->kTolerance) << order;
            }
        }
    }
}

TYPED_TEST(BasisSums, ObeyTheAdditionTheorem) {
    // sum over m of Y_lm(a) Y_lm(b) = (2l+1)/(4 pi) P_l(a.b): the reconstruction at b of the
    // degree l of the basis at a.
    const auto points = random_points<TypeParam>(40);
    for (const int order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16}) {
        const std::size_t slots = sh_count(order), count = points.count();
        std::vector<TypeParam> basis(slots * count);
        evaluate_basis_batch(order, count, points.x.data(), points.y.data(), points.z.data(),
                             basis.data(), count);
        for (std::size_t a = 0; a < 5; ++a) {
            std::vector<TypeParam> degrees(slots * order);  // (l, slots)
            for (std::size_t slot = 0; slot < slots; ++slot) {
                degrees[slots * sh_degree(slot).l + slot] = basis[slot * count + a];
            }
            const auto sums = reconstruct(order, points, order, degrees);
            for (std::size_t b = 0; b < count; ++b) {
                const double cosine = double(points.x[a]) * points.x[b] +
                                      double(points.y[a]) * points.y[b] +
                                      double(points.z[a]) * points.z[b];
                double p = 1, previous = 0;
                for (int l = 0; l < order; ++l) {
                    const double scale = (2 * l + 1) / (4 * kPi);
                    // Two factors of the accuracy of basis_batch.h, and the rounding of |a| |b|,
                    // which P_l at +-1 takes l(l+1)/2-fold.
                    ASSERT_NEAR(sums[l * count + b], scale * p,
                                (2 * (3 + 2 * l) + l * (l + 1)) * this->kEps * scale)
                        << order << " " << l;
                    const double next = ((2 * l + 1) * cosine * p - l * previous) / (l + 1);
                    previous = p;
                    p = next;
                }
            }
        }
    }
}

TYPED_TEST(BasisSums, AgreeWithSlowSumsAtEveryLengthOnEveryTarget) {
    const auto all = random_points<TypeParam>(700);
    std::vector<std::vector<long double>> basis;
    for (std::size_t i = 0; i < all.count(); ++i) {
        basis.push_back(exact_basis(16, all.x[i], all.y[i], all.z[i]));
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : {1, 4, 6, 16}) {
            const std::size_t slots = sh_count(order);
            for (const int channels : {1, 2, 3}) {
                for (const std::size_t count : {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 15u, 16u, 17u,
                                                31u, 33u, 63u, 64u, 65u, 100u, 699u}) {
                    // From index 1 on: of no alignment but a number's.
                    const auto values = random_numbers<TypeParam>(count * channels + 1, 5);
                    const auto coefficients = random_numbers<TypeParam>(slots * channels + 1, 6);
                    std::vector<double> sums(slots * channels, 0.25);
                    std::vector<TypeParam> out(count * channels + 2, TypeParam(-7));
                    project_basis_batch(order, count, all.x.data() + 1, all.y.data() + 1,
                                        all.z.data() + 1, channels, values.data() + 1, sums.data());
                    reconstruct_basis_batch(order, count, all.x.data() + 1, all.y.data() + 1,
                                            all.z.data() + 1, channels, coefficients.data() + 1,
                                            out.data() + 1);
                    // A random sum's error, far under count eps.
                    const double tolerance = 4 * this->kEps * order;
                    for (std::size_t k = 0; k < sums.size(); ++k) {
                        long double exact = 0.25;
                        for (std::size_t i = 0; i < count; ++i) {
                            exact += values[1 + k / slots * count + i] * basis[i + 1][k % slots];
                        }
                        ASSERT_NEAR(sums[k], static_cast<double>(exact),
                                    tolerance * (1 + std::sqrt(static_cast<double>(count))))
                            << order << " " << channels << " " << count << " " << k;
                    }
                    for (std::size_t k = 0; k < count * channels; ++k) {
                        long double exact = 0;
                        for (std::size_t slot = 0; slot < slots; ++slot) {
                            exact += coefficients[1 + k / count * slots + slot] *
                                     basis[k % count + 1][slot];
                        }
                        ASSERT_NEAR(out[k + 1], static_cast<double>(exact), tolerance * order)
                            << order << " " << channels << " " << count << " " << k;
                    }
                    EXPECT_EQ(out.front(), TypeParam(-7));
                    EXPECT_EQ(out.back(), TypeParam(-7));
                }
            }
        }
    }
}

TYPED_TEST(BasisSums, ReconstructionDependsOnNeitherPlaceNorCount) {
    const auto points = random_points<TypeParam>(120);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        const ForcedTarget forced(target);
        for (const int order : {5, 10}) {
            for (const int channels : {1, 3}) {
                const auto coefficients = random_numbers<TypeParam>(sh_count(order) * channels, 7);
                const auto whole = reconstruct(order, points, channels, coefficients);
                for (std::size_t count = 1; count <= 40; ++count) {
                    const std::size_t first = count % 9;
                    std::vector<TypeParam> part(count * channels);
                    reconstruct_basis_batch(order, count, points.x.data() + first,
                                            points.y.data() + first, points.z.data() + first,
                                            channels, coefficients.data(), part.data());
                    for (std::size_t k = 0; k < part.size(); ++k) {
                        ASSERT_EQ(part[k], whole[k / count * points.count() + first + k % count])
                            << hwy::TargetName(target) << " " << order << " " << count;
                    }
                }
            }
        }
    }
}

TYPED_TEST(BasisSums, WhatIsNoDirectionSpoilsWhatItTouchesAndNoMore) {
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    auto points = random_points<TypeParam>(50);
    points.y[20] = nan;
    for (const int order : {6, 12, 65}) {
        for (const int channels : {1, 2}) {
            auto values = random_numbers<TypeParam>(points.count() * channels, 8);
            for (const double sum : project(order, points, channels, values)) {
                EXPECT_TRUE(std::isnan(sum));
            }
            const auto coefficients = random_numbers<TypeParam>(sh_count(order) * channels, 9);
            const auto out = reconstruct(order, points, channels, coefficients);
            for (std::size_t k = 0; k < out.size(); ++k) {
                EXPECT_EQ(std::isnan(out[k]), k % points.count() == 20) << order << " " << k;
            }
        }
        // A value that is NaN is its channel's alone.
        const auto clean = random_points<TypeParam>(50);
        auto values = random_numbers<TypeParam>(clean.count() * 3, 8);
        values[clean.count() + 17] = nan;
        const std::vector<double> sums = project(order, clean, 3, values);
        for (std::size_t k = 0; k < sums.size(); ++k) {
            EXPECT_EQ(std::isnan(sums[k]), k / sh_count(order) == 1) << order << " " << k;
        }
    }
}

TYPED_TEST(BasisSums, OfOrderZeroOrNoChannelAreEmpty) {
    const auto points = random_points<TypeParam>(5);
    for (const int channels : {0, 1, 2}) {
        EXPECT_TRUE(project(0, points, channels, random_numbers<TypeParam>(10, 1)).empty());
        for (const TypeParam value : reconstruct<TypeParam>(0, points, channels, {})) {
            EXPECT_EQ(value, 0);
        }
    }
    EXPECT_TRUE(project<TypeParam>(6, points, 0, {}).empty());
    EXPECT_TRUE(reconstruct<TypeParam>(6, points, 0, {}).empty());
}

}  // namespace
}  // namespace airlight
