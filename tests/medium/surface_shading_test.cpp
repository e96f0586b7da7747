// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/surface_radiance.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SurfaceEvaluator exact(double exponent) {
    SurfaceOptions options;
    options.exponent = exponent;
    return SurfaceEvaluator(options);
}

bool nothing(const SurfaceRadiance& r) {
    return std::isnan(r.direct) && std::isnan(r.scattered) && std::isnan(r.total());
}

TEST(SurfaceShading, IsEquations17And18WhereScatteringIsExtinction) {
    for (const double beta : {0.01, 0.3, 2.0}) {
        for (const double distance : {0.5, 3.0, 10.0}) {
            for (const double theta : {0.0, 0.6, 1.5}) {
                for (const double n : {1.0, 10.0, 33.5}) {
                    const double t = beta * distance, k = 0.2, i0 = 7;
                    const SurfaceRadiance r =
                        surface_lobe(distance, theta, k, {beta, beta}, i0, exact(n));
                    EXPECT_LT(
                        relative_error(r.direct, i0 * k * std::exp(-t) / (distance * distance) *
                                                     std::pow(std::cos(theta), n)),
                        1e-13);
                    EXPECT_LT(relative_error(r.scattered, i0 * k * beta * beta *
                                                              surface_radiance(t, theta, n) /
                                                              (2 * kPi * t)),
                              1e-13);
                }
            }
        }
    }
}

// [Sun05] eq. 15 summed over directions, with the airlight of medium/airlight.h and coefficients
// kept apart: sigma_s sigma_t times airlight() is what a ray sees.
TEST(SurfaceShading, ScatteredLightIsTheIntegralOfTheAirlight) {
    const SurfaceFog fog = {0.7, 0.4};
    const double distance = 2.5, theta_s = 0.9, k = 0.25, i0 = 3;
    const int steps = 400;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * 0.5 * kPi / steps;
        for (int j = 0; j < steps; ++j) {
            const double phi = (j + 0.5) * kPi / steps;
            const double cosine = std::cos(theta) * std::cos(theta_s) +
                                  std::sin(theta) * std::sin(theta_s) * std::cos(phi);
            sum += airlight(std::acos(cosine), fog.extinction * distance, kInfinity) *
                   std::cos(theta) * std::sin(theta);
        }
    }
    sum *= 2 * (0.5 * kPi / steps) * (kPi / steps) * k * fog.scattering * fog.extinction * i0;
    const SurfaceRadiance r = surface_lobe(distance, theta_s, k, fog, i0, exact(1));
    // The midpoints' pole at the light.
    EXPECT_LT(relative_error(sum, r.scattered), 4e-3);
}

TEST(SurfaceShading, LambertMeasuresFromTheNormal) {
    const SurfaceFog fog = {0.2, 0.15};
    const SurfacePoint point = {{1, 2, 3}, {0, 0, 1}};
    for (const double theta : {0.0, 1e-9, 0.4, 1.57, 1.58, 2.9, kPi}) {
        const double phi = 0.8, d = 4;
        const SurfaceLight light = {
            point.position + d * glm::dvec3(std::sin(theta) * std::cos(phi),
                                            std::sin(theta) * std::sin(phi), std::cos(theta)),
            5};
        const SurfaceRadiance r = lambert_surface(point, light, fog, 0.1);
        const SurfaceRadiance e = surface_lobe(d, theta, 0.1, fog, 5, exact(1));
        EXPECT_LT(relative_error(r.scattered, e.scattered), 1e-13) << theta;
        EXPECT_NEAR(r.direct, e.direct, 1e-15) << theta;
        EXPECT_EQ(r.direct > 0, theta < 0.5 * kPi);
        EXPECT_GT(r.scattered, 0);
        EXPECT_EQ(r.total(), r.direct + r.scattered);
    }
}

