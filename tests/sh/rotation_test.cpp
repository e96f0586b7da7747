// SPDX-License-Identifier: Apache-2.0
#include "sh/rotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/quadrature.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

std::vector<double> basis(int order, const glm::dvec3& d) {
    std::vector<double> out(sh_count(order));
    evaluate_basis(order, d.x, d.y, d.z, out.data());
    return out;
}

glm::dquat random_quaternion(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(
        glm::dquat(normal(random), normal(random), normal(random), normal(random)));
}

glm::dvec3 random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

template <class T>
std::vector<T> random_vectors(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<T> out(count);
    for (T& value : out) value = static_cast<T>(uniform(random));
    return out;
}

// Everything that a rotation may be: none, about axes, by tiny angles, half turns, any.
std::vector<glm::dquat> rotations() {
    std::vector<glm::dquat> out = {glm::dquat(1, 0, 0, 0), glm::dquat(0, 1, 0, 0),
                                   glm::dquat(0, 0, 1, 0), glm::dquat(0, 0, 0, 1)};
    for (const double angle : {1e-9, 1e-3, 0.5 * kPi, 3.0, kPi - 1e-9}) {
        out.push_back(glm::angleAxis(angle, glm::dvec3(0, 1, 0)));
        out.push_back(glm::angleAxis(angle, glm::normalize(glm::dvec3(1, -2, 3))));
    }
    std::mt19937 random(7);
    for (int i = 0; i < 4; ++i) out.push_back(random_quaternion(random));
    return out;
}

double largest_difference(const ShRotation& a, const ShRotation& b) {
    double worst = 0;
    for (int l = 0; l < a.order(); ++l) {
        for (int i = 0; i < (2 * l + 1) * (2 * l + 1); ++i) {
            worst = std::max(worst, std::abs(a.block(l)[i] - b.block(l)[i]));
        }
    }
    return worst;
}

// A light at +X turned by +90 degrees about +Y (right-handed) is a light at -Z: slot 3 goes to slot
// 2 with the sign turned. The passive reading would put it at +Z.
TEST(ShRotation, MovesALightToWhereTheRotationMovesItsDirection) {
    const glm::dquat quarter = glm::angleAxis(0.5 * kPi, glm::dvec3(0, 1, 0));
    ASSERT_LT(glm::length(quarter * glm::dvec3(1, 0, 0) - glm::dvec3(0, 0, -1)), 1e-15);
    for (const ShRotation& rotation :
         {ShRotation(3, quarter), ShRotation(3, glm::mat3_cast(quarter))}) {
        const std::vector<double> light = basis(3, {1, 0, 0});
        std::vector<double> turned(9);
        rotation.rotate(1, light.data(), turned.data());
        EXPECT_NEAR(turned[2], -light[3], 1e-15);
        EXPECT_NEAR(turned[3], 0, 1e-15);
        const std::vector<double> expected = basis(3, {0, 0, -1});
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(turned[i], expected[i], 2e-15);
    }
}

// Y(R d) = D Y(d): the rotated basis at R d is the basis at d, whatever the order.
TEST(ShRotation, TurnsTheBasisAtADirectionIntoTheBasisAtTheTurnedDirection) {
    std::mt19937 random(1);
    for (const int order : {1, 2, 3, 6, 16, 64}) {
        for (const glm::dquat& q : rotations()) {
            const ShRotation rotation(order, q);
            const glm::dmat3 matrix = glm::mat3_cast(q);
            for (int i = 0; i < 4; ++i) {
                const glm::dvec3 d = random_direction(random);
                const std::vector<double> expected = basis(order, matrix * d);
                std::vector<double> turned = basis(order, d);
                rotation.rotate(1, turned.data(), turned.data());
                for (int l = 0; l < order; ++l) {
                    // Rounding of R d moves Y_l by up to l eps.
                    const double scale = std::sqrt((2 * l + 1) / (4 * kPi));
                    for (std::size_t k = sh_index(l, -l); k <= sh_index(l, l); ++k) {
                        ASSERT_NEAR(turned[k], expected[k], 1e-12 * scale) << order << " " << k;
                    }
                }
            }
        }
    }
}

