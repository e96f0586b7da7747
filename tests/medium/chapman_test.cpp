// SPDX-License-Identifier: Apache-2.0
#include "medium/chapman.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

TEST(Chapman, MatchesEveryReferenceRow) {
    for (const auto& row : reference_rows("chapman.csv", 4, 209)) {
        const double value = ln_chapman(row[0], row[1]);
        // Measured: 4.4e-16.
        EXPECT_LT(relative_error(value, row[3]), 1e-15) << row[0] << ' ' << row[1];
        if (row[3] < 700) {
            EXPECT_LT(relative_error(chapman(row[0], row[1]), row[2]), 1e-15 * (3 + row[3]));
        }
        const float z = rounded(row[0]), c = rounded(row[1]);
        EXPECT_LT(relative_error(ln_chapman(z, c), ln_chapman(double{z}, double{c})), 6e-8);
    }
}

TEST(Chapman, MatchesTheCornersComputedInManyDigits) {
    for (const auto& row : reference_rows("chapman_corners.csv", 3, 200)) {
        // Measured: 7e-16, of logarithms from 1e-25 to 1e20.
        EXPECT_LT(relative_error(ln_chapman(row[0], row[1]), row[2]), 2e-15)
            << row[0] << ' ' << row[1];
    }
}

TEST(Chapman, HasItsLimits) {
    for (const double z : {0.0, 1e-300, 1e-3, 1.0, 800.0, 1e6, 1e300}) {
        EXPECT_EQ(chapman(z, 1.0), 1) << z;
        EXPECT_EQ(ln_chapman(z, 1.0), 0) << z;
        // Straight down through the center: 2 e^z - 1.
        EXPECT_NEAR(ln_chapman(z, -1.0), z < 30 ? std::log(2 * std::exp(z) - 1) : z + std::log(2.0),
                    1e-15 * (1 + z))
            << z;
    }
    for (const double c : {-1.0, -0.5, 0.0, 0.5, 1.0}) EXPECT_EQ(chapman(0.0, c), 1);
    // The horizon tends to sqrt(pi z / 2), steep rays to 1 / cos.
    EXPECT_LT(relative_error(chapman(1e16, 0.0), std::sqrt(0.5 * kPi * 1e16)), 1e-15);
    EXPECT_LT(relative_error(chapman(1e308, 0.0), std::sqrt(0.5 * kPi) * 1e154), 1e-14);
    EXPECT_LT(relative_error(chapman(1e300, 0.25), 4), 1e-15);
    EXPECT_EQ(chapman(kInfinity, 0.25), 4);
    EXPECT_EQ(chapman(kInfinity, 0.0), kInfinity);
    EXPECT_EQ(chapman(kInfinity, -0.0), kInfinity);
    EXPECT_EQ(ln_chapman(kInfinity, -0.25), kInfinity);
    EXPECT_EQ(chapman(1e4, -0.9), kInfinity);
    EXPECT_TRUE(std::isfinite(ln_chapman(1e300, -0.9)));
}

TEST(Chapman, RefusesWhatIsOutsideItsDomainWithNan) {
    const double nan = std::nan("");
    for (const auto f : {static_cast<double (*)(double, double)>(chapman),
                         static_cast<double (*)(double, double)>(ln_chapman)}) {
        EXPECT_TRUE(std::isnan(f(nan, 0.5)));
        EXPECT_TRUE(std::isnan(f(1.0, nan)));
        EXPECT_TRUE(std::isnan(f(-1e-300, 0.5)));
        EXPECT_TRUE(std::isnan(f(1.0, 1.0000001)));
        EXPECT_TRUE(std::isnan(f(1.0, -1.0000001)));
    }
    for (const NamedMethod<ChapmanMethod>& info : kChapmanMethods) {
        EXPECT_TRUE(std::isnan(ln_chapman(1.0, 1.5, info.method))) << info.name;
        EXPECT_TRUE(method_from_name(kChapmanMethods, info.name) == info.method);
    }
    EXPECT_FALSE(method_from_name(kChapmanMethods, "cosine").has_value());
}

