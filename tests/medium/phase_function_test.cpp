// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/constants.h"
#include "core/error.h"
#include "medium/quadrature.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A forward peak, a dip and a glory, as droplets have them.
PhaseTable droplets(PhaseInterpolation interpolation) {
    return {{0.0, 0.05, 0.2, 0.7, 1.6, 2.4, 2.9, kPi},
            {900, 300, 40, 3, 0.2, 0.6, 0.35, 1.1},
            interpolation};
}

std::vector<PhaseFunction> examples() {
    std::vector<PhaseFunction> phases = {PhaseFunction::isotropic(), PhaseFunction::rayleigh()};
    for (const double g : {-0.999, -0.5, -1e-9, 0.0, 0.3, 0.85, 0.999, 1 - 1e-9}) {
        phases.push_back(PhaseFunction::henyey_greenstein(g));
    }
    for (const auto each : {PhaseInterpolation::linear, PhaseInterpolation::monotone}) {
        phases.push_back(PhaseFunction::tabulated(droplets(each)));
        phases.push_back(PhaseFunction::tabulated({{1.0, 1.1}, {0, 5}, each}));
    }
    return phases;
}

// 2 pi int f p sin over [0, end]. Panels double away from either peak, and end at knots.
double integrate(const PhaseFunction& phase, double end, const std::function<double(double)>& f) {
    std::vector<double> cuts = {0, end};
    for (double angle = 1e-12; angle < 2; angle *= 1.5) {
        for (const double cut : {angle, kPi - angle}) {
            if (cut < end) cuts.push_back(cut);
        }
    }
    if (phase.table() != nullptr) {
        for (const double knot : phase.table()->knots()) {
            if (knot < end) cuts.push_back(knot);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    const detail::QuadratureRule rule = detail::gauss_legendre(16);
    double sum = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const double centre = (cuts[k] + cuts[k + 1]) / 2, half = (cuts[k + 1] - cuts[k]) / 2;
        for (int i = 0; i < rule.count; ++i) {
            for (const double angle :
                 {centre + half * rule.nodes[i].x, centre - half * rule.nodes[i].x}) {
                sum += half * rule.nodes[i].w * 2 * kPi * f(angle) * phase.at_angle(angle) *
                       std::sin(angle);
            }
        }
    }
    return sum;
}

TEST(PhaseFunction, AllIntegrateToOneAndHaveTheirMeanCosine) {
    for (const PhaseFunction& phase : examples()) {
        EXPECT_NEAR(integrate(phase, kPi, [](double) { return 1; }), 1, 1e-13) << phase.g();
        EXPECT_NEAR(integrate(phase, kPi, [](double a) { return std::cos(a); }),
                    phase.mean_cosine(), 1e-13)
            << phase.g();
    }
}

// The convention: 0 is straight on, so that a positive g sends light forward.
TEST(PhaseFunction, AngleZeroIsForward) {
    const PhaseFunction forward = PhaseFunction::henyey_greenstein(0.8);
    EXPECT_GT(forward.at_angle(0), 100 * forward.at_angle(kPi));
    EXPECT_GT(forward.at_cosine(1), 100 * forward.at_cosine(-1));
    EXPECT_GT(phase_hg(1.0, 0.8), 100 * phase_hg(-1.0, 0.8));
    EXPECT_GT(forward.mean_cosine(), 0);
    // Nine tenths of the light stay within a quarter turn.
    EXPECT_LT(forward.sample_angle(0.9), kPi / 2);
    EXPECT_LT(PhaseFunction::tabulated(droplets(PhaseInterpolation::linear)).sample_angle(0.5),
              0.7);
}

TEST(PhaseFunction, HenyeyGreensteinMatchesItsCornersInManyDigits) {
    for (const auto& row : reference_rows("phase_hg_corners.csv", 3, 200)) {
        EXPECT_LT(relative_error(phase_hg(row[0], row[1]), row[2]), 2e-15)
            << row[0] << ' ' << row[1];
        const float c = static_cast<float>(row[0]), g = static_cast<float>(row[1]);
        if (std::fabs(g) == 1) continue;
        EXPECT_LT(relative_error(phase_hg(c, g), phase_hg(double{c}, double{g})), 6e-8);
    }
}

// The printed denominator loses every digit at the peak: at g = 1 - 1e-9 it is 0 or worse.
TEST(PhaseFunction, ThePrintedDenominatorFailsWhereOursDoesNot) {
    const double g = 1 - 1e-9, exact = (1 + g) / (4 * kPi) / ((1 - g) * (1 - g));
    const double printed = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g, 1.5));
    EXPECT_FALSE(relative_error(printed, exact) < 0.5) << printed;
    EXPECT_LT(relative_error(phase_hg(1.0, g), exact), 1e-15);
    EXPECT_LT(relative_error(phase_hg_at_angle(0.0, g), exact), 1e-15);
    // Its cosine says nothing about an angle of 1e-9, half way down the peak.
    EXPECT_LT(relative_error(phase_hg_at_angle(1e-9, g), exact / std::pow(1 + g, 1.5)), 1e-6);
    EXPECT_EQ(phase_hg(std::cos(1e-9), g), phase_hg(1.0, g));
}

