// SPDX-License-Identifier: Apache-2.0
#include "sh/lobes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kOrder = 1024;

enum Lobe { phong_lobe, cone_lobe, gaussian_lobe };

std::vector<double> lobe(int kind, double parameter, int order, LobeScale scale = LobeScale::peak) {
    switch (kind) {
        case phong_lobe:
            return phong_eigenvalues(parameter, order, scale);
        case cone_lobe:
            return cone_eigenvalues(parameter, order, scale);
        default:
            return gaussian_eigenvalues(parameter, order, scale);
    }
}

// The largest of the degrees beside l: cones have zeros, near which rounding is absolute.
double envelope(const std::vector<double>& lambda, std::size_t l) {
    double largest = 0;
    for (std::size_t k = l < 3 ? 0 : l - 3; k <= std::min(l + 3, lambda.size() - 1); ++k) {
        largest = std::max(largest, std::abs(lambda[k]));
    }
    return largest;
}

TEST(Lobes, MatchTheCornersComputedInManyDigits) {
    double worst[3] = {0, 0, 0};
    for (const auto& row : reference_rows("lobes_corners.csv", 4, 400)) {
        const int kind = static_cast<int>(row[0]);
        const auto l = static_cast<std::size_t>(row[2]);
        // A shorter table holds the same numbers.
        for (const int order : {kOrder, std::max(static_cast<int>(l) + 4, 8)}) {
            const std::vector<double> lambda = lobe(kind, row[1], order);
            const double exact = row[3];
            // Denormal values have no digits to keep.
            const double scale =
                std::max(kind == cone_lobe ? envelope(lambda, l) : std::abs(exact), 1e-300);
            const double error =
                std::abs(lambda[l] - exact) / scale / std::sqrt(static_cast<double>(l) + 1);
            worst[kind] = std::max(worst[kind], error);
            EXPECT_LT(error, kind == gaussian_lobe ? 2e-15 : 1e-15)
                << kind << " " << row[1] << " " << l << " " << lambda[l] << " " << exact;
        }
    }
    RecordProperty("phong", std::to_string(worst[0] * 1e16));
    RecordProperty("cone", std::to_string(worst[1] * 1e16));
    RecordProperty("gaussian", std::to_string(worst[2] * 1e16));
}

TEST(Lobes, AreTheIntegralsOfTheirFunctions) {
    constexpr int kBands = 40;
    const auto gaussian = [](double gamma) {
        const double s = std::sin(gamma / 2);
        return std::exp(-2 * 30.0 * s * s);
    };
    const std::vector<double> exact = gaussian_eigenvalues(30, kBands);
    const std::vector<double> sampled = zonal_eigenvalues(gaussian, kBands, 100);
    for (std::size_t l = 0; l < kBands; ++l) EXPECT_NEAR(sampled[l], exact[l], 1e-15) << l;
    // cos^2 and cos^3 over half the sphere, by a rule that is exact on either half.
    const PolarRule rule = gauss_legendre(64);
    PolarRule half = rule;
    std::vector<double> square, cube;
    for (std::size_t i = 0; i < rule.weight.size(); ++i) {
        half.cosine[i] = (1 + rule.cosine[i]) / 2;
        half.sine[i] = std::sqrt((1 - half.cosine[i]) * (1 + half.cosine[i]));
        half.weight[i] /= 2;
        square.push_back(half.cosine[i] * half.cosine[i]);
        cube.push_back(square.back() * half.cosine[i]);
    }
    const std::vector<double> two = phong_eigenvalues(2, kBands),
                              three = phong_eigenvalues(3, kBands);
    for (std::size_t l = 0; l < kBands; ++l) {
        EXPECT_NEAR(zonal_eigenvalues(half, square, kBands)[l], two[l], 1e-14) << l;
        EXPECT_NEAR(zonal_eigenvalues(half, cube, kBands)[l], three[l], 1e-14) << l;
    }
}

TEST(Lobes, OfPhongHoldTheHemisphereAndTheClampedCosine) {
    const std::vector<double> cosine = clamped_cosine_eigenvalues(8);
    const double exact[8] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24, 0, kPi / 64, 0};
    for (std::size_t l = 0; l < 8; ++l) EXPECT_NEAR(cosine[l], exact[l], 1e-15) << l;
    for (std::size_t l = 3; l < 8; l += 2) EXPECT_EQ(cosine[l], 0) << l;
    const std::vector<double> hemisphere = phong_eigenvalues(0, 64);
    const std::vector<double> cone = cone_eigenvalues(kPi / 2, 64);
    for (std::size_t l = 0; l < 64; ++l) EXPECT_NEAR(hemisphere[l], cone[l], 2e-15) << l;
}

