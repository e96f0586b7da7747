// SPDX-License-Identifier: Apache-2.0
// Fog with phase functions: small maps, every pixel against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <tuple>

#include "core/error.h"
#include "envmap/fog.h"
#include "envmap/phase_singularity.h"
#include "medium/phase_airlight.h"
#include "sh/phase_psf.h"
#include "tests/envmap/fog_reference.h"

namespace airlight {
namespace {

using test::brute_sum;
using test::row_integrals;

PhaseFunction hg(double g) {
    return PhaseFunction::henyey_greenstein(g);
}

PhaseFunction droplets() {
    return PhaseFunction::tabulated(
        {{0.0, 0.05, 0.2, 0.7, 1.6, 2.4, 2.9, kPi}, {90, 50, 20, 3, 0.2, 0.6, 0.35, 1.1}});
}

// Channels: noise; a sun of 1e5 in one pixel on faint noise; the same on a polar row.
Image test_map(int width, int height) {
    Image map(width, height, 3);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            map.at(y, x, 0) = uniform(random);
            for (int c = 1; c < 3; ++c) map.at(y, x, c) = 1e-3f * uniform(random);
        }
    }
    map.at(height / 3, width / 3, 1) = 1e5f;
    map.at(0, width / 2, 2) = 1e5f;
    return map;
}

FogOptions options_for(const PhaseFunction& phase, double thickness, double tolerance,
                       FogMethod method = FogMethod::automatic) {
    FogOptions options;
    options.phase = phase;
    options.optical_thickness = {thickness};
    options.tolerance = tolerance;
    options.method = method;
    return options;
}

// Largest relative error of scattered light over all pixels and channels.
double worst_error(const Image& map, const FogOptions& options) {
    const FogPlan plan = plan_fog(map.height, map.width, map.channels, options);
    const Image fog = scattered_light(map, plan);
    const double thickness = options.optical_thickness[0];
    double worst = 0;
    for (int row = 0; row < map.height; ++row) {
        const std::vector<double> taps =
            row_integrals([&](double gamma) { return psf(thickness, gamma, options.phase); },
                          map.height, map.width, row);
        for (int x = 0; x < map.width; ++x) {
            for (int c = 0; c < map.channels; ++c) {
                const double exact = brute_sum(map, taps, x, c);
                EXPECT_GE(fog.at(row, x, c), 0);
                worst = std::max(worst, std::fabs(fog.at(row, x, c) - exact) / exact);
            }
        }
    }
    return worst;
}

TEST(FogWithPhase, RingsAgreeWithBruteForceToTheirStatedError) {
    const Image map = test_map(24, 12);
    for (const auto& [phase, thickness] : {std::pair{PhaseFunction::rayleigh(), 0.05},
                                           {hg(0.5), 8.0},
                                           {hg(0.9), 1.0},
                                           {hg(0.99), 0.3},
                                           {hg(-0.4), 1.0}}) {
        EXPECT_LE(worst_error(map, options_for(phase, thickness, 1e-6, FogMethod::rings)), 1e-6)
            << phase.g() << ' ' << thickness;
    }
}

TEST(FogWithPhase, SplitAgreesWithRingsAtEveryPixel) {
    const Image map = test_map(254, 127);
    for (const auto& [phase, thickness, tolerance] :
         {std::tuple{PhaseFunction::rayleigh(), 1.0, 1e-4},
          {hg(0.5), 0.05, 1e-3},
          {hg(0.8), 1.0, 1e-3},
          {hg(0.8), 1.0, 1e-5},
          {hg(0.9), 10.0, 1e-2},
          {hg(-0.5), 3.0, 1e-3},
          {hg(0.3), 15.0, 1e-3}}) {
        const FogPlan exact =
            plan_fog(127, 254, 3, options_for(phase, thickness, 1e-6, FogMethod::rings));
        const FogPlan plan = plan_fog(127, 254, 3, options_for(phase, thickness, tolerance));
        ASSERT_EQ(plan.method, FogMethod::split) << phase.g() << ' ' << thickness;
        const Image truth = scattered_light(map, exact), image = scattered_light(map, plan);
        double worst = 0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            worst = std::max<double>(worst, std::fabs(image.pixels[i] / truth.pixels[i] - 1.0));
        }
        EXPECT_LE(worst, plan.estimated_error) << phase.g() << ' ' << thickness;
        EXPECT_LE(plan.estimated_error, tolerance);
    }
}

