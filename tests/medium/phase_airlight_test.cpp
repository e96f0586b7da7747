// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_airlight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/phase_airlight_method.h"
#include "medium/psf.h"
#include "medium/quadrature.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Measured: 1.9e-15 on the corners, 3e-14 where two ways through the library are compared.
constexpr double kDoubleTolerance = 1e-14;
constexpr double kFloatTolerance = 6.1e-8;
// Below this a double has lost digits to underflow.
constexpr double kNormal = 1e-290;

PhaseFunction hg(double g) {
    return PhaseFunction::henyey_greenstein(g);
}

PhaseFunction droplets(PhaseInterpolation interpolation) {
    return PhaseFunction::tabulated({{0.0, 0.05, 0.2, 0.7, 1.6, 2.4, 2.9, kPi},
                                     {900, 300, 40, 3, 0.2, 0.6, 0.35, 1.1},
                                     interpolation});
}

// Composite quadrature of f over [a, b] in panels of a fixed number.
double panels(double a, double b, int count, const std::function<double(double)>& f) {
    const detail::QuadratureRule rule = detail::gauss_legendre(16);
    double sum = 0;
    for (int k = 0; k < count; ++k) {
        const double half = (b - a) / (2 * count), centre = a + half * (2 * k + 1);
        for (int i = 0; i < rule.count; ++i) {
            const double offset = half * rule.nodes[i].x;
            sum += half * rule.nodes[i].w * (f(centre + offset) + f(centre - offset));
        }
    }
    return sum;
}

