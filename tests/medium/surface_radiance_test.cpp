// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_radiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/quadrature.h"
#include "medium/special_f.h"
#include "medium/surface_integral.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Measured: 6e-14 against the rule with half the step, over the whole domain.
constexpr double kDoubleTolerance = 1e-13;
// Computed in double and rounded once.
constexpr double kFloatTolerance = 6.1e-8;

// int_a^b f with nodes that crowd around a.
template <class Function>
double integrate_from(double a, double b, const Function& f) {
    const detail::QuadratureRule rule = detail::gauss_legendre(32);
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        for (const double x : {0.5 + 0.5 * rule.nodes[i].x, 0.5 - 0.5 * rule.nodes[i].x}) {
            sum += 0.5 * rule.nodes[i].w * 3 * x * x * (b - a) * f(a + (b - a) * x * x * x);
        }
    }
    return sum;
}

TEST(SurfaceRadiance, MatchesEveryReferenceRow) {
    for (const auto& row : reference_rows("surface_Gn.csv", 4, 550)) {
        const double t = row[0], theta = row[1], n = row[2];
        EXPECT_LT(relative_error(surface_radiance(t, theta, n), row[3]), kDoubleTolerance)
            << t << ' ' << theta << ' ' << n;
        const float tf = float(t), thetaf = float(theta), nf = float(n);
        EXPECT_LT(relative_error(surface_radiance(tf, thetaf, nf),
                                 surface_radiance(double{tf}, double{thetaf}, double{nf})),
                  kFloatTolerance)
            << t << ' ' << theta << ' ' << n;
    }
}

TEST(SurfaceRadiance, MatchesTheCornersComputedInManyDigits) {
    for (const auto& row : reference_rows("surface_Gn_corners.csv", 4, 150)) {
        EXPECT_LT(relative_error(surface_radiance_scaled(row[0], row[1], row[2]), row[3]),
                  kDoubleTolerance)
            << row[0] << ' ' << row[1] << ' ' << row[2];
    }
}

TEST(SurfaceRadiance, HasItsLimits) {
    EXPECT_LT(relative_error(surface_radiance(0.0, 0.0, 1.0), kPi * (0.5 * kPi + 1)), 1e-14);
    for (const double n : {1.0, 1.5, 20.0, 1000.0}) {
        for (const double theta : {0.0, 0.7, 0.5 * kPi, 2.0, kPi}) {
            const double thin = surface_radiance(0.0, theta, n);
            EXPECT_GT(thin, 0);
            EXPECT_LT(relative_error(surface_radiance(5e-324, theta, n), thin), 1e-13);
            // The next term is of order T ln T.
            EXPECT_LT(relative_error(surface_radiance(1e-12, theta, n), thin), 1e-9);
            EXPECT_EQ(surface_radiance(kInfinity, theta, n), 0);
            EXPECT_EQ(surface_radiance_scaled(kInfinity, theta, n), 0);
            EXPECT_EQ(surface_radiance(800.0, theta, n), 0);
            EXPECT_GT(surface_radiance(720.0, theta, n), 0);
        }
        // A narrow lobe away from the source sees one radiance, 2 pi PSF e^T / T, over its solid
        // angle 2 pi / (n + 1): at gamma = pi and T = 0 that is 1/2.
        EXPECT_LT(relative_error(surface_radiance(0.0, kPi, 1000.0), 0.5 * 2 * kPi / 1001), 1e-3);
    }
}

// (constant + 2 pi cos^n(theta) ln T) / T, [also where the integral itself is no longer taken].
TEST(SurfaceRadiance, FallsLikeALogarithmOverTInThickFog) {
    for (const double n : {1.0, 2.5, 100.0}) {
        for (const double theta : {0.0, 0.3, 1.2, 1.8, 3.0}) {
            const double slope = theta < 0.5 * kPi ? 2 * kPi * std::pow(std::cos(theta), n) : 0;
            const auto times_t = [&](double t) { return t * surface_radiance_scaled(t, theta, n); };
            double previous = times_t(1e14);
            for (const double t : {1e16, 1e17, 1e18, 1e30, 1e200, 1e307}) {
                const double value = times_t(t);
                EXPECT_LT(relative_error(value, times_t(1e15) + slope * std::log(t / 1e15)), 1e-12)
                    << n << ' ' << theta << ' ' << t;
                EXPECT_GE(value, previous * (1 - 1e-12));
                previous = value;
            }
        }
    }
}