// The definition: D^l_mk is the integral of Y_lm(d) Y_lk(R^-1 d), by a rule that is exact for it.
double quadrature_error(int order, const glm::dquat& q) {
    const ShRotation rotation(order, q);
    const glm::dmat3 back = glm::transpose(glm::mat3_cast(q));
    const PolarRule rule = gauss_legendre(order);
    const int columns = 2 * order;
    std::vector<std::vector<long double>> blocks;
    for (int l = 0; l < order; ++l) blocks.emplace_back((2 * l + 1) * (2 * l + 1));
    for (std::size_t i = 0; i < rule.cosine.size(); ++i) {
        for (int j = 0; j < columns; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / columns;
            const glm::dvec3 d(rule.sine[i] * std::cos(phi), rule.sine[i] * std::sin(phi),
                               rule.cosine[i]);
            const std::vector<double> here = basis(order, d), there = basis(order, back * d);
            const double weight = rule.weight[i] * 2 * kPi / columns;
            for (int l = 0; l < order; ++l) {
                for (int m = 0; m < 2 * l + 1; ++m) {
                    for (int k = 0; k < 2 * l + 1; ++k) {
                        blocks[l][m * (2 * l + 1) + k] +=
                            weight * here[l * l + m] * there[l * l + k];
                    }
                }
            }
        }
    }
    double worst = 0;
    for (int l = 0; l < order; ++l) {
        for (std::size_t i = 0; i < blocks[l].size(); ++i) {
            worst =
                std::max(worst, std::abs(static_cast<double>(rotation.block(l)[i] - blocks[l][i])));
        }
    }
    return worst;
}

TEST(ShRotation, IsTheIntegralThatDefinesIt) {
    for (const glm::dquat& q : rotations()) {
        EXPECT_LT(quadrature_error(6, q), 5e-15);
    }
    // The rotated points carry rounding of l eps themselves.
    EXPECT_LT(quadrature_error(20, rotations().back()), 5e-14);
}

TEST(ShRotation, MatricesAreOrthogonalAtEveryOrder) {
    for (const glm::dquat& q : rotations()) {
        const ShRotation rotation(64, q);
        EXPECT_LT(largest_difference(rotation * rotation.inverse(), ShRotation::identity(64)),
                  1e-12);
    }
}

TEST(ShRotation, IdentityLeavesEverythingAlone) {
    EXPECT_LT(largest_difference(ShRotation(64, glm::dmat3(1)), ShRotation::identity(64)), 1e-14);
    std::mt19937 random(2);
    const auto in = random_vectors<double>(5 * 36, random);
    auto out = in;
    ShRotation::identity(6).rotate(5, in.data(), out.data());
    EXPECT_EQ(in, out);
}

TEST(ShRotation, ProductIsTheRotationOfTheProduct) {
    std::mt19937 random(3);
    for (int i = 0; i < 8; ++i) {
        const glm::dquat a = random_quaternion(random), b = random_quaternion(random);
        EXPECT_LT(largest_difference(ShRotation(64, b) * ShRotation(64, a),
                                     ShRotation(64, glm::normalize(b * a))),
                  1e-12);
    }
    EXPECT_THROW(ShRotation::identity(3) * ShRotation::identity(4), Error);
}

TEST(ShRotation, InverseIsTheRotationBack) {
    for (const glm::dquat& q : rotations()) {
        EXPECT_LT(
            largest_difference(ShRotation(64, q).inverse(), ShRotation(64, glm::conjugate(q))),
            1e-12);
    }
}

TEST(ShRotation, ZonalShortcutIsTheRotationOfTheZonalVector) {
    std::mt19937 random(5);
    for (const int order : {1, 2, 6, 33}) {
        const auto g = random_vectors<double>(order, random);
        const glm::dquat q = random_quaternion(random);
        std::vector<double> zonal(sh_count(order)), shortcut(sh_count(order));
        for (int l = 0; l < order; ++l) zonal[sh_index(l, 0)] = g[l];
        ShRotation(order, q).rotate(1, zonal.data(), zonal.data());
        const glm::dvec3 axis = q * glm::dvec3(0, 0, 1);
        rotate_zonal(order, g.data(), axis, shortcut.data());
        std::vector<float> rounded(sh_count(order));
        rotate_zonal(order, g.data(), axis, rounded.data());
        for (std::size_t i = 0; i < zonal.size(); ++i) {
            EXPECT_NEAR(zonal[i], shortcut[i], 1e-12);
            EXPECT_EQ(rounded[i], static_cast<float>(shortcut[i]));
        }
    }
}

