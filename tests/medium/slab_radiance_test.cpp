// SPDX-License-Identifier: Apache-2.0
#include "medium/slab_radiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/refraction.h"
#include "medium/slab.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

glm::dvec3 upward(SweepDraw& draw) {
    const double c = draw.unit(), phi = 2 * kPi * draw.unit(), s = std::sqrt((1 - c) * (1 + c));
    return {s * std::cos(phi), c, s * std::sin(phi)};
}

SlabMedium water() {
    SlabMedium medium;
    medium.scattering = 0.4;
    medium.absorption = 0.2;
    medium.ior_inside = 1.33;
    return medium;
}

// A segment of length 2 under the plane y = 0, seen at an angle.
SlabSegment slanted() {
    SlabSegment segment;
    segment.to_viewer = glm::normalize(glm::dvec3(0.6, 0.7, 0.1));
    segment.length = 2;
    return segment;
}

TEST(SlabRadiance, WithEqualIndicesIsTheBareIntegralTimesItsPrefactors) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            SlabMedium medium = water();
            medium.ior_outside = medium.ior_inside = 1.2;
            SlabSegment segment;
            segment.to_viewer = upward(draw);
            segment.length = draw.decades(-2, 2);
            const glm::dvec3 light = upward(draw) * draw.decades(-2, 2);
            const double l = glm::length(light), a = segment.to_viewer.y, b = light.y / l;
            const double g = glm::dot(light, segment.to_viewer) / l;
            const double near =
                medium.scattering * medium.phase * 3 * slab_near(0.6, segment.length, l, a, b, g);
            const double far =
                medium.scattering * medium.phase * 3 * slab_distant(0.6, segment.length, a, b);
            const double of_point = slab_radiance_of_point(medium, segment, light, 3);
            // g comes from a dot product: near the light 1 + g has its rounding.
            const double slack = 1e-12 + 1e-15 / (1 + g);
            if (!(relative_error(of_point, near) < slack)) {
                return sweep_report("point", {a, b, g, l}, of_point);
            }
            const double distant = slab_radiance(medium, segment, light / l, 3);
            if (!(relative_error(distant, far) < 1e-12))
                return sweep_report("far", {a, b}, distant);
            return {};
        },
        20000);
}

TEST(SlabRadiance, RefractedPathTendsToTheUnrefractedAsTheIndicesDo) {
    SlabMedium medium = water();
    const glm::dvec3 light(-0.5, 0.8, 0.3);
    medium.ior_inside = 1;
    const double limit = slab_radiance_of_point(medium, slanted(), light, 1);
    for (const double difference : {1e-3, 1e-6, 1e-9}) {
        medium.ior_inside = 1 + difference;
        const double bent = slab_radiance_of_point(medium, slanted(), light, 1);
        EXPECT_LT(relative_error(bent, limit), 10 * difference + 1e-9);
        EXPECT_NE(bent, limit);
    }
}

// Far away, a point light of intensity I is a distant one of irradiance I / l^2.
TEST(SlabRadiance, FarPointLightIsADistantOne) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(-0.5, 0.8, 0.3));
    const double distant = slab_radiance(water(), slanted(), direction, 1);
    for (const double l : {1e3, 1e5, 1e7}) {
        const double point = slab_radiance_of_point(water(), slanted(), direction * l, l * l);
        EXPECT_LT(relative_error(point, distant), 5 / l + 1e-8) << l;
    }
}

// The same by a plain sum over the ray, the entry point found by minimising the optical path
// (Fermat) instead of Snell's law, and the spreading by differencing neighbouring rays.
TEST(SlabRadiance, RefractedPathIsFermatsAndConservesTheFlux) {
    const SlabMedium medium = water();
    SlabSegment segment;
    segment.to_viewer = glm::dvec3(0, 1, 0);
    segment.length = 1.5;
    const glm::dvec3 light(0.7, 0.4, 0);
    const double n = medium.ior_inside, sigma_t = 0.6, height = light.y, foot = light.x;
    const auto lands = [&](double sine, double depth) {
        const double inside = sine / n;
        return height * sine / std::sqrt(1 - sine * sine) +
               depth * inside / std::sqrt(1 - inside * inside);
    };
    const int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double depth = (i + 0.5) * segment.length / steps;
        double lo = 0, hi = foot;
        for (int j = 0; j < 200; ++j) {
            const double a = lo + 0.382 * (hi - lo), b = lo + 0.618 * (hi - lo);
            const auto path = [&](double u) {
                return std::hypot(u, height) + n * std::hypot(foot - u, depth);
            };
            (path(a) < path(b) ? hi : lo) = path(a) < path(b) ? b : a;
        }
        const double u = 0.5 * (lo + hi), sine = u / std::hypot(u, height);
        const double k = std::hypot(foot - u, depth);
        const double c1 = height / std::hypot(u, height), c2 = depth / k;
        // Solid angle sin(t) dt dphi onto the ring r dr dphi at that depth.
        const double step = 1e-5;
        const double slope = (lands(sine + step, depth) - lands(sine - step, depth)) / (2 * step);
        const double per_area = sine / c1 / (foot * slope);
        const double transmittance = surface_crossing(c1, 1, n).transmittance;
        sum += transmittance * per_area / c2 * std::exp(-sigma_t * (depth + k));
    }
    sum *= segment.length / steps * medium.scattering * medium.phase *
           surface_crossing(1, 1, n).transmittance / (n * n);
    // Fermat's minimum is flat: 1e-8 of the offset, and midpoint's 1e-7.
    EXPECT_LT(relative_error(slab_radiance_of_point(medium, segment, light, 1), sum), 1e-6);
}