// Half the step, at random and at every kink and scale of the integrand.
TEST(SurfaceRadiance, AFinerRuleChangesNothing) {
    const double half = 0.5 * kPi;
    double worst = 0;
    for (const double n : {1.0, 1.0001, 1.1, 1.5, 2.0, 2.999, 3.0, 5.5, 10.0, 15.9, 16.0, 19.9,
                           20.0, 24.0, 24.1, 50.0, 100.0, 300.0, 1000.0}) {
        const detail::LobeRing ring(n);
        const double sigma = 1 / std::sqrt(n);
        for (const double t : {0.0, 1e-300, 1e-3, 0.3, 1.0, 3.0, 5.0, 10.0, 21.0, 50.0, 300.0, 1e4,
                               1e6, 1e10, 1e17}) {
            for (const double theta :
                 {0.0,         1e-12,     1e-8,         1e-3,        0.03,
                  0.1,         0.2,       0.7,          1.2,         half - 1e-3,
                  half - 1e-8, half,      half + 1e-12, half + 1e-4, 1.7,
                  2.3,         2.8,       3.1,          kPi - 1e-8,  kPi,
                  sigma,       3 * sigma, 9 * sigma,    9.7 * sigma, kPi - 9.8 * sigma}) {
                if (!(theta >= 0 && theta <= kPi)) continue;
                const double value = detail::surface_integral(t, theta, ring);
                const double finer = detail::surface_integral(t, theta, ring, 2);
                worst = std::max(worst, relative_error(value, finer));
                ASSERT_LT(relative_error(value, finer), kDoubleTolerance)
                    << t << ' ' << theta << ' ' << n;
            }
        }
    }
    RecordProperty("worst", std::to_string(worst));
}

// Over all directions of the lobe's axis G_n averages to the lobe's solid angle times the kernel's
// energy, for which the zonal coefficient l = 0 of the point spread function is another way,
// int_0^inf e^{-T (e^t - 1)} ln coth(t / 2) dt.
TEST(SurfaceRadiance, IntegratesOverTheAxesToTheEnergyOfTheFog) {
    for (const double t : {0.0, 0.01, 0.5, 1.0, 4.0, 20.0}) {
        const auto kernel = [t](double s) {
            return std::exp(-t * std::expm1(s)) * -std::log(std::tanh(0.5 * s));
        };
        const double end = t > 0 ? std::min(40.0, std::log1p(45 / t)) : 40;
        const double energy = integrate_from(0, 1e-6, kernel) + integrate_from(1e-6, 1e-3, kernel) +
                              integrate_from(1e-3, 0.1, kernel) +
                              integrate_from(0.1, std::min(1.0, end), kernel) +
                              (end > 1 ? integrate_from(1, 6, kernel) : 0) +
                              (end > 6 ? integrate_from(6, end, kernel) : 0);
        if (t == 0) {
            EXPECT_LT(relative_error(energy, kPi * kPi / 4), 1e-13);
        }
        for (const double n : {1.0, 1.5, 4.0, 20.0, 24.5, 100.0}) {
            const detail::LobeRing ring(n);
            const auto band = [&](double theta) {
                return 2 * kPi * std::sin(theta) * detail::surface_integral(t, theta, ring);
            };
            const double half = 0.5 * kPi;
            const double whole = -integrate_from(half, 0.4, band) + integrate_from(0, 0.4, band) +
                                 integrate_from(half, kPi, band);
            EXPECT_LT(relative_error(whole, 2 * kPi / (n + 1) * 2 * kPi * energy), 3e-13)
                << t << ' ' << n;
        }
    }
}

// Two opposite cosines add up to one without a clamp, of degree 1; two squares to degrees 0 and 2.
TEST(SurfaceRadiance, OppositeLobesAddUpToPolynomials) {
    for (const double t : {0.0, 1e-5, 0.2, 1.0, 3.0, 10.0, 60.0, 1e5}) {
        const auto odd = [t](double theta) {
            return surface_radiance_scaled(t, theta, 1.0) -
                   surface_radiance_scaled(t, kPi - theta, 1.0);
        };
        const auto even = [t](double theta) {
            return surface_radiance_scaled(t, theta, 2.0) +
                   surface_radiance_scaled(t, kPi - theta, 2.0);
        };
        for (const double theta : {1e-9, 0.1, 0.7, 1.3, 0.5 * kPi - 1e-7}) {
            const double c = std::cos(theta);
            const double scale = surface_radiance_scaled(t, theta, 1.0);
            // Their difference keeps an absolute error.
            EXPECT_NEAR(odd(theta), c * odd(0), 2e-13 * scale) << t << ' ' << theta;
            const double edge = even(0.5 * kPi);
            EXPECT_LT(relative_error(even(theta), edge + c * c * (even(0) - edge)), 2e-13)
                << t << ' ' << theta;
        }
    }
}