TEST(ShRotation, MendsWhatRoundingDidToAMatrix) {
    std::mt19937 random(6);
    for (int i = 0; i < 8; ++i) {
        const glm::dmat3 exact = glm::mat3_cast(random_quaternion(random));
        const ShRotation mended(6, glm::dmat3(glm::mat3(exact)));
        // The nearest rotation is as near as the rounding was, and a rotation.
        EXPECT_LT(largest_difference(mended, ShRotation(6, exact)), 2e-6);
        EXPECT_LT(largest_difference(mended * mended.inverse(), ShRotation::identity(6)), 1e-14);
    }
}

TEST(ShRotation, MessagesAreShort) {
    try {
        ShRotation rotation(3, glm::dquat(1e150, 0, 0, 0));
        ADD_FAILURE() << "taken";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "rotation: the squared length of the quaternion is 1e+300, a rotation has 1 "
                     "within 1e-5");
    }
}

TEST(ShRotation, RefusesWhatIsNoRotation) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [](int order, const auto& rotation) {
        try {
            ShRotation(order, rotation);
        } catch (const Error& error) {
            return error.code() == ErrorCode::usage;
        }
        return false;
    };
    EXPECT_TRUE(refused(0, glm::dmat3(1)));
    EXPECT_TRUE(refused(-1, glm::dmat3(1)));
    EXPECT_TRUE(refused(3, glm::dmat3(2)));
    EXPECT_TRUE(refused(3, glm::dmat3(-1)));
    EXPECT_TRUE(refused(3, glm::dmat3(0)));
    EXPECT_TRUE(refused(3, glm::dmat3(nan)));
    EXPECT_TRUE(refused(3, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 1e-3, 1)));
    EXPECT_TRUE(refused(3, glm::dquat(2, 0, 0, 0)));
    EXPECT_TRUE(refused(3, glm::dquat(nan, 0, 0, 0)));
    EXPECT_FALSE(refused(3, glm::dquat(1 + 4e-6, 0, 0, 0)));
    EXPECT_THROW(ShRotation(100000, glm::dmat3(1)), Error);
}

// Every order and count, in place and not, both layouts, on every SIMD target: the same numbers as
// the plain sum, and nothing written beside them.
template <class T>
void check_vectors(double tolerance) {
    std::mt19937 random(8);
    double worst = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : {1, 2, 3, 4, 5, 6, 9}) {
            const std::size_t size = sh_count(order);
            const ShRotation rotation(order, random_quaternion(random));
            for (const std::size_t count : {0, 1, 3, 8, 16, 17, 31, 65}) {
                const auto in = random_vectors<T>(count * size, random);
                std::vector<T> out(count * size + 1, T{7}), planes(count * size),
                    plane_in(count * size);
                rotation.rotate(count, in.data(), out.data());
                for (std::size_t v = 0; v < count; ++v) {
                    for (int l = 0; l < order; ++l) {
                        const int band = 2 * l + 1;
                        for (int m = 0; m < band; ++m) {
                            double sum = 0, square = 0;
                            for (int k = 0; k < band; ++k) {
                                const double c = in[v * size + l * l + k];
                                sum += rotation.block(l)[m * band + k] * c;
                                square += c * c;
                            }
                            const double error = std::abs(out[v * size + l * l + m] - sum);
                            worst = std::max(worst, error / std::sqrt(square));
                        }
                    }
                    for (std::size_t k = 0; k < size; ++k) {
                        plane_in[k * count + v] = in[v * size + k];
                    }
                }
                EXPECT_EQ(out.back(), T{7});
                auto in_place = in;
                rotation.rotate(count, in_place.data(), in_place.data());
                EXPECT_TRUE(std::equal(in_place.begin(), in_place.end(), out.begin()));
                rotation.rotate_planes(count, count, plane_in.data(), planes.data());
                rotation.rotate_planes(count, count, plane_in.data(), plane_in.data());
                EXPECT_EQ(planes, plane_in);
                for (std::size_t v = 0; v < count; ++v) {
                    for (std::size_t k = 0; k < size; ++k) {
                        ASSERT_EQ(planes[k * count + v], out[v * size + k]);
                    }
                }
            }
        }
    }
    EXPECT_LT(worst, tolerance);
    testing::Test::RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

// A sum of 17 products, each factor rounded once: a few units in the last place.
TEST(ShRotation, DoubleVectorsAreTurnedOnEveryTarget) {
    check_vectors<double>(1e-15);
}

TEST(ShRotation, FloatVectorsAreTurnedOnEveryTarget) {
    check_vectors<float>(4e-7);
}

}  // namespace
}  // namespace airlight
