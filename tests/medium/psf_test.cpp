// SPDX-License-Identifier: Apache-2.0
#include "medium/psf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/constants.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/slow_reference.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Measured: 1.2e-14, the cancellation of the series for E1 at gamma = pi, T = .75.
constexpr double kDoubleTolerance = 1e-13;
// One rounding of the result and one of the caller's arithmetic.
constexpr double kFloatTolerance = 2.4e-7;

TEST(Psf, MatchesEveryReferenceRow) {
    for (const auto& row : reference_rows("psf.csv", 3, 204)) {
        const double t = row[0], gamma = row[1];
        EXPECT_LT(relative_error(psf(t, gamma), row[2]), kDoubleTolerance) << t << ' ' << gamma;
        const float tf = static_cast<float>(t), gf = static_cast<float>(gamma);
        EXPECT_LT(relative_error(psf(tf, gf), psf(double{tf}, double{gf})), kFloatTolerance)
            << t << ' ' << gamma;
    }
    for (const auto& row : reference_rows("npsf.csv", 2, 17)) {
        EXPECT_LT(relative_error(npsf(row[0]), row[1]), kDoubleTolerance) << row[0];
        const float gf = static_cast<float>(row[0]);
        EXPECT_LT(relative_error(npsf(gf), npsf(double{gf})), kFloatTolerance) << row[0];
    }
}

TEST(Psf, MatchesTheCornersComputedInManyDigits) {
    for (const auto& row : reference_rows("psf_corners.csv", 3, 200)) {
        EXPECT_LT(relative_error(psf_scaled(row[0], row[1]), row[2]), kDoubleTolerance)
            << row[0] << ' ' << row[1];
    }
}

TEST(Psf, MatchesASlowQuadrature) {
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 10000; ++i) {
        const double t = std::pow(10.0, -6 + 8.5 * unit(random));
        const double gamma =
            i % 3 ? 1e-6 + 3.1415 * unit(random) : std::pow(10.0, -8 * unit(random));
        ASSERT_LT(
            relative_error(psf_scaled(t, gamma), t * slow_airlight_scaled(gamma, t, kInfinity)),
            kDoubleTolerance)
            << t << ' ' << gamma;
    }
}

// The errors of [Sun05] app. C as they come out; its "well below 0.05" holds down to gamma = .1.
TEST(PsfFactored, HasTheErrorsOfTheFactorisation) {
    const double gammas[] = {1, .3, .1, .03, .01};
    const double means[] = {.0061, .022, .047, .081, .113};
    const double maxima[] = {.010, .030, .068, .121, .172};
    for (int k = 0; k < 5; ++k) {
        double mean = 0, maximum = 0;
        for (int i = 0; i < 11; ++i) {
            const double t = 0.1 + 0.3 * i;
            const double error = std::abs(psf_factored(t, gammas[k]) - psf(t, gammas[k]));
            mean += error / 11;
            maximum = std::max(maximum, error);
        }
        // Half a unit of the last digit that is quoted.
        EXPECT_NEAR(mean, means[k], k == 0 ? 5e-5 : 5e-4) << gammas[k];
        EXPECT_NEAR(maximum, maxima[k], 5e-4) << gammas[k];
    }
    EXPECT_LT(relative_error(psf_factored(1.0, 0.5), psf(1.0, 0.5)), 1e-15);
}