TEST(PhaseFunction, SpecialCasesAgree) {
    for (double angle = 0; angle < kPi; angle += 0.1) {
        const double c = std::cos(angle);
        EXPECT_LT(relative_error(phase_hg(c, 0.0), 1 / (4 * kPi)), 1e-15);
        EXPECT_EQ(phase_rayleigh(c), phase_rayleigh(-c));
        EXPECT_LT(relative_error(phase_hg(c, 0.7), phase_hg(-c, -0.7)), 1e-15);
        // g^2 carries 5 P_2, and Rayleigh is 1 + P_2 / 2.
        const double second = phase_hg(c, 1e-4) + phase_hg(c, -1e-4) - 2 / (4 * kPi);
        EXPECT_NEAR(1 / (4 * kPi) + second / 1e-8 / 20, phase_rayleigh(c), 1e-8);
        for (const PhaseFunction& phase : examples()) {
            // What a cosine loses beside the peak.
            if (1 - std::fabs(phase.g()) < 1e-2) continue;
            EXPECT_LT(relative_error(phase.at_cosine(c), phase.at_angle(angle)), 2e-13);
        }
    }
}

TEST(PhaseFunction, SampledAnglesHaveTheDensity) {
    for (const PhaseFunction& phase : examples()) {
        double before = 0;
        for (const double xi : {0.0, 1e-12, 1e-3, 0.1, 0.3, 0.5, 0.50001, 0.9, 0.999, 1.0}) {
            const double angle = phase.sample_angle(xi);
            ASSERT_GE(angle, before) << phase.g() << ' ' << xi;
            ASSERT_LE(angle, kPi);
            before = angle;
            const double part = integrate(phase, angle, [](double) { return 1; });
            // The integral's own panels leave 1e-13.
            EXPECT_NEAR(part, xi, 2e-13) << phase.g() << ' ' << xi;
            EXPECT_NEAR(part, xi, 1e-3 * xi);
        }
        EXPECT_EQ(phase.sample_angle(0), 0);
        EXPECT_LT(kPi - phase.sample_angle(1), 1e-15);
        EXPECT_TRUE(std::isnan(phase.sample_angle(-1e-9)) && std::isnan(phase.sample_angle(kNan)));
    }
}