// e^{t_sv} airlight along the ray in t, as the integral is defined, with cosines; t = t_sv cos +
// t_sv sin sinh(z). Cuts where the scattering angle is a knot. Ordinary sizes only.
double slow_scaled(double gamma, double t_sv, double t_vp, const PhaseFunction& phase) {
    const double foot = t_sv * std::cos(gamma), height = t_sv * std::sin(gamma);
    const double end = std::min(t_vp, t_sv + 60);
    std::vector<double> cuts = {std::asinh(-foot / height), std::asinh((end - foot) / height)};
    if (phase.table() != nullptr) {
        for (const double knot : phase.table()->knots()) {
            const double z = knot == 0 ? -800 : std::asinh(-1 / std::tan(knot));
            if (z > cuts[0] && z < cuts[1]) cuts.push_back(z);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        sum += panels(cuts[k], cuts[k + 1], 40, [&](double z) {
            const double u = height * std::sinh(z), d = height * std::cosh(z);
            // Light goes from the source to the point, then back along the ray to the viewer.
            const double angle = std::atan2(height, -u);
            return phase.at_angle(angle) * std::exp(t_sv - (foot + u) - d) / d;
        });
    }
    return sum;
}

TEST(PhaseAirlight, MatchesTheCornersComputedInManyDigits) {
    int compared = 0;
    for (const auto& row : reference_rows("airlight_hg_corners.csv", 6, 500)) {
        const double gamma = row[0], t_sv = row[1], t_vp = row[2], g = row[3];
        EXPECT_LT(relative_error(airlight_scaled(gamma, t_sv, t_vp, hg(g)), row[5]),
                  kDoubleTolerance)
            << gamma << ' ' << t_sv << ' ' << t_vp << ' ' << g;
        const float gf = float(gamma), sf = float(t_sv), vf = float(t_vp), af = float(g);
        if (std::fabs(af) < 1) {
            EXPECT_LT(relative_error(airlight_hg(gf, sf, vf, af),
                                     static_cast<float>(airlight_hg(double{gf}, double{sf},
                                                                    double{vf}, double{af}))),
                      kFloatTolerance);
        }
        if (row[4] < kNormal) continue;
        ++compared;
        EXPECT_LT(relative_error(airlight_hg(gamma, t_sv, t_vp, g), row[4]), kDoubleTolerance)
            << gamma << ' ' << t_sv << ' ' << t_vp << ' ' << g;
    }
    EXPECT_GT(compared, 300);
    for (const auto& row : reference_rows("airlight_rayleigh_corners.csv", 5, 150)) {
        EXPECT_LT(relative_error(airlight_scaled(row[0], row[1], row[2], PhaseFunction::rayleigh()),
                                 row[4]),
                  kDoubleTolerance)
            << row[0] << ' ' << row[1] << ' ' << row[2];
    }
}

TEST(PhaseAirlight, MatchesTheIntegralAlongTheRay) {
    for (const auto& phase :
         {hg(0.7), hg(-0.6), PhaseFunction::rayleigh(), droplets(PhaseInterpolation::linear),
          droplets(PhaseInterpolation::monotone)}) {
        for (const double gamma : {0.02, 0.3, 1.5, 2.6, 3.1}) {
            for (const double t_sv : {0.05, 1.0, 8.0}) {
                for (const double t_vp : {0.01, 0.5, 1.0, 20.0, kInfinity}) {
                    // The slow way leaves 1e-13 of cancelling cosines.
                    EXPECT_LT(relative_error(airlight_scaled(gamma, t_sv, t_vp, phase),
                                             slow_scaled(gamma, t_sv, t_vp, phase)),
                              1e-12)
                        << phase.g() << ' ' << gamma << ' ' << t_sv << ' ' << t_vp;
                }
            }
        }
    }
}

TEST(PhaseAirlight, IsotropicIsTheIsotropicFunctionAndTheLimitOfTheOthers) {
    const PhaseFunction isotropic, flat = PhaseFunction::tabulated({{0, 1, 3}, {2, 2, 2}});
    for (const double gamma : {1e-200, 1e-3, 1.0, 3.0, kPi}) {
        for (const double t_sv : {1e-100, 0.3, 5.0, 300.0}) {
            for (const double t_vp : {1e-150, 0.2, 7.0, kInfinity}) {
                const double expected = airlight(gamma, t_sv, t_vp);
                EXPECT_EQ(airlight(gamma, t_sv, t_vp, isotropic), expected);
                EXPECT_EQ(airlight_hg(gamma, t_sv, t_vp, 0.0), expected);
                for (const PhaseFunction& phase : {hg(1e-17), hg(-1e-17), flat}) {
                    // airlight() itself is good to 3e-14.
                    EXPECT_LT(relative_error(airlight(gamma, t_sv, t_vp, phase), expected), 1e-13)
                        << gamma << ' ' << t_sv << ' ' << t_vp;
                }
            }
            EXPECT_EQ(psf(t_sv, gamma, isotropic), psf(t_sv, gamma));
            EXPECT_EQ(psf_scaled(t_sv, gamma, isotropic), psf_scaled(t_sv, gamma));
            EXPECT_EQ(psf_factored(t_sv, gamma, isotropic), psf_factored(t_sv, gamma));
            EXPECT_LT(relative_error(psf(t_sv, gamma, hg(1e-17)), psf(t_sv, gamma)), 1e-13);
            // The part of g^2 is 5 P_2, Rayleigh is 1 + P_2 / 2.
            const double g = 1e-3, middle = psf(t_sv, gamma);
            const double second = psf_hg(t_sv, gamma, g) + psf_hg(t_sv, gamma, -g) - 2 * middle;
            const double rayleigh = psf(t_sv, gamma, PhaseFunction::rayleigh());
            EXPECT_NEAR(rayleigh, middle + second / (20 * g * g), 2e-5 * middle);
        }
    }
}

TEST(PhaseAirlight, ForwardScatteringBrightensTheGlowAndDarkensTheRest) {
    double behind = kInfinity, beside = 0;
    for (const double g : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
        const double rest = psf_hg(1.0, 3.0, g), glow = psf_hg(1.0, 0.02, g);
        EXPECT_LT(rest, behind) << g;
        EXPECT_TRUE(g <= 0 || glow > beside) << g;
        behind = rest;
        beside = glow;
    }
    // Near the light the scaled form is int p / gamma: half the circle that p would give both ways.
    for (const double g : {-0.8, 0.3, 0.9}) {
        const double whole = panels(0, kPi, 200, [&](double a) { return hg(g).at_angle(a); });
        EXPECT_LT(relative_error(psf_scaled(0.5, 1e-9, hg(g)) * 1e-9, whole), 1e-6) << g;
    }
}

// An order of integration that the library never uses.
TEST(PhasePsf, EnergyOverTheSphereIsTheClosedDoubleIntegral) {
    for (const auto& phase : {hg(0.7), hg(-0.6), PhaseFunction(), PhaseFunction::rayleigh(),
                              droplets(PhaseInterpolation::monotone)}) {
        for (const double t : {0.0, 0.05, 1.0, 6.0}) {
            double energy = 0, expected = 0;
            double begin = 0;
            for (double end = 1e-9; begin < kPi; end = std::min(kPi, 1.7 * end)) {
                energy += panels(begin, end, 2, [&](double gamma) {
                    return 2 * kPi * std::sin(gamma) * psf_scaled(t, gamma, phase);
                });
                begin = end;
            }
            std::vector<double> cuts = {0, 0.01, 0.1, 0.5, 1, 2, kPi};
            for (double left = 0.7; left > 1e-8; left /= 2) cuts.push_back(kPi - left);
            if (phase.table() != nullptr) {
                for (const double knot : phase.table()->knots()) cuts.push_back(knot);
            }
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
                expected += panels(cuts[k], cuts[k + 1], 4, [&](double alpha) {
                    const double half = alpha / 2;
                    // The exponent 1 - cos(phi) / cos(half) from the outer end, psi = half - phi.
                    const auto transmittance = [&](double psi) {
                        const double lag = 2 * std::sin(psi / 2) * std::sin(half - psi / 2);
                        return std::exp(-t * lag / std::cos(half));
                    };
                    double inner = 0, from = 0;
                    for (double to = half * 0x1p-36; from < half; to = std::min(half, 2 * to)) {
                        inner += panels(from, to, 1, transmittance);
                        from = to;
                    }
                    return 4 * kPi * phase.at_angle(alpha) * inner;
                });
            }
            // What the last 1e-8 before alpha = pi add.
            EXPECT_LT(relative_error(energy, expected), 1e-7) << phase.g() << ' ' << t;
        }
    }
}

