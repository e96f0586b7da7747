// SPDX-License-Identifier: Apache-2.0
#include "medium/height_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Measured: 1.1e-15, the exponential of an exponent near 700 and three more operations.
constexpr double kDoubleTolerance = 2e-15;

bool no_depth(double value) {
    return std::isnan(value) || std::signbit(value);
}

TEST(HeightDensity, ExponentialColumnsMatchEveryReferenceRow) {
    auto rows = reference_rows("rectexp.csv", 5, 540);
    const auto corners = reference_rows("rectexp_corners.csv", 5, 300);
    rows.insert(rows.end(), corners.begin(), corners.end());
    for (const auto& row : rows) {
        EXPECT_LT(relative_error(exponential_height_depth(row[0], row[1], row[2], row[3]), row[4]),
                  kDoubleTolerance)
            << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3];
    }
}

TEST(HeightDensity, ExponentialInversesMatchEveryReferenceRow) {
    for (const auto& row : reference_rows("rectexp_inverse.csv", 5, 150)) {
        const double distance = exponential_height_distance(row[0], row[1], row[2], row[3]);
        EXPECT_LT(relative_error(distance, row[4]), kDoubleTolerance) << row[0] << ' ' << row[2];
    }
}

TEST(HeightDensity, LinearColumnsMatchEveryReferenceRow) {
    for (const auto& row : reference_rows("linear.csv", 7, 150)) {
        EXPECT_LT(
            relative_error(linear_height_depth(row[0], row[1], row[2], row[3], row[4]), row[5]),
            kDoubleTolerance)
            << row[0] << ' ' << row[2] << ' ' << row[4];
    }
    for (const auto& row : reference_rows("linear_corners.csv", 6, 300)) {
        EXPECT_LT(
            relative_error(linear_height_depth(row[0], row[1], row[2], row[3], row[4]), row[5]),
            kDoubleTolerance)
            << row[0] << ' ' << row[2] << ' ' << row[4];
    }
}

TEST(HeightDensity, LinearInversesMatchEveryReferenceRow) {
    for (const auto& row : reference_rows("linear_inverse.csv", 6, 120)) {
        const double distance = linear_height_distance(row[0], row[1], row[2], row[3], row[4]);
        EXPECT_LT(relative_error(distance, row[5]), kDoubleTolerance) << row[0] << ' ' << row[1];
    }
}

TEST(HeightDensity, HasItsLimits) {
    // Horizontal rays and falloff 0 are uniform.
    EXPECT_NEAR(exponential_height_depth(10.0, 0.0, 3.0, 0.5), 3 * std::exp(-5.0), 1e-17);
    EXPECT_EQ(exponential_height_depth(10.0, 1.0, 3.0, 0.0), 3);
    EXPECT_EQ(exponential_height_depth(10.0, 0.0, kInfinity, 0.5), kInfinity);
    // The whole column, upwards and, with a negative falloff, downwards.
    EXPECT_NEAR(exponential_height_depth(10.0, 0.25, kInfinity, 0.5), 8 * std::exp(-5.0), 1e-16);
    EXPECT_NEAR(exponential_height_depth(10.0, -0.25, kInfinity, -0.5), 8 * std::exp(5.0), 1e-11);
    EXPECT_EQ(exponential_height_depth(10.0, -0.25, kInfinity, 0.5), kInfinity);
    EXPECT_EQ(exponential_height_depth(1.0, -1.0, 1e4, 1.0), kInfinity);
    EXPECT_EQ(exponential_height_depth(1e4, 1.0, 1e4, 1.0), 0);
    // An exponential out of range times a length out of range.
    EXPECT_NEAR(exponential_height_depth(-1000.0, 1.0, 1e-300, 1.0) / 1.9700711140170469938e134, 1,
                1e-14);
    EXPECT_EQ(exponential_height_distance(0.0, 5.0, 1.0, 2.0), 0);
    EXPECT_EQ(exponential_height_distance(1.0, 0.0, 1.0, 2.0), kInfinity);
    EXPECT_EQ(exponential_height_distance(kInfinity, 0.0, -1.0, 2.0), kInfinity);
    // The density is 1 - z / 2: 0 from z = 2 on.
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 0.0, 1.0, 10.0), 1);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 0.0, 1.0, kInfinity), 1);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 4.0, -1.0, 3.0), 0.25);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 4.0, -1.0, kInfinity), kInfinity);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 4.0, 0.5, kInfinity), 0);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 4.0, 0.0, kInfinity), 0);
    EXPECT_EQ(linear_height_depth(-0.5, 1.0, 1.0, 0.0, kInfinity), kInfinity);
    EXPECT_EQ(linear_height_distance(1.0, -0.5, 1.0, 0.0, 1.0), 2);
    EXPECT_EQ(linear_height_distance(1.001, -0.5, 1.0, 0.0, 1.0), kInfinity);
    EXPECT_EQ(linear_height_distance(0.25, -0.5, 1.0, 4.0, -1.0), 3);
    EXPECT_EQ(linear_height_distance(0.25, -0.5, 1.0, 4.0, 1.0), kInfinity);
}