TEST(PhaseFunction, SweepIsFinitePositiveAndKeepsTheDensityOfItsSamples) {
    sweep([](SweepDraw& draw) -> std::string {
        const double g =
            draw.chance(0.5) ? draw.uniform(-1, 1) : draw.sign() * (1 - draw.decades(-15.9, 0));
        const double cosine = draw.between(-1, 1), angle = draw.angle();
        const double p = phase_hg(cosine, g), q = phase_hg_at_angle(angle, g);
        if (!(p > 0 && p < kInfinity)) return sweep_report("phase_hg", {cosine, g}, p);
        if (!(q > 0 && q < kInfinity)) return sweep_report("phase_hg_at_angle", {angle, g}, q);
        const double at_0 = phase_hg_at_angle(0, g), at_pi = phase_hg_at_angle(kPi, g);
        if (q > std::max(at_0, at_pi) * (1 + 1e-14) || q < std::min(at_0, at_pi) * (1 - 1e-14)) {
            return sweep_report("phase_hg_at_angle beyond its ends", {angle, g}, q);
        }
        // The closed distribution at the sampled angle gives back the part.
        const double xi = draw.between(0, 1), sampled = sample_hg(xi, g);
        if (!(sampled >= 0 && sampled <= kPi)) return sweep_report("sample_hg", {xi, g}, sampled);
        const double s = std::sin(sampled / 2), c = std::cos(sampled / 2);
        const double root = std::hypot((1 - g) * c, (1 + g) * s);
        // (1-g^2)/(2g) (1/(1-g) - 1/root), its difference written out.
        const double part = 2 * (1 + g) * s * s / (root * (root + (1 - g)));
        // An angle next to pi has a spacing of 4.4e-16.
        const double spacing = 2 * kPi * std::sin(sampled) * phase_hg_at_angle(sampled, g) * 1e-15;
        if (std::fabs(part - xi) > 2e-15 + spacing)
            return sweep_report("part of sample_hg", {xi, g}, part);
        if (!(phase_rayleigh(cosine) >= 3 / (16 * kPi))) {
            return sweep_report("phase_rayleigh", {cosine}, phase_rayleigh(cosine));
        }
        return "";
    });
}

TEST(PhaseFunction, TablesSweepWithoutNegativeValues) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            std::vector<double> angles, values;
            const std::size_t count = 2 + draw.bits() % 6;
            for (std::size_t i = 0; i < count; ++i) angles.push_back(draw.angle());
            std::sort(angles.begin(), angles.end());
            angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
            if (angles.size() < 2) return "";
            for (std::size_t i = 0; i < angles.size(); ++i) {
                values.push_back(draw.chance(0.2) ? 0 : draw.decades(-20, 20));
            }
            if (*std::max_element(values.begin(), values.end()) == 0) return "";
            const auto interpolation =
                draw.chance(0.5) ? PhaseInterpolation::linear : PhaseInterpolation::monotone;
            PhaseFunction phase;
            try {
                phase = PhaseFunction::tabulated({angles, values, interpolation});
            } catch (const Error& error) {
                // All light within an angle whose square underflows.
                return angles.size() < 9 &&
                               error.describe().find("integral is 0") != std::string::npos
                           ? ""
                           : error.describe();
            }
            const double angle = draw.angle(), xi = draw.between(0, 1);
            const double p = phase.at_angle(angle), sampled = phase.sample_angle(xi);
            if (!(p >= 0 && p < kInfinity)) return sweep_report("density", {angle}, p);
            if (!(sampled >= 0 && sampled <= kPi)) return sweep_report("quantile", {xi}, sampled);
            if (!(std::fabs(phase.mean_cosine()) <= 1 + 1e-12)) {
                return sweep_report("mean_cosine", {}, phase.mean_cosine());
            }
            return "";
        },
        kSweepInputs / 10);
}