TEST(SurfaceShading, PhongMeasuresFromTheMirroredDirectionOfView) {
    const SurfaceFog fog = {0.3, 0.3};
    const SurfacePoint point;  // at the origin, normal +Y
    const SurfaceEvaluator lobe = exact(12);
    // Seen from 40 degrees on the side of +X the lobe's axis points 40 degrees to the side of -X.
    const double a = 0.7;
    const glm::dvec3 view(std::sin(a), std::cos(a), 0);
    for (const double off : {-0.5, 0.0, 0.3, 0.8}) {
        const SurfaceLight light = {2.0 * glm::dvec3(-std::sin(a + off), std::cos(a + off), 0), 1};
        const SurfaceRadiance r = phong_surface(point, view, light, fog, 0.5, lobe);
        const SurfaceRadiance e = surface_lobe(2, std::abs(off), 0.5, fog, 1, lobe);
        EXPECT_LT(relative_error(r.scattered, e.scattered), 1e-12) << off;
        EXPECT_LT(relative_error(r.direct, e.direct), 1e-12) << off;
    }
    // Within the lobe but behind the plane: the fog alone lights it.
    const SurfaceLight behind = {{-1, -0.01, 0}, 1};
    const glm::dvec3 grazing(0.99, std::sqrt(1 - 0.99 * 0.99), 0);
    const SurfaceRadiance r = phong_surface(point, grazing, behind, fog, 0.5, lobe);
    EXPECT_EQ(r.direct, 0);
    EXPECT_GT(r.scattered, 0);
}

TEST(SurfaceShading, AbsorptionDimsAndOnlyScatteringLights) {
    const SurfaceEvaluator g = exact(1);
    const SurfaceRadiance clear = surface_lobe(2, 0.5, 1, {0, 0}, 1, g);
    EXPECT_EQ(clear.scattered, 0);
    EXPECT_LT(relative_error(clear.direct, std::cos(0.5) / 4), 1e-15);
    const SurfaceRadiance smoke = surface_lobe(2, 0.5, 1, {3, 0}, 1, g);
    EXPECT_EQ(smoke.scattered, 0);
    EXPECT_LT(relative_error(smoke.direct, clear.direct * std::exp(-6.0)), 1e-14);
    const SurfaceRadiance white = surface_lobe(2, 0.5, 1, {3, 3}, 1, g);
    const SurfaceRadiance grey = surface_lobe(2, 0.5, 1, {3, 1}, 1, g);
    EXPECT_LT(relative_error(white.scattered, 3 * grey.scattered), 1e-15);
    EXPECT_EQ(white.direct, grey.direct);
    // Thin fog adds in proportion to sigma_s.
    const SurfaceRadiance thin = surface_lobe(2, 0.5, 1, {1e-200, 1e-200}, 1, g);
    EXPECT_LT(relative_error(thin.scattered, 1e-200 * surface_radiance(0.0, 0.5, 1.0) / (4 * kPi)),
              1e-13);
}

TEST(SurfaceShading, HoldsAtEverySize) {
    const SurfaceEvaluator g = exact(1);
    const SurfacePoint point = {{0, 0, 0}, {0, 1, 0}};
    const double near = surface_radiance(0.0, 0.0, 1.0) / (2 * kPi);
    // Squares of these distances are out of range.
    const SurfaceRadiance tiny = lambert_surface(point, {{0, 1e-200, 0}, 1e-300}, {1, 1}, 1, g);
    EXPECT_LT(relative_error(tiny.direct, 1e100), 1e-13);
    EXPECT_LT(relative_error(tiny.scattered, 1e-100 * near), 1e-13);
    const SurfaceRadiance huge =
        lambert_surface(point, {{0, 1e200, 0}, 1e200}, {1e-250, 1e-250}, 1, g);
    EXPECT_LT(relative_error(huge.direct, 1e-200), 1e-13);
    EXPECT_LT(relative_error(huge.scattered, 1e-250 * near), 1e-13);
    const SurfaceRadiance beyond =
        lambert_surface({{0, -1.7e308, 0}, {0, 1, 0}}, {{0, 1.7e308, 0}, 1}, {1, 1}, 1, g);
    EXPECT_EQ(beyond.direct, 0);
    EXPECT_EQ(beyond.scattered, 0);
    const SurfaceRadiance thick = lambert_surface(point, {{0, 1e300, 0}, 1}, {1e300, 1e300}, 1, g);
    EXPECT_EQ(thick.total(), 0);
    EXPECT_EQ(surface_lobe(kInfinity, 1, 1, {1, 1}, 1, g).total(), 0);
    EXPECT_EQ(surface_lobe(1, 1, 0, {1, 1}, 1, g).total(), 0);
}