TEST(Psf, ScaledFormTendsToItsLimits) {
    for (const double gamma : {1e-3, 0.1, 1.0, 2.0, 3.0, 3.1415, kPi}) {
        // (pi - gamma) / sin(gamma), written with the complement so that gamma = pi is exact.
        const double complement = (kPi - gamma) + 1.2246467991473532e-16;
        const double sine = std::sin(std::min(gamma, complement));
        const double thin = complement / (4 * kPi * sine);
        EXPECT_LT(relative_error(psf_scaled(0.0, gamma), thin), 1e-15) << gamma;
        EXPECT_LT(relative_error(psf_scaled(1e-300, gamma), thin), 1e-15) << gamma;
        // The next term is of order T ln T.
        EXPECT_LT(relative_error(psf_scaled(1e-9, gamma), thin), 1e-7) << gamma;
        const double s = std::sin(gamma / 2);
        const double thick = 1 / (8 * kPi * 1e300 * s * s);
        EXPECT_LT(relative_error(psf_scaled(1e300, gamma), thick), 1e-14) << gamma;
        EXPECT_EQ(psf_scaled(kInfinity, gamma), 0);
    }
    for (const double t : {0.0, 1e-8, 0.5, 10.0, 200.0}) {
        EXPECT_LT(relative_error(psf_scaled(t, 1e-12), 0.25e12), 1e-8) << t;
        EXPECT_EQ(psf_scaled(t, 0.0), kInfinity) << t;
    }
}

TEST(Psf, IsNeverNegativeNorNanAndFallsWithAngleAndThickness) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 300000; ++i) {
        const double t = std::pow(10.0, -12 + 16 * unit(random));
        double gamma = kPi * unit(random);
        if (i % 3 == 0) gamma = std::pow(10.0, -300 * unit(random));
        if (i % 3 == 1) gamma = kPi - std::pow(10.0, -16 * unit(random));
        const double value = psf_scaled(t, gamma);
        ASSERT_GT(value, 0) << t << ' ' << gamma;
        ASSERT_LT(value, kInfinity) << t << ' ' << gamma;
        // Twice the rounding of both values.
        ASSERT_LE(psf_scaled(t * 1.01, gamma), value * (1 + 1e-13)) << t << ' ' << gamma;
        ASSERT_LE(psf_scaled(t, std::min(kPi, gamma * 1.01)), value * (1 + 1e-13));
        ASSERT_GE(psf(t, gamma), 0);
    }
}

TEST(Psf, IsContinuousWhereItsFormulasMeet) {
    for (const double gamma : {1e-6, 0.1, 1.0, 2.0, 3.0, kPi}) {
        for (const double y : {2 - 0.5 * std::sin(gamma / 2), 8.0}) {
            const double t = y / (2 * std::sin(gamma / 2));
            // The function itself moves by less than the relative step.
            EXPECT_LT(relative_error(psf_scaled(t * (1 - 1e-14), gamma),
                                     psf_scaled(t * (1 + 1e-14), gamma)),
                      kDoubleTolerance)
                << gamma << ' ' << y;
        }
    }
}

TEST(Psf, RefusesWhatIsOutsideItsDomainWithNan) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto f : {static_cast<double (*)(double, double)>(psf),
                         static_cast<double (*)(double, double)>(psf_scaled),
                         static_cast<double (*)(double, double)>(psf_factored)}) {
        EXPECT_TRUE(std::isnan(f(nan, 1.0)));
        EXPECT_TRUE(std::isnan(f(1.0, nan)));
        EXPECT_TRUE(std::isnan(f(-1e-9, 1.0)));
        EXPECT_TRUE(std::isnan(f(1.0, -1e-300)));
        EXPECT_TRUE(std::isnan(f(1.0, 3.15)));
        EXPECT_TRUE(std::isnan(f(1.0, kInfinity)));
        EXPECT_FALSE(std::isnan(f(1.0, kPi)));
    }
    EXPECT_GT(psf_scaled(1.0f, 3.14159274f), 0);
    // Representable although a factor is not.
    EXPECT_LT(relative_error(psf(1e-5, 1e-309), 0.25e304 * std::exp(-1e-5)), 1e-14);
    EXPECT_LT(relative_error(psf(740.0, 1e-300), 185e300 * std::exp(-370.0) * std::exp(-370.0)),
              1e-13);
    EXPECT_EQ(psf(0.0, 1.0), 0);
    EXPECT_EQ(psf(0.0, 0.0), 0);
    EXPECT_EQ(psf(800.0, 0.5), 0);
    EXPECT_EQ(psf(kInfinity, 0.5), 0);
}

}  // namespace
}  // namespace airlight