TEST(HeightDensity, RefusesWhatIsOutsideItsDomainWithNan) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        EXPECT_TRUE(std::isnan(exponential_height_depth(bad, 0.5, 1.0, 1.0)));
        EXPECT_TRUE(std::isnan(exponential_height_depth(1.0, 0.5, 1.0, bad)));
        EXPECT_TRUE(std::isnan(exponential_height_distance(1.0, bad, 0.5, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_depth(bad, 1.0, 1.0, 0.5, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_depth(1.0, bad, 1.0, 0.5, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_distance(1.0, 1.0, 1.0, bad, 0.5)));
    }
    for (const double bad : {kNan, -1e-300, -kInfinity}) {
        EXPECT_TRUE(std::isnan(exponential_height_depth(1.0, 0.5, bad, 1.0)));
        EXPECT_TRUE(std::isnan(exponential_height_distance(bad, 1.0, 0.5, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_depth(1.0, 1.0, 1.0, 0.5, bad)));
        EXPECT_TRUE(std::isnan(linear_height_distance(bad, 1.0, 1.0, 1.0, 0.5)));
    }
    for (const double bad : {kNan, 1.0000001, -1.0000001}) {
        EXPECT_TRUE(std::isnan(exponential_height_depth(1.0, bad, 1.0, 1.0)));
        EXPECT_TRUE(std::isnan(exponential_height_distance(1.0, 1.0, bad, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_depth(1.0, 1.0, 1.0, bad, 1.0)));
        EXPECT_TRUE(std::isnan(linear_height_distance(1.0, 1.0, 1.0, 1.0, bad)));
    }
}

// The article's single-precision code, with the signs of its exponents mended or as it stands.
float article_exponential_depth(float height, float up, float distance, float n, bool mended) {
    const float p = -up * n;
    if (std::abs(p) <= std::numeric_limits<float>::epsilon()) {
        return mended ? distance * std::exp(-height * n) : distance;
    }
    return 1 / p * std::exp(mended ? -height * n : height * n) * (std::exp(p * distance) - 1);
}

TEST(HeightDensity, TheArticlesExponentialColumnFailsWhereOursHolds) {
    double printed = 0;
    int lost = 0, broken = 0, ours = 0, rows = 0;
    for (const auto& row : reference_rows("rectexp.csv", 5, 540)) {
        float a[4];
        for (int i = 0; i < 4; ++i) a[i] = rounded(row[i]);
        const double exact =
            exponential_height_depth(double{a[0]}, double{a[1]}, double{a[2]}, double{a[3]});
        if (exact < 1e-37 || exact > 1e37) continue;
        ++rows;
        const float mended = article_exponential_depth(a[0], a[1], a[2], a[3], true);
        const float as_printed = article_exponential_depth(a[0], a[1], a[2], a[3], false);
        if (std::isfinite(as_printed)) {
            printed = std::max(printed, relative_error(as_printed, exact));
        }
        if (!std::isfinite(mended)) {
            ++broken;
        } else if (relative_error(mended, exact) > 0.01) {
            ++lost;
        }
        if (!(relative_error(exponential_height_depth(a[0], a[1], a[2], a[3]), exact) < 6e-8)) {
            ++ours;
        }
    }
    EXPECT_GT(rows, 450);
    // e^{2 n h} at h = 500 and n = .02.
    EXPECT_GT(printed, 1e8);
    EXPECT_GE(lost + broken, 20);
    EXPECT_EQ(ours, 0);
}

TEST(HeightDensity, TheArticlesLinearInverseFailsWhereOursHolds) {
    int broken = 0, rows = 0;
    for (const auto& row : reference_rows("linear_inverse.csv", 6, 120)) {
        const double depth = row[0], b = row[1] * row[3] + row[2], slope = -row[1] * row[4];
        const double printed = (b - std::sqrt(b * b - 2 * slope * depth)) / slope;
        if (std::isinf(row[5])) continue;
        ++rows;
        if (!(relative_error(printed, row[5]) < 0.01)) ++broken;
    }
    EXPECT_GT(rows, 80);
    EXPECT_GT(broken, rows / 4);
}

struct Ray {
    double height, up, distance;
};

// Ordinary sizes, so that the identities can be held to twelve digits.
Ray ordinary_ray(SweepDraw& draw) {
    const double up = draw.chance(0.2) ? draw.sign() * draw.decades(-17, 0) : draw.between(-1, 1);
    return {draw.sign() * draw.decades(-3, 3), up, draw.decades(-6, 3)};
}

Ray hostile_ray(SweepDraw& draw) {
    const double height = draw.sign() * draw.not_negative(false);
    return {height, draw.chance(0.2) ? draw.sign() * draw.decades(-323, 0) : draw.between(-1, 1),
            draw.not_negative()};
}

TEST(Sweep, ExponentialHeightDepthIsADepthAndGrowsWithTheDistance) {
    sweep([](SweepDraw& draw) -> std::string {
        const Ray ray = hostile_ray(draw);
        const double n = draw.sign() * draw.not_negative(false);
        const double value = exponential_height_depth(ray.height, ray.up, ray.distance, n);
        if (no_depth(value)) {
            return sweep_report("exponential_height_depth", {ray.height, ray.up, ray.distance, n},
                                value);
        }
        const double further = ray.distance + draw.not_negative();
        const double there = exponential_height_depth(ray.height, ray.up, further, n);
        if (!(there >= value * (1 - 2 * kDoubleTolerance))) {
            return sweep_report("further", {ray.height, ray.up, ray.distance, n, further, value},
                                there);
        }
        const double depth = draw.not_negative();
        const double inverse = exponential_height_distance(depth, ray.height, ray.up, n);
        if (no_depth(inverse)) {
            return sweep_report("exponential_height_distance", {depth, ray.height, ray.up, n},
                                inverse);
        }
        return {};
    });
}

TEST(Sweep, ExponentialHeightDepthIsReciprocalAdditiveAndInverted) {
    sweep([](SweepDraw& draw) -> std::string {
        const Ray ray = ordinary_ray(draw);
        const double n = draw.sign() * draw.decades(-6, -1);
        const auto column = [n](double height, double up, double distance) {
            return exponential_height_depth(height, up, distance, n);
        };
        const double value = column(ray.height, ray.up, ray.distance);
        const double end = ray.height + ray.up * ray.distance;
        // The end's height is rounded before it is handed over.
        const double tolerance =
            1e-14 + 4 * kEpsilon * std::abs(n) * (std::abs(ray.height) + std::abs(end));
        const double back = column(end, -ray.up, ray.distance);
        if (!(relative_error(back, value) < tolerance)) {
            return sweep_report("backwards", {ray.height, ray.up, ray.distance, n, value}, back);
        }
        const double part = ray.distance * draw.unit(), rest = ray.distance - part;
        const double sum =
            column(ray.height, ray.up, part) + column(ray.height + ray.up * part, ray.up, rest);
        // Neither is the split exact: part + rest is the distance to one rounding.
        if (!(relative_error(sum, value) < 2 * tolerance)) {
            return sweep_report("in parts", {ray.height, ray.up, ray.distance, n, part, value},
                                sum);
        }
        const double depth = value * draw.unit();
        const double there = exponential_height_distance(depth, ray.height, ray.up, n);
        const double again = column(ray.height, ray.up, there);
        const double density = std::exp(-n * (ray.height + ray.up * there));
        if (!(std::abs(again - depth) <= 1e-14 * depth + kEpsilon * density * there)) {
            return sweep_report("inverted", {ray.height, ray.up, n, depth, there}, again);
        }
        return {};
    });
}

TEST(Sweep, LinearHeightDepthIsADepthAndGrowsWithTheDistance) {
    sweep([](SweepDraw& draw) -> std::string {
        const Ray ray = hostile_ray(draw);
        const double a = draw.sign() * draw.not_negative(false);
        const double k = draw.sign() * draw.not_negative(false);
        const double value = linear_height_depth(a, k, ray.height, ray.up, ray.distance);
        if (no_depth(value)) {
            return sweep_report("linear_height_depth", {a, k, ray.height, ray.up, ray.distance},
                                value);
        }
        const double further = ray.distance + draw.not_negative();
        const double there = linear_height_depth(a, k, ray.height, ray.up, further);
        if (!(there >= value * (1 - 2 * kDoubleTolerance))) {
            return sweep_report("further", {a, k, ray.height, ray.up, ray.distance, further, value},
                                there);
        }
        const double depth = draw.not_negative();
        const double inverse = linear_height_distance(depth, a, k, ray.height, ray.up);
        if (no_depth(inverse)) {
            return sweep_report("linear_height_distance", {depth, a, k, ray.height, ray.up},
                                inverse);
        }
        return {};
    });
}

TEST(Sweep, LinearHeightDepthIsReciprocalAdditiveAndInverted) {
    sweep([](SweepDraw& draw) -> std::string {
        const Ray ray = ordinary_ray(draw);
        const double a = draw.sign() * draw.decades(-6, 1);
        const double k = draw.chance(0.3) ? -a * (ray.height + ray.up * ray.distance * draw.unit())
                                          : draw.sign() * draw.decades(-6, 1);
        const auto column = [a, k](double height, double up, double distance) {
            return linear_height_depth(a, k, height, up, distance);
        };
        const double value = column(ray.height, ray.up, ray.distance);
        const double end = ray.height + ray.up * ray.distance;
        // Rounding the end's height moves the density there, however small it is.
        const double density = std::abs(a) * (std::abs(ray.height) + std::abs(end));
        const double tolerance = 1e-14 * value + 2 * kEpsilon * density * ray.distance;
        const double back = column(end, -ray.up, ray.distance);
        if (!(std::abs(back - value) <= tolerance)) {
            return sweep_report("backwards", {a, k, ray.height, ray.up, ray.distance, value}, back);
        }
        const double part = ray.distance * draw.unit(), rest = ray.distance - part;
        const double sum =
            column(ray.height, ray.up, part) + column(ray.height + ray.up * part, ray.up, rest);
        if (!(std::abs(sum - value) <= 2 * tolerance)) {
            return sweep_report("in parts", {a, k, ray.height, ray.up, ray.distance, part, value},
                                sum);
        }
        const double depth = value * draw.unit();
        const double there = linear_height_distance(depth, a, k, ray.height, ray.up);
        const double again = column(ray.height, ray.up, there);
        const double density_there = std::max(0.0, a * (ray.height + ray.up * there) + k) +
                                     kEpsilon * (std::abs(k) + std::abs(a * ray.height));
        if (!(std::abs(again - depth) <= 1e-14 * depth + 2 * kEpsilon * density_there * there)) {
            return sweep_report("inverted", {a, k, ray.height, ray.up, depth, there}, again);
        }
        return {};
    });
}

// e^{n h} beyond any exponent; the values are ln(1 - q tau e^{nh}) / (-q) at 400 digits.
TEST(HeightDensity, DistancesHoldWhereTheDensityLeavesEveryRange) {
    const double rows[][5] = {{1, 1e5, -1, 1, 1e5},
                              {1, 2e5, -1, 1, 2e5},
                              {1e-3, 2e5, -0.5, 1, 399984.79779210402},
                              {0.5, 1e6, -1e-300, 0.5, 9.9861244752594216e305}};
    for (const auto& row : rows) {
        const double distance = exponential_height_distance(row[0], row[1], row[2], row[3]);
        EXPECT_NEAR(distance, row[4], 1e-4 * row[4]) << row[1];
        // The rounding of the distance alone moves the depth by n u times it.
        const double conditioning = row[3] * -row[2] * distance * 4e-16;
        EXPECT_NEAR(exponential_height_depth(row[1], row[2], distance, row[3]) / row[0], 1,
                    1e-12 + conditioning)
            << row[1];
    }
}

}  // namespace
}  // namespace airlight