TEST(PhaseFunction, RefusesWhatIsOutsideItsDomain) {
    for (const double g : {-1.0, 1.0, 1.5, kInfinity, kNan}) {
        EXPECT_TRUE(std::isnan(phase_hg(0.5, g)));
        EXPECT_TRUE(std::isnan(phase_hg_at_angle(0.5, g)));
        EXPECT_TRUE(std::isnan(sample_hg(0.5, g)));
        EXPECT_THROW(PhaseFunction::henyey_greenstein(g), Error);
    }
    for (const double cosine : {-1.01, 1.0001, kNan, kInfinity}) {
        EXPECT_TRUE(std::isnan(phase_hg(cosine, 0.5)));
        EXPECT_TRUE(std::isnan(phase_rayleigh(cosine)));
        for (const PhaseFunction& phase : examples()) {
            EXPECT_TRUE(std::isnan(phase.at_cosine(cosine)));
        }
    }
    for (const PhaseFunction& phase : examples()) {
        for (const double angle : {-1e-300, 3.1416, kNan}) {
            EXPECT_TRUE(std::isnan(phase.at_angle(angle)));
        }
        EXPECT_GE(phase.at_angle(double{3.14159274f}), 0);
        EXPECT_GE(phase.at_cosine(double{1.0000001f}), 0);
    }
}

TEST(PhaseTable, TakesOnlyWhatIsADensity) {
    const auto refused = [](std::vector<double> angles, std::vector<double> values,
                            const std::string& sentence) {
        try {
            const PhaseTable table(angles, values);
            ADD_FAILURE() << sentence;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::data);
            EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
        }
    };
    refused({0}, {1}, "two or more angles");
    refused({0, 1}, {1}, "two or more angles");
    refused({0, 1, 1}, {1, 1, 1}, "entry 2 is not above the one before it");
    refused({0, 2, 1}, {1, 1, 1}, "entry 2 is not above the one before it");
    refused({0, kNan}, {1, 1}, "entry 1 is not in [0, pi]");
    refused({-0.1, 1}, {1, 1}, "entry 0 is not in [0, pi]");
    refused({0, 3.2}, {1, 1}, "entry 1 is not in [0, pi]");
    refused({0, 1}, {1, -1e-300}, "entry 1 is not a finite number >= 0");
    refused({0, 1}, {kInfinity, 1}, "entry 0 is not a finite number >= 0");
    refused({0, 1}, {1, kNan}, "entry 1 is not a finite number >= 0");
    refused({0, 1}, {0, 0}, "all values of the phase table are 0");
}

TEST(PhaseTable, GoesThroughItsValuesWithoutOvershooting) {
    for (const auto each : {PhaseInterpolation::linear, PhaseInterpolation::monotone}) {
        const PhaseTable table = droplets(each);
        const double scale = table.density(0) / 900;
        EXPECT_LT(relative_error(table.density(0.7), 3 * scale), 1e-14);
        EXPECT_LT(relative_error(table.density(kPi), 1.1 * scale), 1e-14);
        for (double angle = 1.6; angle <= 2.4; angle += 0.01) {
            EXPECT_GE(table.density(angle), 0.2 * scale * (1 - 1e-14));
            EXPECT_LE(table.density(angle), 0.6 * scale * (1 + 1e-14));
        }
    }
    // Beyond its angles a table keeps its last values.
    const PhaseTable ends({1, 2}, {3, 5}, PhaseInterpolation::linear);
    EXPECT_EQ(ends.density(0.2), ends.density(1));
    EXPECT_EQ(ends.density(3), ends.density(2));
    EXPECT_LT(relative_error(ends.density(1.5) / ends.density(1), 4.0 / 3), 1e-15);
}

// Henyey-Greenstein read off at half degrees is Henyey-Greenstein, to the table's own
// interpolation.
TEST(PhaseTable, OfAKnownFunctionIsThatFunction) {
    std::vector<double> angles, values;
    for (int i = 0; i <= 360; ++i) {
        angles.push_back(kPi * i / 360);
        values.push_back(7 * phase_hg_at_angle(angles.back(), 0.7));
    }
    const PhaseTable table(angles, values);
    for (double angle = 0; angle < kPi; angle += 0.011) {
        EXPECT_LT(relative_error(table.density(angle), phase_hg_at_angle(angle, 0.7)), 2e-4);
    }
    EXPECT_NEAR(table.mean_cosine(), 0.7, 1e-4);
}

}  // namespace
}  // namespace airlight
