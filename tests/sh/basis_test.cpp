// SPDX-License-Identifier: Apache-2.0
#include "sh/basis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "core/constants.h"
#include "sh/index.h"
#include "sh/quadrature.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

using Direction = std::array<double, 3>;

std::vector<double> basis(int order, const Direction& d) {
    std::vector<double> out(sh_count(order), -7.0);
    evaluate_basis(order, d[0], d[1], d[2], out.data());
    return out;
}

// The root mean square of Y_lm, in which errors are measured.
double scale(int l) {
    return std::sqrt((2.0 * l + 1) / (4 * kPi));
}

TEST(Basis, MatchesGoldenValuesAtEveryOrder) {
    // reference_rows has x, y, z, l, m, Y from make_basis.py.
    std::map<Direction, std::vector<std::vector<double>>> rows;
    for (const auto& row : reference_rows("basis.csv", 6, 580)) {
        rows[{row[0], row[1], row[2]}].push_back(row);
    }
    ASSERT_EQ(rows.size(), 11u);
    for (const auto& [direction, values] : rows) {
        for (const int order : {8, 16, 17, 512, 4096}) {
            const std::vector<double> y = basis(order, direction);
            for (const auto& row : values) {
                const int l = static_cast<int>(row[3]), m = static_cast<int>(row[4]);
                if (l >= order) continue;
                // What basis.h promises.
                EXPECT_NEAR(y[sh_index(l, m)], row[5], (4 + 1.5 * l) * kEps * scale(l))
                    << direction[0] << " " << direction[1] << " " << direction[2] << " order "
                    << order << " l " << l << " m " << m;
            }
        }
    }
}

TEST(Basis, LightsFromTheAxesLightTheirSlots) {
    const double y1 = std::sqrt(3 / (4 * kPi));
    EXPECT_NEAR(y1, 0.488603, 1e-6);
    // In the world frame X, Y, Z are slots 3, 1, 2; in the map frame 1, 2, 3.
    const std::size_t world_slot[3] = {3, 1, 2}, map_slot[3] = {1, 2, 3};
    for (const int order : {2, 16, 17}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double sign : {1.0, -1.0}) {
                Direction light{0, 0, 0};
                light[axis] = sign;
                const std::vector<double> world = basis(order, light);
                const std::vector<double> map = basis(order, {light[2], light[0], light[1]});
                for (std::size_t slot = 1; slot < 4; ++slot) {
                    EXPECT_NEAR(world[slot], slot == world_slot[axis] ? sign * y1 : 0, 1e-15);
                    EXPECT_NEAR(map[slot], slot == map_slot[axis] ? sign * y1 : 0, 1e-15);
                }
            }
        }
    }
}

TEST(Basis, SignsFollowThePolynomials) {
    // Y_2m of (x, y, z), m = -2 ... 2: sqrt(15/4pi) (xy, yz, (3z^2-1)/(2 sqrt 3), xz, (x^2-y^2)/2).
    const double x = 2.0 / 7, y = -3.0 / 7, z = 6.0 / 7, c = std::sqrt(15 / (4 * kPi));
    for (const int order : {3, 17}) {
        const std::vector<double> value = basis(order, {x, y, z});
        EXPECT_NEAR(value[4], c * x * y, 1e-15);
        EXPECT_NEAR(value[5], c * y * z, 1e-15);
        EXPECT_NEAR(value[6], c * (3 * z * z - 1) / (2 * std::sqrt(3.0)), 1e-15);
        EXPECT_NEAR(value[7], c * x * z, 1e-15);
        EXPECT_NEAR(value[8], c * (x * x - y * y) / 2, 1e-15);
    }
}