TEST(PhasePsf, TheThinLimitIsTheRestOfThePhaseFunction) {
    for (const double g : {-0.9, 0.4, 0.95}) {
        for (const double gamma : {0.01, 1.0, 3.0}) {
            const double rest =
                panels(gamma, kPi, 400, [&](double a) { return hg(g).at_angle(a); });
            EXPECT_LT(relative_error(psf_scaled(0.0, gamma, hg(g)), rest / std::sin(gamma)), 1e-12);
            EXPECT_LT(relative_error(psf_scaled(1e-300, gamma, hg(g)), rest / std::sin(gamma)),
                      1e-12);
        }
    }
    EXPECT_LT(relative_error(npsf(0.3, hg(0.5)), psf(1.0, 0.3, hg(0.5)) * std::exp(1.0)), 1e-15);
    EXPECT_LT(
        relative_error(psf_factored(2.0, 0.3, hg(0.5)), 2 * std::exp(-2.0) * npsf(0.3, hg(0.5))),
        1e-15);
}

// What any phase function gives lies between its extremes times the isotropic result.
TEST(PhaseAirlight, SweepStaysBetweenTheExtremesOfThePhaseFunction) {
    sweep([](SweepDraw& draw) -> std::string {
        const double g =
            draw.chance(0.5) ? draw.uniform(-1, 1) : draw.sign() * (1 - draw.decades(-15.9, 0));
        const double gamma = draw.angle();
        const double t_sv = draw.not_negative(), t_vp = draw.not_negative();
        const double value = airlight_hg(gamma, t_sv, t_vp, g);
        const double isotropic = airlight(gamma, t_sv, t_vp);
        if (!(isotropic > 1e-290 && isotropic < kInfinity) || t_vp < 1e-290 * t_sv) {
            // 4 pi p reaches from 1e-33 to 1e33, and denormals have no relative accuracy.
            return value >= 0 ? "" : sweep_report("airlight_hg", {gamma, t_sv, t_vp, g}, value);
        }
        const double a = std::fabs(g), least = (1 - a) / ((1 + a) * (1 + a));
        const double most = (1 + a) / ((1 - a) * (1 - a));
        const double slack = 1 + 2e-13;
        if (!(value <= isotropic * most * slack) || !(value * slack >= isotropic * least)) {
            return sweep_report("airlight_hg", {gamma, t_sv, t_vp, g}, value);
        }
        return "";
    });
}

