// SPDX-License-Identifier: Apache-2.0
#include "prt/adaptive_hemisphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

using Shape = std::function<bool(const glm::dvec3&)>;

AdaptiveHemisphere::FindBlocked asking(const Shape& blocked) {
    return [blocked](std::size_t count, const float* x, const float* y, const float* z,
                     std::uint32_t* hits) {
        std::size_t found = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (blocked({x[k], y[k], z[k]})) hits[found++] = static_cast<std::uint32_t>(k);
        }
        return found;
    };
}

std::vector<double> sums(const BlockedPoints& points, int order) {
    std::vector<double> sum(sh_count(order)), basis(sum.size());
    for (std::size_t k = 0; k < points.count(); ++k) {
        evaluate_basis(order, double(points.x[k]), double(points.y[k]), double(points.z[k]),
                       basis.data());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += double(points.weight[k]) * basis[i];
        }
    }
    return sum;
}

double norm(const std::vector<double>& a, const std::vector<double>& b) {
    double square = 0;
    for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(square);
}

TEST(AdaptiveHemisphere, TheSquareCoversTheHemisphereWithItsDensity) {
    for (const double u : {0.03, 0.21, 0.49, 0.77, 0.9}) {
        for (const double v : {0.11, 0.38, 0.52, 0.93}) {
            const double h = 1e-5;
            const glm::dvec3 d = adaptive_direction(u, v);
            const glm::dvec3 du = adaptive_direction(u + h, v) - adaptive_direction(u - h, v);
            const glm::dvec3 dv = adaptive_direction(u, v + h) - adaptive_direction(u, v - h);
            EXPECT_NEAR(glm::dot(d, d), 1, 1e-8);
            EXPECT_NEAR(glm::length(glm::cross(du, dv)) / (4 * h * h), adaptive_density(d.z), 1e-5);
        }
    }
    double least = 1;
    for (int k = 0; k <= 100; ++k) {
        least = std::min(
            {least, adaptive_direction(0, k / 100.0).z, adaptive_direction(k / 100.0, 1).z});
    }
    EXPECT_EQ(least, 3e-5);
    EXPECT_EQ(adaptive_direction(0.5, 0.5), glm::dvec3(0, 0, 1));
}

TEST(AdaptiveHemisphere, AllIsTheHemisphereForEveryOrder) {
    for (const int order : {1, 2, 3, 6, 8, 10}) {
        for (const double tolerance : {1e-1, 3e-3, 1e-3, 2e-4}) {
            AdaptiveOptions options;
            options.order = order;
            options.tolerance = tolerance;
            AdaptiveHemisphere hemisphere(options);
            hemisphere.sample(asking([](const glm::dvec3&) { return true; }));
            std::vector<double> expected(sh_count(order));
            rotate_zonal(order, zonal_coefficients(phong_eigenvalues(0, order)).data(), {0, 0, 1},
                         expected.data());
            EXPECT_LT(norm(sums(hemisphere.blocked(), order), expected), 7e-5)
                << order << ' ' << tolerance;
            const AdaptiveEstimate none =
                hemisphere.sample(asking([](const glm::dvec3&) { return false; }));
            EXPECT_EQ(hemisphere.blocked().count(), 0u);
            EXPECT_GT(none.visibility, 0);
            EXPECT_LE(none.visibility, tolerance);
        }
    }
}

TEST(AdaptiveHemisphere, ConesMeetTheToleranceThatTheyWereAskedFor) {
    const int order = 6;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit;
    for (const double tolerance : {1e-2, 3e-3, 1e-3}) {
        AdaptiveOptions options;
        options.tolerance = tolerance;
        AdaptiveHemisphere hemisphere(options);
        const double open = 2.4443;  // the norm of the row of an open hemisphere
        double squares = 0, estimates = 0;
        constexpr int kCones = 60;
        for (int k = 0; k < kCones; ++k) {
            const double a = 0.1 + 0.5 * unit(random), z = std::sin(a + 0.02) * 1.02;
            const double height = z + (1 - z) * unit(random), turn = 2 * kPi * unit(random);
            const double s = std::sqrt(1 - height * height);
            const glm::dvec3 axis(s * std::cos(turn), s * std::sin(turn), height);
            const AdaptiveEstimate estimate = hemisphere.sample(
                asking([&](const glm::dvec3& d) { return glm::dot(d, axis) > std::cos(a); }));
            EXPECT_LE(std::max(estimate.visibility, estimate.transfer), tolerance);
            std::vector<double> expected(sh_count(order));
            rotate_zonal(order, zonal_coefficients(cone_eigenvalues(a, order)).data(), axis,
                         expected.data());
            const double error = norm(sums(hemisphere.blocked(), order), expected) / open;
            EXPECT_LT(error, 1.6 * tolerance) << a << ' ' << height;
            squares += error * error;
            estimates += estimate.visibility * estimate.visibility;
        }
        // Smooth borders are better than the estimate, but not without measure.
        EXPECT_LT(squares, estimates);
        EXPECT_LT(std::sqrt(squares / kCones), tolerance);
        EXPECT_GT(squares, estimates / 30);
    }
}

TEST(AdaptiveHemisphere, ThinThingsAreCountedAndOwnedUpTo) {
    // A thicket of thin poles: far finer than any lattice of the rays allowed.
    const auto poles = [](const glm::dvec3& d) {
        const double turn = std::atan2(d.y, d.x) * 60 / kPi;
        return d.z < 0.7 && turn - std::floor(turn) < 0.2;
    };
    AdaptiveOptions options;
    options.most_rays = 4096;
    AdaptiveHemisphere hemisphere(options);
    const AdaptiveEstimate estimate = hemisphere.sample(asking(poles));
    const std::vector<double> sum = sums(hemisphere.blocked(), 1);
    const double expected = 0.2 * 0.7 * 2 * kPi * std::sqrt(1 / (4 * kPi));
    const double error = std::abs(sum[0] - expected) / 2.4443;
    EXPECT_GT(estimate.visibility, options.tolerance);
    EXPECT_LT(error, estimate.visibility);
    EXPECT_LT(estimate.visibility, 0.1);
    EXPECT_LE(hemisphere.rays(), 4300u);
}

TEST(AdaptiveHemisphere, TheRaysAreALimit) {
    const auto flower = [](const glm::dvec3& d) {
        return d.z < 0.4 + 0.3 * std::sin(7 * std::atan2(d.y, d.x));
    };
    for (const int most : {64, 100, 300, 1000, 3000, 10000}) {
        AdaptiveOptions options;
        options.tolerance = 1e-6;
        options.most_rays = most;
        AdaptiveHemisphere hemisphere(options);
        const AdaptiveEstimate estimate = hemisphere.sample(asking(flower));
        EXPECT_LE(hemisphere.rays(), static_cast<std::size_t>(1.1 * most));
        EXPECT_GE(hemisphere.rays(), static_cast<std::size_t>(0.2 * most));
        EXPECT_GT(estimate.visibility, 1e-6);
    }
}

}  // namespace
}  // namespace airlight