TEST(Lobes, OfUnitIntegralTendToTheDeltaFunction) {
    EXPECT_EQ(delta_eigenvalues(3), std::vector<double>(3, 1.0));
    for (const int kind : {phong_lobe, cone_lobe, gaussian_lobe}) {
        const double narrow = kind == cone_lobe ? 1e-120 : 1e300;
        for (const double value : lobe(kind, narrow, kOrder, LobeScale::integral)) {
            EXPECT_NEAR(value, 1, 1e-13) << kind;
        }
        const double wide = kind == cone_lobe ? 0.3 : 7.5;
        const std::vector<double> peak = lobe(kind, wide, 32);
        const std::vector<double> unit = lobe(kind, wide, 32, LobeScale::integral);
        EXPECT_EQ(unit[0], 1);
        for (std::size_t l = 0; l < 32; ++l) {
            EXPECT_NEAR(unit[l] * peak[0], peak[l], 4e-15 * peak[0]) << kind << " " << l;
        }
    }
    const std::vector<double> far = cone_complement_eigenvalues(kPi, 5, LobeScale::integral);
    EXPECT_EQ(far, (std::vector<double>{1, -1, 1, -1, 1}));
}

TEST(Lobes, ConeAndItsComplementMakeTheSphere) {
    for (const double angle : {0.0, 1e-200, 1e-9, 0.4, kPi / 2, 3.0, kPi, 3.14159274101257324}) {
        const std::vector<double> inside = cone_eigenvalues(angle, 64);
        const std::vector<double> outside = cone_complement_eigenvalues(angle, 64);
        EXPECT_NEAR(inside[0] + outside[0], 4 * kPi, 4e-15) << angle;
        for (std::size_t l = 1; l < 64; ++l) EXPECT_EQ(inside[l], -outside[l]) << angle << " " << l;
    }
}

// The axis of a lobe is any: rotate_zonal puts it there, and the delta function is the basis.
TEST(Lobes, TurnToAnAxis) {
    constexpr int kBands = 24;
    const glm::dvec3 axis = glm::dvec3(3, -1, 2) / std::sqrt(14.0);
    std::vector<double> turned(sh_count(kBands)), basis(turned.size());
    evaluate_basis(kBands, axis.x, axis.y, axis.z, basis.data());
    rotate_zonal(kBands, zonal_coefficients(delta_eigenvalues(kBands)).data(), axis, turned.data());
    for (std::size_t i = 0; i < basis.size(); ++i) EXPECT_NEAR(turned[i], basis[i], 1e-15) << i;

    const std::vector<double> lambda = gaussian_eigenvalues(6, kBands);
    rotate_zonal(kBands, zonal_coefficients(lambda).data(), axis, turned.data());
    const glm::dvec3 there = glm::dvec3(1, 1, 1) / std::sqrt(3.0);
    evaluate_basis(kBands, there.x, there.y, there.z, basis.data());
    double sum = 0;
    for (std::size_t i = 0; i < basis.size(); ++i) sum += basis[i] * turned[i];
    EXPECT_NEAR(sum, std::exp(6 * (glm::dot(axis, there) - 1)), 1e-12);
}

TEST(Lobes, RefuseWhatIsOutsideTheirDomain) {
    for (const double bad : {kNan, -1e-300, double(HUGE_VAL), -double(HUGE_VAL)}) {
        EXPECT_THROW(phong_eigenvalues(bad, 4), Error) << bad;
        EXPECT_THROW(cone_eigenvalues(bad, 4), Error) << bad;
        EXPECT_THROW(cone_complement_eigenvalues(bad, 4), Error) << bad;
        EXPECT_THROW(gaussian_eigenvalues(bad, 4), Error) << bad;
    }
    EXPECT_THROW(cone_eigenvalues(3.1416, 4), Error);
    try {
        cone_eigenvalues(3.15e300, 4);
        ADD_FAILURE() << "taken";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "the half angle of a cone must be in [0, 3.141592653589793], got 3.15e+300");
    }
    for (const int kind : {phong_lobe, cone_lobe, gaussian_lobe}) {
        EXPECT_TRUE(lobe(kind, 1, 0).empty());
        EXPECT_EQ(lobe(kind, 1, 1).size(), 1u);
        // No degree of any order is NaN.
        for (const double parameter : {0.0, 5e-324, 1e-200, 1.0, 3.0}) {
            for (const double value : lobe(kind, parameter, 2000)) ASSERT_FALSE(std::isnan(value));
        }
    }
}

}  // namespace
}  // namespace airlight