// The medium behind a point of the ray is airlight seen from there.
TEST(PhaseAirlight, SweepOfSegmentsAddsUp) {
    sweep([](SweepDraw& draw) -> std::string {
        const double g = draw.uniform(-0.99, 0.99), gamma = draw.uniform(0.01, 3.1);
        const double t_sv = draw.decades(-3, 1.5), first = t_sv * draw.decades(-2, 1);
        const double second = draw.chance(0.3) ? kInfinity : t_sv * draw.decades(-2, 1);
        const double along = first - t_sv * std::cos(gamma), height = t_sv * std::sin(gamma);
        const double from_there = std::atan2(height, -along), distance = std::hypot(along, height);
        const double whole = airlight_hg(gamma, t_sv, first + second, g);
        const double parts = airlight_hg(gamma, t_sv, first, g) +
                             std::exp(-first) * airlight_hg(from_there, distance, second, g);
        // Geometry in doubles: 1e-16 of angles that the peak magnifies a hundredfold.
        if (relative_error(whole, parts) > 1e-12) {
            return sweep_report("parts of airlight_hg", {gamma, t_sv, first, second, g},
                                parts / whole - 1);
        }
        return "";
    });
}

TEST(PhasePsf, SweepIsPositiveAndFallsWithTheThickness) {
    sweep([](SweepDraw& draw) -> std::string {
        const double gamma = draw.angle(), t = draw.not_negative(false);
        const double g = draw.uniform(-1, 1);
        const PhaseFunction phase = draw.chance(0.8) ? hg(g) : PhaseFunction::rayleigh();
        const double value = psf_scaled(t, gamma, phase);
        if (gamma == 0) return value == kInfinity ? "" : "no peak";
        if (!(value >= 0) || (gamma > 1e-300 && !(value < kInfinity))) {
            return sweep_report("psf_scaled", {t, gamma, g}, value);
        }
        if (!(psf(t, gamma, phase) >= 0)) return sweep_report("psf", {t, gamma, g}, value);
        if (t < 1e300 && draw.chance(0.2) &&
            psf_scaled(1.01 * t, gamma, phase) > value * (1 + 1e-14)) {
            return sweep_report("psf_scaled grows", {t, gamma, g}, value);
        }
        return "";
    });
}

TEST(PhaseAirlight, TablesSweepWithoutNan) {
    const PhaseFunction tables[] = {droplets(PhaseInterpolation::linear),
                                    droplets(PhaseInterpolation::monotone),
                                    PhaseFunction::tabulated({{1.0, 1.1}, {0, 5}})};
    const double most[] = {4 * kPi * tables[0].at_angle(0), 4 * kPi * tables[1].at_angle(0),
                           4 * kPi * tables[2].at_angle(2)};
    sweep(
        [&](SweepDraw& draw) -> std::string {
            const std::size_t i = draw.bits() % 3;
            const double gamma = draw.angle();
            const double t_sv = draw.not_negative(), t_vp = draw.not_negative();
            const double value = airlight(gamma, t_sv, t_vp, tables[i]);
            const double isotropic = airlight(gamma, t_sv, t_vp);
            const bool accurate = isotropic > 1e-290 && t_vp > 1e-290 * t_sv;
            if (!(value >= 0) || (accurate && value > isotropic * most[i] * (1 + 1e-12))) {
                return sweep_report("airlight of a table", {gamma, t_sv, t_vp, double(i)}, value);
            }
            return "";
        },
        kSweepInputs / 5);
}