TEST(SlabRadiance, StraightPathIsTheRoughOne) {
    const double bent = slab_radiance_of_point(water(), slanted(), {-0.5, 0.8, 0.3}, 1);
    const double straight =
        slab_radiance_of_point(water(), slanted(), {-0.5, 0.8, 0.3}, 1, SlabLightPath::straight);
    EXPECT_GT(relative_error(straight, bent), 1e-3);
    EXPECT_LT(relative_error(straight, bent), 0.5);
}

TEST(SlabRadiance, IsFiniteLinearAndNotNegativeForAnyInput) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            SlabMedium medium;
            medium.scattering = draw.chance(0.1) ? 0 : draw.decades(-8, 6);
            medium.absorption = draw.chance(0.1) ? 0 : draw.decades(-8, 6);
            medium.ior_inside = draw.chance(0.2) ? 1 : draw.uniform(0.7, 2.5);
            SlabSegment segment;
            segment.to_viewer = upward(draw);
            segment.length = draw.chance(0.1) ? HUGE_VAL : draw.decades(-8, 8);
            glm::dvec3 direction = upward(draw);
            if (draw.chance(0.1)) direction = {1, 0, 0};
            const double l = draw.decades(-6, 6);
            const double far = slab_radiance(medium, segment, direction, 2);
            if (!(far >= 0 && far < HUGE_VAL)) return sweep_report("far", {direction.y}, far);
            if (far != 2 * slab_radiance(medium, segment, direction, 1)) {
                return sweep_report("far is not linear", {direction.y}, far);
            }
            const double near = slab_radiance_of_point(medium, segment, direction * l, 2);
            if (!(near >= 0 && near < HUGE_VAL)) {
                return sweep_report("near", {medium.ior_inside, l, segment.length, direction.y},
                                    near);
            }
            return {};
        },
        kSweepInputs / 100);
}

TEST(SlabRadiance, IsDarkBehindThePlaneAndRefusesWhatIsNoDirection) {
    SlabSegment segment = slanted();
    EXPECT_EQ(slab_radiance(water(), segment, {0, -1, 0}, 1), 0);
    EXPECT_EQ(slab_radiance_of_point(water(), segment, {0, -1, 0}, 1), 0);
    EXPECT_GT(slab_radiance(water(), segment, {0, 1, 0}, 1), 0);
    EXPECT_TRUE(std::isnan(slab_radiance(water(), segment, {0, 1.1, 0}, 1)));
    // A float's unit vector is one.
    EXPECT_GT(slab_radiance(water(), segment, {0, 1 + 1e-6, 0}, 1), 0);
    SlabMedium bad = water();
    bad.scattering = -1;
    EXPECT_TRUE(std::isnan(slab_radiance(bad, segment, {0, 1, 0}, 1)));
    segment.to_viewer = glm::dvec3(std::nan(""));
    EXPECT_TRUE(std::isnan(slab_radiance(water(), segment, {0, 1, 0}, 1)));
    segment.to_viewer = {0, -1, 0};
    EXPECT_EQ(slab_radiance(water(), segment, {0, 1, 0}, 1), 0);
    // A thinner medium inside: rays that graze from outside never come from it.
    SlabMedium bubble = water();
    bubble.ior_outside = 1.33;
    bubble.ior_inside = 1;
    segment.to_viewer = glm::normalize(glm::dvec3(1, 0.2, 0));
    EXPECT_EQ(slab_radiance(bubble, segment, {0, 1, 0}, 1), 0);
}

}  // namespace
}  // namespace airlight
