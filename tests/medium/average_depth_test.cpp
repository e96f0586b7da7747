// SPDX-License-Identifier: Apache-2.0
#include "medium/average_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "core/error.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRootPi = 1.7724538509055160273;

// Mean over directions of the depth along `reach`, by midpoints in the cosine and Simpson in t:
// `sign` is that of the exponent.
double averaged_by_quadrature(double u, double sign, double reach) {
    const int directions = 400, steps = 2000;
    double sum = 0;
    for (int i = 0; i < directions; ++i) {
        const double cosine = -1 + (2 * i + 1.0) / directions;
        for (int k = 0; k <= steps; ++k) {
            const double t = reach * k / steps;
            const double weight = k == 0 || k == steps ? 1 : 2 + 2 * (k % 2);
            sum += weight * std::exp(sign * (u * u + 2 * u * t * cosine + t * t));
        }
    }
    return sum * reach / steps / 3 / directions;
}

TEST(MeanGaussianDepth, MatchesEveryReferenceRow) {
    for (const auto& row : reference_rows("avg_depth_gauss.csv", 2, 45)) {
        EXPECT_LT(relative_error(mean_gaussian_depth(row[0]), row[1]), 2e-15) << row[0];
    }
    for (const auto& row : reference_rows("avg_depth_corners.csv", 2, 120)) {
        EXPECT_LT(relative_error(mean_gaussian_depth(row[0]), row[1]), 2e-15) << row[0];
    }
}

TEST(MeanGaussianDepth, SweepFallsAndStaysBetweenItsBounds) {
    sweep([](SweepDraw& draw) -> std::string {
        const double u = draw.not_negative();
        const double depth = mean_gaussian_depth(u);
        const double next = mean_gaussian_depth(u * (1 + draw.decades(-12, 0)));
        // sqrt(pi) / 2 / (1 + 2 u^2) bounds it from below: D(u) (1 + 2 u^2) >= u.
        const double least = 0.5 * kRootPi / (1 + 2 * u * u);
        const bool holds = depth >= least * (1 - 1e-14) && depth <= 0.5 * kRootPi &&
                           next <= depth * (1 + 2e-15) + 1e-323;
        if (holds) return "";
        return sweep_report("mean_gaussian_depth", {u, next}, depth);
    });
}

TEST(MeanGaussianDepth, HasItsLimitsAndItsDomain) {
    EXPECT_DOUBLE_EQ(mean_gaussian_depth(0.0), 0.5 * kRootPi);
    EXPECT_EQ(mean_gaussian_depth(kInfinity), 0);
    EXPECT_NEAR(mean_gaussian_depth(1e100) / (kRootPi / 4e200), 1, 1e-15);
    EXPECT_TRUE(std::isnan(mean_gaussian_depth(-1.0)));
    EXPECT_TRUE(std::isnan(mean_gaussian_depth(kNan)));
    EXPECT_EQ(mean_gaussian_depth(0.7f), static_cast<float>(mean_gaussian_depth(double{0.7f})));
}

// The paper's integrand has the wrong sign: its integral grows without bound with the reach.
TEST(MeanGaussianDepth, ThePrintedSignOfTheExponentDiverges) {
    for (const double u : {0.0, 0.5, 1.5, 3.0}) {
        EXPECT_NEAR(averaged_by_quadrature(u, -1, 12), mean_gaussian_depth(u), 2e-5);
    }
    EXPECT_GT(averaged_by_quadrature(1, +1, 4), 1e3 * averaged_by_quadrature(1, +1, 2));
    EXPECT_GT(averaged_by_quadrature(1, +1, 8), 1e3 * averaged_by_quadrature(1, +1, 4));
}

TEST(MeanDepthTable, ErrsAsItsHeaderSays) {
    const struct {
        int size;
        double absolute;
    } cases[] = {{64, 2.5e-3}, {256, 1.5e-4}};
    for (const auto& c : cases) {
        const MeanDepthTable table(c.size);
        double absolute = 0, relative = 0;
        for (int i = 0; i < 200000; ++i) {
            const double u = 1e-4 * i, exact = mean_gaussian_depth(u);
            absolute = std::max(absolute, std::abs(table(u) - exact));
            relative = std::max(relative, std::abs(table(u) / exact - 1));
        }
        EXPECT_LT(absolute, c.absolute);
        EXPECT_GT(absolute, 0.5 * c.absolute);
        EXPECT_LT(relative, 8e-3);
    }
    const MeanDepthTable table;
    EXPECT_EQ(table(kInfinity), 0);
    EXPECT_TRUE(std::isnan(table(kNan)));
    EXPECT_TRUE(std::isnan(table(-1)));
    EXPECT_THROW(MeanDepthTable(1), Error);
    EXPECT_THROW(MeanDepthTable(64, 0), Error);
    EXPECT_THROW(MeanDepthTable(64, kInfinity), Error);
    EXPECT_THROW(MeanDepthTable(64, kNan), Error);
}

TEST(AverageOpticalDepth, IsTheMeanOverDirections) {
    const GaussianBlob blobs[] = {{{1, 0, 0}, 0.8, 0.6}, {{-0.5, 2, 0.3}, 1.5, 1.1}};
    const glm::dvec3 point{0.2, 0.4, -0.3};
    double sum = 0;
    const int rows = 60, columns = 120;
    for (int i = 0; i < rows; ++i) {
        const double z = -1 + (2 * i + 1.0) / rows, r = std::sqrt(1 - z * z);
        for (int j = 0; j < columns; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / columns;
            for (const GaussianBlob& blob : blobs) {
                sum += gaussian_optical_depth(blob, point,
                                              {r * std::cos(phi), r * std::sin(phi), z}, kInfinity);
            }
        }
    }
    // The midpoint rule over the sphere errs by 1e-4 here.
    EXPECT_NEAR(average_optical_depth(0.05, 10, blobs, 2, point), 0.5 + sum / (rows * columns),
                2e-4);
}

TEST(AverageOpticalDepth, HasItsLimitsAndItsDomain) {
    const GaussianBlob blob{{0, 0, 0}, 1, 2};
    const GaussianBlob uniform{{0, 0, 0}, 0, 2};
    const GaussianBlob negative{{0, 0, 0}, 1, -2};
    EXPECT_EQ(average_optical_depth(0.5, 4, nullptr, 0, {0, 0, 0}), 2);
    EXPECT_EQ(average_optical_depth(0, kInfinity, nullptr, 0, {0, 0, 0}), 0);
    EXPECT_DOUBLE_EQ(average_optical_depth(0, kInfinity, &blob, 1, {0, 0, 0}), kRootPi);
    EXPECT_EQ(average_optical_depth(0, 4, &uniform, 1, {0, 0, 0}), kInfinity);
    EXPECT_TRUE(std::isnan(average_optical_depth(0, 4, &negative, 1, {0, 0, 0})));
    EXPECT_TRUE(std::isnan(average_optical_depth(-1, 4, &blob, 1, {0, 0, 0})));
    EXPECT_TRUE(std::isnan(average_optical_depth(1, kNan, &blob, 1, {0, 0, 0})));
    EXPECT_TRUE(std::isnan(average_optical_depth(1, 4, &blob, 1, {0, kNan, 0})));
}

}  // namespace
}  // namespace airlight