// The errors that medium/phase_airlight_method.h quotes, on rays like those of its sets.
TEST(PhaseAirlight, RungsHaveTheirErrors) {
    const double limits[] = {5, 0.05, 2e-3, 3e-7, 0};
    for (const NamedMethod<PhaseAirlightMethod>& info : kPhaseAirlightMethods) {
        EXPECT_EQ(method_from_name(kPhaseAirlightMethods, info.name), info.method);
        double worst = 0;
        for (std::size_t i = 0; i < 3000; ++i) {
            SweepDraw draw(i);
            const double g = draw.uniform(-0.95, 0.95), gamma = draw.uniform(0.02, 3.1);
            const double t_sv = draw.uniform(0.01, 10), t_vp = draw.uniform(0.01, 10);
            const double value = airlight_hg(gamma, t_sv, t_vp, g, info.method);
            worst = std::max(worst, relative_error(value, airlight_hg(gamma, t_sv, t_vp, g)));
        }
        EXPECT_LE(worst, limits[static_cast<int>(info.method)]) << info.name;
        // Not the exact method by another name.
        EXPECT_EQ(worst > 0, info.method != PhaseAirlightMethod::exact) << info.name;
        for (const double gamma : {0.0, 5e-324, 1e-8, 1.0, kPi}) {
            for (const double t : {0.0, 5e-324, 1e-300, 1.0, 1e300, kInfinity}) {
                for (const double v : {0.0, 5e-324, 0.5 * t, t, 1e300, kInfinity}) {
                    EXPECT_GE(airlight_hg(gamma, t, v, 0.9, info.method), 0)
                        << info.name << ' ' << gamma << ' ' << t << ' ' << v;
                }
            }
        }
        EXPECT_TRUE(std::isnan(airlight_hg(1.0, 1.0, 1.0, 1.0, info.method)));
        EXPECT_TRUE(std::isnan(airlight_hg(1.0, -1.0, 1.0, 0.5, info.method)));
    }
    EXPECT_FALSE(method_from_name(kPhaseAirlightMethods, "magic").has_value());
}

TEST(PhaseAirlight, CornersAndRefusals) {
    // A ray that ends short of the light straight ahead scatters by 0.
    EXPECT_LT(relative_error(airlight_hg(0.0, 2.0, 0.5, 0.9),
                             phase_hg_at_angle(0.0, 0.9) * std::exp(-2.0) * 0.5 / (2 * 1.5)),
              1e-15);
    EXPECT_EQ(airlight_hg(0.0, 2.0, 2.0, 0.9), kInfinity);
    EXPECT_EQ(airlight_hg(0.0, 2.0, kInfinity, 0.9), kInfinity);
    EXPECT_EQ(airlight_hg(1.0, 0.0, 1.0, 0.9), kInfinity);
    EXPECT_EQ(airlight_hg(1.0, kInfinity, 1.0, 0.9), 0);
    EXPECT_EQ(airlight_hg(1.0, 1.0, 0.0, 0.9), 0);
    EXPECT_EQ(psf_hg(0.0, 1.0, 0.9), 0);
    EXPECT_EQ(psf_hg(1.0, 0.0, 0.9), kInfinity);
    EXPECT_EQ(psf_hg(800.0, 1.0, 0.9), 0);
    EXPECT_EQ(psf_scaled(kInfinity, 1.0, hg(0.9)), 0);
    for (const double bad : {1.0, -1.0, 2.0, kNan, kInfinity}) {
        EXPECT_TRUE(std::isnan(airlight_hg(1.0, 1.0, 1.0, bad)));
        EXPECT_TRUE(std::isnan(psf_hg(1.0, 1.0, bad)));
    }
    for (const auto& phase : {hg(0.5), PhaseFunction(), PhaseFunction::rayleigh(),
                              droplets(PhaseInterpolation::linear)}) {
        EXPECT_TRUE(std::isnan(airlight(kNan, 1.0, 1.0, phase)));
        EXPECT_TRUE(std::isnan(airlight(1.0, -1.0, 1.0, phase)));
        EXPECT_TRUE(std::isnan(airlight(1.0, 1.0, -1.0, phase)));
        EXPECT_TRUE(std::isnan(airlight_scaled(3.2, 1.0, 1.0, phase)));
        EXPECT_TRUE(std::isnan(psf(-1.0, 1.0, phase)));
        EXPECT_TRUE(std::isnan(psf_scaled(1.0, kNan, phase)));
        EXPECT_TRUE(std::isnan(psf_factored(kNan, 1.0, phase)));
        EXPECT_GT(psf(1.0f, 3.14159274f, phase), 0);
    }
}

}  // namespace
}  // namespace airlight