double largest_error(ChapmanMethod method, double z) {
    double largest = 0;
    for (int i = 0; i <= 2000; ++i) {
        const double c = i / 2000.0;
        largest = std::max(largest, std::abs(ln_chapman(z, c, method) - ln_chapman(z, c)));
    }
    return largest;
}

TEST(Chapman, MethodsHaveTheErrorsThatTheHeaderStates) {
    const double z[] = {10, 50, 100, 1000}, huestis[] = {2.5e-3, 1.2e-4, 3.2e-5, 3.3e-7};
    for (int i = 0; i < 4; ++i) {
        const double error = largest_error(ChapmanMethod::huestis, z[i]);
        EXPECT_NEAR(error, huestis[i], 0.05 * huestis[i]) << z[i];
    }
    EXPECT_LT(largest_error(ChapmanMethod::huestis, 800), 5.5e-7);
    EXPECT_LT(largest_error(ChapmanMethod::huestis_fp32, 800), 2.5e-6);
    EXPECT_GT(largest_error(ChapmanMethod::huestis_fp32, 1e5), 5e-7);
    EXPECT_NEAR(largest_error(ChapmanMethod::schueler, 800), 0.14, 0.03);
    EXPECT_EQ(largest_error(ChapmanMethod::secant, 800), kInfinity);
}

// [Golubev] eq. 47 has one term more than eq. 46 at the horizon.
TEST(Chapman, TheSeriesOfTheArticleJumpAtTheHorizon) {
    for (const double z : {50.0, 500.0, 5000.0}) {
        const double above = std::exp(ln_chapman(z, 0.0, ChapmanMethod::huestis));
        const double below = std::exp(ln_chapman(z, -1e-12, ChapmanMethod::huestis));
        const double jump = std::sqrt(kPi * z / 2) * 15 / (128 * z * z);
        EXPECT_NEAR(above - below, 2 * jump, 0.2 * jump) << z;
        EXPECT_NEAR(chapman(z, 0.0), chapman(z, -1e-12), 1e-8) << z;
    }
}

TEST(Sweep, ChapmanIsAtLeastOneAndFallsWithTheCosine) {
    sweep([](SweepDraw& draw) -> std::string {
        const double z = draw.not_negative(), c = draw.between(-1, 1);
        const double value = ln_chapman(z, c);
        if (!(value >= 0)) return sweep_report("ln_chapman", {z, c}, value);
        if (c > 0 && !(value <= -std::log(c) * (1 + 1e-15) + 1e-15)) {
            return sweep_report("ln_chapman above the secant", {z, c}, value);
        }
        const double steeper = c + (1 - c) * draw.unit(), there = ln_chapman(z, steeper);
        if (!(there <= value + 4e-15 * std::max(1.0, value))) {
            return sweep_report("steeper", {z, c, steeper, value}, there);
        }
        return {};
    });
}

TEST(Sweep, ChapmanDistanceIsTheInverseOfTheColumn) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const double z = draw.decades(-3, 7), c = draw.between(-0.01, 1);
            const double whole = chapman(z, c);
            const double depth = whole * draw.unit();
            if (!std::isfinite(whole)) return {};
            const double distance = chapman_distance(z, c, depth);
            if (!(distance > 0 && distance < kInfinity)) {
                return sweep_report("chapman_distance", {z, c, depth}, distance);
            }
            // What remains beyond, seen from there.
            const double r = std::hypot(z * c + distance, z * std::sqrt((1 - c) * (1 + c)));
            const double cosine = std::min(1.0, std::max(-1.0, (z * c + distance) / r));
            const double rise = distance * (2 * z * c + distance) / (r + z);
            const double rest = std::exp(ln_chapman(r, cosine) - rise);
            // Rounding z and c where the rest begins moves it by a few roundings of z.
            if (!(std::abs(depth + rest - whole) <= (1e-12 + 1e-15 * z) * whole)) {
                return sweep_report("chapman in parts", {z, c, depth, distance, whole},
                                    depth + rest);
            }
            return {};
        },
        kSweepInputs);
}

}  // namespace
}  // namespace airlight
