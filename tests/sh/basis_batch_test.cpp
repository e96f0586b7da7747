// SPDX-License-Identifier: Apache-2.0
#include "sh/basis_batch.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "tests/medium/batch_check.h"
#include "tests/sh/exact_basis.h"

namespace airlight {
namespace {

template <class Real>
struct Points {
    std::vector<Real> x, y, z;

    void add(double a, double b, double c) {
        x.push_back(static_cast<Real>(a));
        y.push_back(static_cast<Real>(b));
        z.push_back(static_cast<Real>(c));
    }
    std::size_t count() const { return x.size(); }
};

// Axes, faces and edges of the cube, both sides of the equator and of the poles, and at random.
template <class Real>
Points<Real> points_over_the_sphere() {
    Points<Real> points;
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            for (int k = -1; k <= 1; ++k) {
                const double length = std::sqrt(double(i * i + j * j + k * k));
                if (length > 0) points.add(i / length, j / length, k / length);
            }
        }
    }
    std::mt19937_64 bits(11);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 1200; ++i) {
        const double phi = 2 * kPi * unit(bits), small = std::pow(10.0, -9 * unit(bits));
        const double sign = i % 2 == 0 ? 1 : -1;
        double theta = std::acos(sign * unit(bits));
        if (i % 3 == 1) theta = sign > 0 ? small : kPi - small;
        if (i % 12 == 2) theta = kPi / 2 + sign * small;
        points.add(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                   std::cos(theta));
    }
    return points;
}

template <class Real>
std::vector<Real> evaluate(int order, const Points<Real>& points, std::size_t first,
                           std::size_t count, std::size_t stride) {
    std::vector<Real> out(sh_count(order) * stride, Real(-7));
    evaluate_basis_batch(order, count, points.x.data() + first, points.y.data() + first,
                         points.z.data() + first, out.data(), stride);
    return out;
}

template <class Real>
std::vector<Real> evaluate(int order, const Points<Real>& points) {
    return evaluate(order, points, 0, points.count(), points.count());
}

template <class Real>
bool same(Real a, Real b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

// What basis_batch.h promises.
double bound(int order, int l) {
    return order <= 8 ? 3 + 2 * l : 3 + 0.5 * l;
}

template <class Real>
class BasisBatch : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BasisBatch, Precisions);

TYPED_TEST(BasisBatch, MeetsItsErrorOverTheSphereOnEveryTarget) {
    const double eps = std::numeric_limits<TypeParam>::epsilon();
    const auto points = points_over_the_sphere<TypeParam>();
    std::vector<std::vector<long double>> exact;
    for (std::size_t i = 0; i < points.count(); ++i) {
        exact.push_back(exact_basis(64, points.x[i], points.y[i], points.z[i]));
    }
    for (const int order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 31, 64}) {
        std::vector<TypeParam> first[2];
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            SCOPED_TRACE(hwy::TargetName(target));
            const ForcedTarget forced(target);
            const std::vector<TypeParam> values = evaluate(order, points);
            for (std::size_t k = 0; k < values.size(); ++k) {
                const std::size_t slot = k / points.count(), i = k % points.count();
                const int l = sh_degree(slot).l;
                const double unit = eps * std::sqrt((2 * l + 1) / (4 * kPi));
                const double error = static_cast<double>(values[k] - exact[i][slot]) / unit;
                ASSERT_LE(std::abs(error), bound(order, l))
                    << "order " << order << " slot " << slot << " at " << points.x[i] << " "
                    << points.y[i] << " " << points.z[i];
            }
            std::vector<TypeParam>& kind = first[has_fused_multiply_add(target)];
            if (kind.empty()) kind = values;
            EXPECT_TRUE(std::equal(kind.begin(), kind.end(), values.begin(), same<TypeParam>));
        }
    }
}

TYPED_TEST(BasisBatch, AgreesWithEvaluateBasis) {
    const double eps = std::numeric_limits<TypeParam>::epsilon();
    const auto points = points_over_the_sphere<TypeParam>();
    for (const int order : {5, 12, 40, 70}) {
        const std::vector<TypeParam> values = evaluate(order, points);
        std::vector<double> single(sh_count(order));
        for (std::size_t i = 0; i < points.count(); ++i) {
            evaluate_basis(order, double(points.x[i]), double(points.y[i]), double(points.z[i]),
                           single.data());
            for (std::size_t slot = 0; slot < single.size(); ++slot) {
                const int l = sh_degree(slot).l;
                const double unit = eps * std::sqrt((2 * l + 1) / (4 * kPi));
                // The batch's error and, in double, that of evaluate_basis.
                ASSERT_NEAR(values[slot * points.count() + i], single[slot],
                            (bound(order, l) + 4 + 1.5 * l) * unit)
                    << order << " " << slot;
            }
        }
    }
}