TEST(FogWithPhase, PeaksTooSharpForTheBandsAndTablesGoByRings) {
    EXPECT_EQ(plan_fog(64, 128, 3, options_for(hg(0.995), 1.0, 1e-3)).method, FogMethod::rings);
    EXPECT_EQ(plan_fog(64, 128, 3, options_for(droplets(), 1.0, 1e-3)).method, FogMethod::rings);
}

TEST(PhaseSingularity, OfAnIsotropicFunctionIsTheClosedForm) {
    const PhaseSingularity singular = *PhaseSingularity::of(hg(1e-17));
    for (double h = 0; h < singular.limit(); h += 0.37) {
        // Both series cancel like e^h.
        EXPECT_NEAR(singular.even(h), 0.25 * std::cos(h), 1e-15 * std::exp(h) + 1e-15) << h;
        EXPECT_NEAR(singular.odd(h), std::sin(h) / (2 * kPi), 1e-15 * std::exp(h) + 1e-15) << h;
    }
    EXPECT_FALSE(PhaseSingularity::of(PhaseFunction()).has_value());
}

// The scaled kernel tends to int p / gamma, and its next term is p(pi) T 2 ln(gamma).
TEST(PhaseSingularity, HoldsTheFirstTwoTermsOfThePeak) {
    for (const auto& phase : {PhaseFunction::rayleigh(), hg(0.7), hg(0.95), hg(-0.6)}) {
        const PhaseSingularity singular = *PhaseSingularity::of(phase);
        EXPECT_NEAR(psf_scaled(2.0, 1e-9, phase) * 1e-9 / singular.even(0), 1, 1e-6);
        EXPECT_NEAR(singular.odd(1e-6) / (2e-6 * phase.at_angle(kPi)), 1, 1e-10);
    }
}

TEST(FogWithPhase, ForwardScatteringShrinksTheGlow) {
    Image map(64, 32, 1);
    map.at(16, 32, 0) = 1e5f;
    float near = 0, far = 1e30f;
    for (const double g : {0.0, 0.4, 0.8}) {
        const FogOptions options = options_for(hg(g), 1.0, 1e-4);
        const Image fog = scattered_light(map, plan_fog(32, 64, 1, options));
        EXPECT_GT(fog.at(16, 32, 0), near) << g;
        EXPECT_LT(fog.at(16, 0, 0), far) << g;
        near = fog.at(16, 32, 0);
        far = fog.at(16, 0, 0);
    }
}

TEST(FogWithPhase, ConstantMapStaysConstantWithTheEnergyOfThePsf) {
    for (const auto& phase : {PhaseFunction::rayleigh(), hg(0.8), hg(-0.5), droplets()}) {
        for (const FogMethod method : {FogMethod::automatic, FogMethod::sh}) {
            Image map(64, 32, 1);
            std::fill(map.pixels.begin(), map.pixels.end(), 1.0f);
            const FogOptions options = options_for(phase, 0.7, 1e-3, method);
            const Image fog = scattered_light(map, plan_fog(32, 64, 1, options));
            const double energy = 0.7 * std::exp(-0.7) * psf_eigenvalues_scaled(0.7, phase, 1)[0];
            // The knots of the table leave 2e-6.
            for (const float value : fog.pixels) ASSERT_NEAR(value / energy, 1, 5e-6);
        }
    }
}

TEST(FogWithPhase, FactoredFormHasTheShapeOfThicknessOne) {
    const Image map = test_map(32, 16);
    FogOptions options = options_for(hg(0.6), 2.0, 1e-4);
    options.psf = PsfForm::factored;
    const Image factored = scattered_light(map, plan_fog(16, 32, 3, options));
    const Image one = scattered_light(map, plan_fog(16, 32, 3, options_for(hg(0.6), 1.0, 1e-4)));
    const double ratio = 2 * std::exp(-2.0) / std::exp(-1.0);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        ASSERT_NEAR(factored.pixels[i] / (ratio * one.pixels[i]), 1, 1e-6);
    }
}

TEST(FogWithPhase, WhatCannotMeetTheToleranceIsRefused) {
    EXPECT_THROW(plan_fog(16, 32, 3, options_for(hg(-0.9999), 1.0, 1e-3)), Error);
    EXPECT_GT(plan_fog(16, 32, 3, options_for(droplets(), 1.0, 1e-3)).estimated_error, 1e-6);
}

}  // namespace
}  // namespace airlight