TEST(SurfaceShading, TakesUnitDirectionsOnly) {
    const SurfaceFog fog = {0.2, 0.2};
    const SurfaceLight light = {{1, 2, 0.5}, 1};
    const SurfaceEvaluator lobe = exact(5);
    const glm::dvec3 n(0, 1, 0), v(0.6, 0.8, 0);
    const SurfaceRadiance diffuse = lambert_surface({{}, n}, light, fog, 1);
    const SurfaceRadiance glossy = phong_surface({{}, n}, v, light, fog, 1, lobe);
    for (const double factor : {1 - 4.9e-6, 1 + 4.9e-6}) {
        const SurfaceRadiance d = lambert_surface({{}, factor * n}, light, fog, 1);
        const SurfaceRadiance g = phong_surface({{}, factor * n}, factor * v, light, fog, 1, lobe);
        EXPECT_LT(relative_error(d.direct, diffuse.direct), 1e-14);
        EXPECT_LT(relative_error(g.direct, glossy.direct), 1e-14);
        EXPECT_LT(relative_error(d.scattered, diffuse.scattered), 1e-13);
        EXPECT_LT(relative_error(g.scattered, glossy.scattered), 1e-13);
    }
    for (const double factor : {0.0, 1 - 6e-6, 1 + 6e-6, 2.0, kNan, kInfinity}) {
        EXPECT_TRUE(nothing(lambert_surface({{}, factor * n}, light, fog, 1))) << factor;
        EXPECT_TRUE(nothing(phong_surface({{}, factor * n}, v, light, fog, 1, lobe))) << factor;
        EXPECT_TRUE(nothing(phong_surface({{}, n}, factor * v, light, fog, 1, lobe))) << factor;
    }
}

TEST(SurfaceShading, RefusesWhatIsOutsideItsDomainWithNan) {
    const SurfaceEvaluator g = exact(1);
    EXPECT_TRUE(nothing(surface_lobe(0, 1, 1, {1, 1}, 1, g)));
    EXPECT_TRUE(nothing(surface_lobe(-1, 1, 1, {1, 1}, 1, g)));
    EXPECT_TRUE(nothing(surface_lobe(1, 3.15, 1, {1, 1}, 1, g)));
    EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {1, 1.01}, 1, g)));
    for (const double bad : {-1e-300, kNan}) {
        EXPECT_TRUE(nothing(surface_lobe(bad, 1, 1, {1, 1}, 1, g)));
        EXPECT_TRUE(nothing(surface_lobe(1, bad, 1, {1, 1}, 1, g)));
        EXPECT_TRUE(nothing(surface_lobe(1, 1, bad, {1, 1}, 1, g)));
        EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {bad, 1}, 1, g)));
        EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {1, bad}, 1, g)));
        EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {1, 1}, bad, g)));
    }
    EXPECT_TRUE(nothing(surface_lobe(1, 1, kInfinity, {1, 1}, 1, g)));
    EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {kInfinity, 1}, 1, g)));
    EXPECT_TRUE(nothing(surface_lobe(1, 1, 1, {1, 1}, kInfinity, g)));
    const SurfacePoint point = {{1, 2, 3}, {0, 1, 0}};
    EXPECT_TRUE(nothing(lambert_surface(point, {point.position, 1}, {1, 1}, 1)));
    EXPECT_TRUE(nothing(lambert_surface(point, {{kInfinity, 0, 0}, 1}, {1, 1}, 1)));
    EXPECT_TRUE(nothing(lambert_surface({{kNan, 0, 0}, {0, 1, 0}}, {{}, 1}, {1, 1}, 1)));
}

}  // namespace
}  // namespace airlight