TEST(Basis, IsOrthonormal) {
    constexpr int kOrder = 32, kColumns = 64;
    const PolarRule rule = gauss_legendre(kOrder);
    const std::size_t count = sh_count(kOrder);
    std::vector<double> gram(count * count, 0.0);
    for (std::size_t i = 0; i < rule.angle.size(); ++i) {
        for (int k = 0; k < kColumns; ++k) {
            const double phi = 2 * kPi * (k + 0.25) / kColumns;
            const std::vector<double> y =
                basis(kOrder,
                      {rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi), rule.cosine[i]});
            const double weight = rule.weight[i] * 2 * kPi / kColumns;
            for (std::size_t a = 0; a < count; ++a) {
                for (std::size_t b = 0; b <= a; ++b) gram[a * count + b] += weight * y[a] * y[b];
            }
        }
    }
    // (4 + 1.5 l) eps in each factor, averaged over the sphere.
    const double tolerance = 2 * (4 + 1.5 * kOrder) * kEps;
    for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
            ASSERT_NEAR(gram[a * count + b], a == b ? 1 : 0, tolerance) << a << " " << b;
        }
    }
}

// P_l(cos angle), l < order, in extended precision.
std::vector<double> legendre(int order, long double angle) {
    const long double x = std::cos(angle);
    std::vector<double> result;
    long double p = 1, previous = 0;
    for (int l = 0; l < order; ++l) {
        result.push_back(static_cast<double>(p));
        const long double next = ((2 * l + 1) * x * p - l * previous) / (l + 1);
        previous = p;
        p = next;
    }
    return result;
}

TEST(Basis, ObeysTheAdditionTheoremToOrder4096) {
    constexpr int kOrder = 4096;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<std::array<Direction, 2>> pairs = {{{{0, 0, 1}, {1e-5, 0, 1}}},
                                                   {{{1e-310, 1e-9, -1}, {1e-4, 1e-4, -1}}}};
    for (int k = 0; k < 3; ++k) {
        pairs.push_back({{{normal(random), normal(random), normal(random)},
                          {normal(random), normal(random), normal(random)}}});
    }
    for (const auto& [a, b] : pairs) {
        using Long = long double;
        const Long cross[3] = {Long(a[1]) * b[2] - Long(a[2]) * b[1],
                               Long(a[2]) * b[0] - Long(a[0]) * b[2],
                               Long(a[0]) * b[1] - Long(a[1]) * b[0]};
        const Long dot = Long(a[0]) * b[0] + Long(a[1]) * b[1] + Long(a[2]) * b[2];
        const Long angle = std::atan2(std::hypot(cross[0], cross[1], cross[2]), dot);
        const std::vector<double> p = legendre(kOrder, angle);
        const std::vector<double> ya = basis(kOrder, a), yb = basis(kOrder, b);
        for (int l = 0; l < kOrder; ++l) {
            double product = 0, square = 0;
            for (std::size_t i = sh_index(l, -l); i <= sh_index(l, l); ++i) {
                product += ya[i] * yb[i];
                square += ya[i] * ya[i];
            }
            // Two directions, each turned by the rounding of its angles, 2 eps at most.
            const double tolerance = (20 + 4 * l) * kEps * (2 * l + 1) / (4 * kPi);
            ASSERT_NEAR(product, (2 * l + 1) / (4 * kPi) * p[static_cast<std::size_t>(l)],
                        tolerance)
                << l;
            ASSERT_NEAR(square, (2 * l + 1) / (4 * kPi), tolerance) << l;
        }
    }
}

TEST(Basis, VanishesAtThePolesButForTheZonalSlots) {
    for (const double z : {1.0, -1.0, 5e-324, -1e300}) {
        for (const int order : {5, 16, 17, 1024}) {
            const std::vector<double> y = basis(order, {0, 0, z});
            for (int l = 0; l < order; ++l) {
                const double sign = z < 0 && l % 2 != 0 ? -1 : 1;
                const double tolerance = (order <= 16 ? 16 : 2) * kEps * scale(l);
                for (int m = -l; m <= l; ++m) {
                    ASSERT_NEAR(y[sh_index(l, m)], m == 0 ? sign * scale(l) : 0,
                                m == 0 ? tolerance : 0)
                        << z << " " << l << " " << m;
                }
            }
        }
    }
}

