// SPDX-License-Identifier: Apache-2.0
#include "medium/scaled_erfc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Measured: 9e-16.
constexpr double kDoubleTolerance = 1.5e-15;
// Half a unit in the last place of a float.
constexpr double kFloatTolerance = 6e-8;

TEST(ScaledErfc, MatchesEveryReferenceRow) {
    auto rows = reference_rows("exp2erfc.csv", 2, 69);
    const auto corners = reference_rows("exp2erfc_corners.csv", 2, 120);
    rows.insert(rows.end(), corners.begin(), corners.end());
    for (const auto& row : rows) {
        EXPECT_LT(relative_error(erfcx(row[0]), row[1]), kDoubleTolerance) << row[0];
        const float x = rounded(row[0]);
        const double there = erfcx(double{x});
        if (there < std::numeric_limits<float>::max() && there > 1e-37) {
            EXPECT_LT(relative_error(erfcx(x), there), kFloatTolerance) << x;
        }
    }
}

TEST(ScaledErfc, HasItsLimits) {
    EXPECT_EQ(erfcx(0.0), 1);
    EXPECT_EQ(erfcx(-0.0), 1);
    EXPECT_EQ(erfcx(kInfinity), 0);
    EXPECT_EQ(erfcx(-kInfinity), kInfinity);
    EXPECT_EQ(erfcx(-27.0), kInfinity);
    EXPECT_EQ(erfcx(-10.0f), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(erfcx(std::nan(""))));
    EXPECT_NEAR(erfcx(1e300) * 1e300, 1 / std::sqrt(3.14159265358979323846), 1e-15);
}

TEST(ScaledErfc, RationalRungHasTheMeasuredErrorsNotTheStatedOnes) {
    double absolute = 0, relative = 0, beyond = 0;
    for (int i = 0; i <= 2000000; ++i) {
        const auto x = static_cast<float>(1000 * std::pow(i / 2000000.0, 4));
        const double error = std::abs(erfcx_rational9(x) - erfcx(double{x}));
        absolute = std::max(absolute, error);
        relative = std::max(relative, error / erfcx(double{x}));
        const float far = x * 1e4f + 1000;
        beyond = std::max(beyond, relative_error(erfcx_rational9(far), erfcx(double{far})));
    }
    // Stated: 9.7e-7 and 1.092e-6 for every x, and no value above 1.
    EXPECT_GT(absolute, 9.3e-7);
    EXPECT_LT(absolute, 9.7e-7);
    EXPECT_GT(relative, 1.095e-6);
    EXPECT_LT(relative, 1.2e-6);
    EXPECT_GT(beyond, 1.7e-6);
    EXPECT_LT(beyond, 2e-6);
    EXPECT_GT(erfcx_rational9(0.0f), 1.0f);
    EXPECT_EQ(erfcx_rational9(std::numeric_limits<float>::infinity()), 0.0f);
    EXPECT_TRUE(std::isnan(erfcx_rational9(-1.0f)));
    EXPECT_TRUE(std::isnan(erfcx_rational9(std::nanf(""))));
}

TEST(Sweep, ErfcxIsPositiveFallsAndLiesBetweenItsBounds) {
    sweep([](SweepDraw& draw) -> std::string {
        const double x = draw.not_negative(), value = erfcx(x);
        // 2 / sqrt(pi) / (x + sqrt(x^2 + 2)) < erfcx(x) <= 2 / sqrt(pi) / (x + sqrt(x^2 + 4 / pi)).
        const double two_over_root_pi = 1.12837916709551257390;
        const double low = two_over_root_pi / 2 / (x / 2 + std::hypot(x, std::sqrt(2.0)) / 2);
        const double high = two_over_root_pi / 2 / (x / 2 + std::hypot(x, two_over_root_pi) / 2);
        if (!(value >= low * (1 - 2e-15) && value <= high * (1 + 2e-15))) {
            return sweep_report("erfcx", {x}, value);
        }
        const double further = x + draw.not_negative(), there = erfcx(further);
        if (!(there <= value * (1 + 2e-15))) return sweep_report("erfcx", {x, further}, there);
        const double mirrored = erfcx(-x);
        if (!(mirrored >= 1)) return sweep_report("erfcx", {-x}, mirrored);
        return {};
    });
}

}  // namespace
}  // namespace airlight