TYPED_TEST(BasisBatch, IsExactlyZeroAtThePolesButForTheZonalSlots) {
    Points<TypeParam> points;
    for (const double z : {1.0, -1.0, 1e-30, -3.0}) points.add(0, 0, z);
    for (const int order : {6, 16}) {
        const std::vector<TypeParam> values = evaluate(order, points);
        for (std::size_t slot = 0; slot < sh_count(order); ++slot) {
            const ShDegree degree = sh_degree(slot);
            const double zonal = std::sqrt((2 * degree.l + 1) / (4 * kPi));
            for (std::size_t i = 0; i < points.count(); ++i) {
                const TypeParam value = values[slot * points.count() + i];
                if (degree.m != 0) {
                    EXPECT_EQ(value, 0);
                } else {
                    const double sign = points.z[i] < 0 && degree.l % 2 != 0 ? -1 : 1;
                    EXPECT_NEAR(value / (sign * zonal), 1,
                                bound(order, degree.l) * std::numeric_limits<TypeParam>::epsilon());
                }
            }
        }
    }
}

TYPED_TEST(BasisBatch, DependsOnNeitherPlaceNorCountNorNeighbours) {
    auto points = points_over_the_sphere<TypeParam>();
    // Neighbours of every kind among them.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    points.add(0, nan, 0);
    points.add(1, 2, 3);
    points.add(0, 0, 0);
    for (int k = 0; k < 3; ++k) {
        for (std::vector<TypeParam>* v : {&points.x, &points.y, &points.z}) {
            std::rotate(v->begin() + 3 + 5 * k, v->end() - 1, v->end());
        }
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : {1, 3, 6, 9}) {
            const std::vector<TypeParam> whole = evaluate(order, points, 0, 60, 60);
            for (std::size_t count = 0; count <= 35; ++count) {
                for (std::size_t first = 0; first < 18; ++first) {
                    const std::size_t stride = count + first % 3;
                    const std::vector<TypeParam> part =
                        evaluate(order, points, first, count, stride);
                    for (std::size_t k = 0; k < part.size(); ++k) {
                        const std::size_t slot = k / stride, i = k % stride;
                        ASSERT_TRUE(
                            same(part[k], i < count ? whole[slot * 60 + first + i] : TypeParam(-7)))
                            << order << ": " << count << " from " << first << ", " << i;
                    }
                }
            }
        }
    }
}

TYPED_TEST(BasisBatch, LengthDoesNotCount) {
    constexpr bool kSingle = std::is_same_v<TypeParam, float>;
    const double least = std::numeric_limits<TypeParam>::denorm_min();
    for (const int order : {5, 12}) {
        Points<TypeParam> points;
        points.add(2.0 / 7, -3.0 / 7, 6.0 / 7);
        for (const double length :
             {1.001, 1 - 1e-6, 0.5, 7.0, 1e-5, 1e8, kSingle ? 1e-18 : 1e-150,
              kSingle ? 4e37 : 1.5e308 / 7, kSingle ? 1e-30 : 1e-290, least}) {
            points.add(2 * length, -3 * length, 6 * length);
        }
        const std::vector<TypeParam> values = evaluate(order, points);
        for (std::size_t i = 0; i < points.count(); ++i) {
            const std::vector<long double> exact =
                exact_basis(order, points.x[i] / static_cast<long double>(least),
                            points.y[i] / static_cast<long double>(least),
                            points.z[i] / static_cast<long double>(least));
            for (std::size_t slot = 0; slot < exact.size(); ++slot) {
                const int l = sh_degree(slot).l;
                const double unit =
                    std::numeric_limits<TypeParam>::epsilon() * std::sqrt((2 * l + 1) / (4 * kPi));
                ASSERT_NEAR(values[slot * points.count() + i], static_cast<double>(exact[slot]),
                            bound(order, l) * unit)
                    << points.z[i] << " " << slot;
            }
        }
    }
}

TYPED_TEST(BasisBatch, HasAnAnswerForWhatIsNoDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    Points<TypeParam> points;
    points.add(0, 0, 1);
    points.add(0, 0, 0);
    points.add(-0.0, 0, -0.0);
    const std::size_t finite = points.count();
    for (const double bad : {nan, inf, -inf}) {
        points.add(bad, 0, 1);
        points.add(0, bad, 1);
        points.add(0.6, 0.8, bad);
    }
    for (const int order : {1, 4, 12, 66}) {
        const std::vector<TypeParam> values = evaluate(order, points);
        for (std::size_t slot = 0; slot < sh_count(order); ++slot) {
            const TypeParam* row = values.data() + slot * points.count();
            EXPECT_EQ(row[1], row[0]);
            EXPECT_EQ(row[2], row[0]);
            for (std::size_t i = finite; i < points.count(); ++i) {
                EXPECT_TRUE(std::isnan(row[i])) << order << " " << slot << " " << i;
            }
        }
    }
    EXPECT_TRUE(evaluate(0, points).empty());
}

}  // namespace
}  // namespace airlight