TEST(SurfaceRadiance, IsSmoothInTheExponentAcrossItsMethods) {
    for (const double n : {1.0, 3.0, 16.0, 20.0, 24.0}) {
        for (const double t : {0.0, 0.5, 8.0, 100.0}) {
            for (const double theta : {0.0, 0.3, 1.0, 1.55, 1.7, 2.5, kPi}) {
                const double h = 1e-7;
                const double at = surface_radiance_scaled(t, theta, n);
                const double after = surface_radiance_scaled(t, theta, n + h);
                const double later = surface_radiance_scaled(t, theta, n + 2 * h);
                // h^2 times the second derivative of ln G, which is below 1, and three roundings.
                EXPECT_NEAR(2 * std::log(after / at), std::log(later / at), 1e-14 + 1e-13)
                    << t << ' ' << theta << ' ' << n;
            }
        }
    }
}

TEST(SurfaceRadiance, RefusesWhatIsOutsideItsDomainWithNan) {
    for (const auto f :
         {static_cast<double (*)(double, double, double)>(surface_radiance),
          static_cast<double (*)(double, double, double)>(surface_radiance_scaled)}) {
        EXPECT_TRUE(std::isnan(f(kNan, 1, 1)));
        EXPECT_TRUE(std::isnan(f(1, kNan, 1)));
        EXPECT_TRUE(std::isnan(f(1, 1, kNan)));
        EXPECT_TRUE(std::isnan(f(-1e-300, 1, 1)));
        EXPECT_TRUE(std::isnan(f(1, -1e-300, 1)));
        EXPECT_TRUE(std::isnan(f(1, 3.1415928, 1)));
        EXPECT_TRUE(std::isnan(f(1, 1, 0.999999)));
        EXPECT_TRUE(std::isnan(f(1, 1, 1000.001)));
        EXPECT_TRUE(std::isnan(f(kInfinity, 4, 1)));
        EXPECT_TRUE(std::isnan(f(-kInfinity, 1, 1)));
        EXPECT_TRUE(std::isnan(f(kInfinity, 1, kInfinity)));
    }
    EXPECT_EQ(surface_radiance(1.0, 3.1415927410125732, 2.0), surface_radiance(1.0, kPi, 2.0));
    EXPECT_EQ(surface_radiance(1.0f, 3.14159274f, 2.0f),
              static_cast<float>(surface_radiance(1.0, kPi, 2.0)));
    EXPECT_TRUE(std::isnan(surface_radiance(1.0f, 3.1415930f, 2.0f)));
}

// [Sun05] eq. 16 as printed, over the hemisphere of the lobe, by midpoints, with an F that is
// exact to rounding: what fails is the form of the integral.
double eq16(double t, double theta_s, double n, int steps) {
    const double d_theta = 0.5 * kPi / steps, d_phi = kPi / (2 * steps);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * d_theta;
        for (int j = 0; j < 2 * steps; ++j) {
            const double phi = (j + 0.5) * d_phi;
            const double cos_gamma = std::cos(theta) * std::cos(theta_s) +
                                     std::sin(theta) * std::sin(theta_s) * std::cos(phi);
            const double gamma = std::acos(cos_gamma), sine = std::sin(gamma);
            const double f = special_f(t * sine, 0.5 * kPi) - special_f(t * sine, 0.5 * gamma);
            sum += std::exp(-t * cos_gamma) / sine * f * std::pow(std::cos(theta), n) *
                   std::sin(theta);
        }
    }
    return 2 * sum * d_theta * d_phi;
}

TEST(SurfaceRadiance, HoldsWherePrintedEquation16Fails) {
    // 8192 values of F, and the pole still costs two percent; a narrow lobe more.
    for (const double theta : {0.3, 0.8, 1.2}) {
        EXPECT_GT(relative_error(eq16(1, theta, 1, 64), surface_radiance(1.0, theta, 1.0)), 1e-3)
            << theta;
    }
    // Behind the surface e^{T |cos gamma'|} times a vanishing difference: nothing is left of it.
    int broken = 0;
    for (const double t : {50.0, 100.0, 400.0, 800.0}) {
        const double printed = eq16(t, 3.0, 1, 16), exact = surface_radiance(t, 3.0, 1.0);
        if (!(relative_error(printed, exact) < 0.5)) ++broken;
        EXPECT_TRUE(exact > 0 || t > 745);
        EXPECT_GT(surface_radiance_scaled(t, 3.0, 1.0), 0);
    }
    EXPECT_GE(broken, 2);
    // With n = 0, as the name G_0 and eq. 16 have it, a Lambertian surface would be a fifth too
    // bright at the least: the paper's own peak pi (pi/2 + 1) needs n = 1.
    EXPECT_GT(eq16(1e-9, 0, 0, 64) / surface_radiance(0.0, 0.0, 1.0), 1.2);
}

}  // namespace
}  // namespace airlight