TEST(Basis, DependsOnTheDirectionAlone) {
    for (const Direction& d : {Direction{1, 2, -2}, Direction{-3, 0, 4}, Direction{1, 1, 0}}) {
        for (const int order : {9, 70}) {
            const std::vector<double> unit = basis(order, d);
            for (const double factor : {4.9406564584124654e-324, 1e-320, 1e-160, 3.0, 4e307}) {
                const std::vector<double> y =
                    basis(order, {d[0] * factor, d[1] * factor, d[2] * factor});
                for (std::size_t i = 0; i < y.size(); ++i) {
                    const int l = sh_degree(i).l;
                    // 1e-320 times an integer below 5 is exact, as are the denormals.
                    ASSERT_NEAR(y[i], unit[i], (4 + 1.5 * l) * kEps * scale(l)) << factor;
                }
            }
        }
    }
}

TEST(Basis, HasAnAnswerForWhatIsNoDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const int order : {1, 4, 40}) {
        EXPECT_EQ(basis(order, {0, 0, 0}), basis(order, {0, 0, 1}));
        for (const Direction& d :
             {Direction{nan, 0, 1}, Direction{0, inf, 1}, Direction{0, 0, -inf}}) {
            for (const double value : basis(order, d)) EXPECT_TRUE(std::isnan(value));
        }
    }
    double untouched = 3;
    evaluate_basis(0, 0.0, 0.0, 1.0, &untouched);
    EXPECT_EQ(untouched, 3);
}

TEST(Basis, RoundsTheDoubleResultToFloat) {
    for (const int order : {4, 16, 17, 100}) {
        const float x = 0.3f, y = -1e-3f, z = 0.7f;
        std::vector<float> single(sh_count(order));
        evaluate_basis(order, x, y, z, single.data());
        const std::vector<double> reference = basis(order, {x, y, z});
        for (std::size_t i = 0; i < single.size(); ++i) {
            ASSERT_EQ(single[i], static_cast<float>(reference[i])) << order << " " << i;
        }
    }
}

TEST(NormalizedLegendre, HoldsTheNormWhereTheSeedUnderflows) {
    // sum over m of P_lm^2 (2 for m > 0) = (2l+1)/4pi. At theta = 0.3 the seeds of m > 600 are
    // under 1e-308, those of l = 4095 reach 10^-2000, and a column that starts as 0 stays 0.
    constexpr int kOrder = 4096;
    for (const double theta : {0.3, 0.75, 0.8, 1.2, 3.0}) {
        std::vector<double> sum(kOrder, 0.0), column(kOrder);
        for (int m = 0; m < kOrder; ++m) {
            normalized_legendre(kOrder, std::cos(theta), std::sin(theta), m, column.data());
            for (int l = m; l < kOrder; ++l) {
                const double p = column[static_cast<std::size_t>(l - m)];
                ASSERT_TRUE(std::isfinite(p));
                sum[static_cast<std::size_t>(l)] += (m == 0 ? 1 : 2) * p * p;
            }
        }
        for (int l = 0; l < kOrder; ++l) {
            // Measured: 34 eps at most, from 4096 steps of random rounding in each column.
            ASSERT_NEAR(sum[static_cast<std::size_t>(l)] / (scale(l) * scale(l)), 1, 64 * kEps)
                << theta << " " << l;
        }
    }
}

TEST(NormalizedLegendre, TrustsTheSineBesideThePole) {
    // cos(theta) rounds to 1; the column m = 1 still grows like theta.
    const double theta = 1e-9;
    std::vector<double> column(10);
    normalized_legendre(10, 1.0, theta, 1, column.data() + 1);
    for (int l = 1; l < 10; ++l) {
        // P_l1 = sqrt((2l+1)/(4 pi) / (l(l+1))) l(l+1)/2 theta (1 + O(l^2 theta^2)).
        const double expected = scale(l) * std::sqrt(l * (l + 1.0)) / 2 * theta;
        EXPECT_NEAR(column[static_cast<std::size_t>(l)] / expected, 1, 16 * kEps) << l;
    }
    normalized_legendre(3, 1.0, 0.0, 5, nullptr);
}

}  // namespace
}  // namespace airlight
