// SPDX-License-Identifier: Apache-2.0
#include "medium/shafts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "medium/airlight.h"
#include "medium/surface_radiance.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

const auto kAllLit = [](const glm::dvec3&) { return true; };

const ParticleIrradianceTable& table() {
    static const ParticleIrradianceTable kTable;
    return kTable;
}

ShaftMedium fog() {
    ShaftMedium medium;
    medium.scattering = 0.1;
    medium.absorption = 0.05;
    return medium;
}

ShaftLight lamp() {
    return {{1, 2, 6}, 5};
}

ShaftRay ray() {
    ShaftRay ray;
    ray.length = 12;
    return ray;
}

double closed_form(const ShaftMedium& medium, const ShaftLight& light, const ShaftRay& ray) {
    const glm::dvec3 to_light = light.position - ray.origin;
    const double distance = glm::length(to_light);
    const double sigma_t = medium.scattering + medium.absorption;
    const double gamma = std::acos(glm::dot(to_light, ray.direction) / distance);
    return medium.scattering * sigma_t * light.intensity *
           airlight(gamma, sigma_t * distance, sigma_t * ray.length);
}

TEST(Shafts, WithoutParticlesAndOccludersTendToTheAirlight) {
    const double expected = closed_form(fog(), lamp(), ray());
    for (const ShaftSteps spacing : {ShaftSteps::even, ShaftSteps::equiangular}) {
        ShaftOptions options;
        options.particles = false;
        options.least_transmittance = 0;
        options.spacing = spacing;
        double before = 0;
        for (const int steps : {32, 64, 128, 256}) {
            options.steps = steps;
            const double error =
                relative_error(shaft_radiance(fog(), lamp(), ray(), options, kAllLit), expected);
            if (before > 0) {
                // Second order.
                EXPECT_NEAR(before / error, 4, 0.5) << steps;
            }
            before = error;
        }
        EXPECT_LT(before, 1e-4);
        options.steps = 200000;
        EXPECT_LT(relative_error(shaft_radiance(fog(), lamp(), ray(), options, kAllLit), expected),
                  1e-9);
    }
}

TEST(Shafts, EquiangularStepsDoNotMissTheLight) {
    ShaftLight close = lamp();
    close.position = {0.01, 0, 6};
    ShaftOptions options;
    options.particles = false;
    options.least_transmittance = 0;
    const double expected = closed_form(fog(), close, ray());
    const double even = shaft_radiance(fog(), close, ray(), options, kAllLit);
    options.spacing = ShaftSteps::equiangular;
    const double angular = shaft_radiance(fog(), close, ray(), options, kAllLit);
    EXPECT_LT(relative_error(angular, expected), 0.01);
    EXPECT_GT(relative_error(even, expected), 0.5);
}

// Particles all alike, of weight w and at the ray itself, light it as if the irradiance at each
// point were w E(beta, d): a march without fog's own term in the limit of no extinction.
TEST(Shafts, EvenDensityAddsTheParticlesIrradiance) {
    ShaftOptions options;
    options.steps = 20000;
    options.least_transmittance = 0;
    options.particle.reach = 0;
    options.particle.distribution = {-50, 0.1};  // every x is far above: density 1
    const double with = shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table());
    const double beta = 1.05 * 0.03;
    double sum = 0;
    for (int i = 0; i < options.steps; ++i) {
        const double t = (i + 0.5) * 12 / options.steps;
        const double d = glm::length(glm::dvec3(0, 0, t) - lamp().position);
        sum += std::exp(-0.15 * t) * table()(beta, d);
    }
    sum *= 12.0 / options.steps * 0.1 / (4 * kPi) * 5;
    EXPECT_LT(relative_error(with, closed_form(fog(), lamp(), ray()) + sum), 1e-8);

    // An irradiance 1 / d^2 through fog makes it twice the airlight.
    const auto like_fog = [](double, double d) { return std::exp(-0.15 * d) / (d * d); };
    EXPECT_LT(relative_error(shaft_radiance(fog(), lamp(), ray(), options, kAllLit, like_fog),
                             2 * closed_form(fog(), lamp(), ray())),
              1e-8);
}

TEST(Shafts, FullOcclusionIsDarkAndHalfIsHalf) {
    const auto none = [](const glm::dvec3&) { return false; };
    const auto half = [](const glm::dvec3&) { return 0.5; };
    const ShaftOptions options;
    EXPECT_EQ(shaft_radiance(fog(), lamp(), ray(), options, none, table()), 0);
    const double all = shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table());
    EXPECT_GT(all, 0);
    EXPECT_LT(relative_error(2 * shaft_radiance(fog(), lamp(), ray(), options, half, table()), all),
              1e-14);
    // What is no visibility counts as its nearer end.
    const auto odd = [](const glm::dvec3& p) { return p.z > 3 ? std::nan("") : -1.0; };
    EXPECT_EQ(shaft_radiance(fog(), lamp(), ray(), options, odd, table()), 0);
    const auto over = [](const glm::dvec3&) { return 7.0; };
    EXPECT_EQ(shaft_radiance(fog(), lamp(), ray(), options, over, table()), all);
}

TEST(Shafts, OccluderAndItsComplementAddUp) {
    const ShaftOptions options;
    const auto lower = [](const glm::dvec3& p) { return p.z < 4; };
    const auto upper = [](const glm::dvec3& p) { return !(p.z < 4); };
    const double sum = shaft_radiance(fog(), lamp(), ray(), options, lower, table()) +
                       shaft_radiance(fog(), lamp(), ray(), options, upper, table());
    EXPECT_LT(relative_error(sum, shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table())),
              1e-14);
}

TEST(Shafts, AreLinearInTheIntensityAndTheSameEachTime) {
    ShaftOptions options;
    options.jitter = true;
    options.jitter_seed = 17;
    ShaftLight twice = lamp();
    twice.intensity *= 2;
    const double once = shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table());
    EXPECT_EQ(shaft_radiance(fog(), twice, ray(), options, kAllLit, table()), 2 * once);
    EXPECT_EQ(shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table()), once);
    options.jitter_seed = 18;
    EXPECT_NE(shaft_radiance(fog(), lamp(), ray(), options, kAllLit, table()), once);
}

TEST(Shafts, JitterIsUnbiased) {
    ShaftOptions options;
    options.jitter = true;
    options.particles = false;
    options.least_transmittance = 0;
    options.steps = 16;
    double sum = 0;
    const int rays = 4000;
    for (int i = 0; i < rays; ++i) {
        options.jitter_seed = static_cast<std::uint64_t>(i);
        sum += shaft_radiance(fog(), lamp(), ray(), options, kAllLit);
    }
    // The deviation of one ray is 2 %.
    EXPECT_LT(relative_error(sum / rays, closed_form(fog(), lamp(), ray())), 2e-3);
}

TEST(Shafts, EvaluateNothingWhereThereIsNothing) {
    int calls = 0;
    const auto count = [&calls](const glm::dvec3&) {
        ++calls;
        return true;
    };
    ShaftMedium clear = fog();
    clear.scattering = 0;
    ShaftLight dark = lamp();
    dark.intensity = 0;
    ShaftRay nothing = ray();
    nothing.length = 0;
    ShaftOptions options;
    EXPECT_EQ(shaft_radiance(clear, lamp(), ray(), options, count, table()), 0);
    EXPECT_EQ(shaft_radiance(fog(), dark, ray(), options, count, table()), 0);
    EXPECT_EQ(shaft_radiance(fog(), lamp(), nothing, options, count, table()), 0);
    EXPECT_EQ(calls, 0);
    // Density 0 everywhere: one look per step, at the ray, and no particle's light.
    options.particle.distribution = {700, 0.1};
    const auto never = [](double, double) -> double { throw std::logic_error("evaluated"); };
    EXPECT_GT(shaft_radiance(fog(), lamp(), ray(), options, count, never), 0);
    EXPECT_EQ(calls, options.steps);
    // Past a transmittance of 1e-4, at 61 m, the march is over.
    calls = 0;
    options.particles = false;
    ShaftRay far = ray();
    far.length = HUGE_VAL;
    options.longest = 6400;
    shaft_radiance(fog(), lamp(), far, options, count, table());
    EXPECT_LE(calls, 1);
}

TEST(Shafts, EarlyEndLeavesOutLittle) {
    ShaftOptions options;
    options.particles = false;
    options.steps = 4000;
    ShaftRay far = ray();
    far.length = 200;
    const double cut = shaft_radiance(fog(), lamp(), far, options, kAllLit);
    options.least_transmittance = 0;
    const double whole = shaft_radiance(fog(), lamp(), far, options, kAllLit);
    EXPECT_LE(cut, whole);
    EXPECT_LT(relative_error(cut, whole), 1e-4);
}

TEST(Shafts, IrradianceOfAParticleIsThePapersWithTheThicknessMended) {
    for (const double beta : {1e-6, 0.0315, 0.5, 3.0}) {
        for (const double d : {1e-3, 0.4, 2.0, 30.0}) {
            const double t = beta * d;
            const double paper = std::exp(-t) / (d * d) +
                                 beta * beta * surface_radiance(t, 0.0, 1.0) / (2 * kPi * t);
            EXPECT_LT(relative_error(particle_irradiance(beta, d), paper), 1e-13);
            // Linear interpolation on 512 points.
            EXPECT_LT(relative_error(table()(beta, d), particle_irradiance(beta, d)), 2e-5)
                << beta << ' ' << d;
        }
    }
    EXPECT_EQ(particle_irradiance(0, 2), 0.25);
    EXPECT_EQ(particle_irradiance(1, 0), HUGE_VAL);
    EXPECT_EQ(particle_irradiance(1, HUGE_VAL), 0);
    EXPECT_EQ(particle_irradiance(1, 1e6), 0);
    EXPECT_TRUE(std::isnan(particle_irradiance(-1, 1)));
    EXPECT_TRUE(std::isnan(particle_irradiance(1, std::nan(""))));
    // [Shafts] eq. 6, density over distance: thicker fog the nearer the light.
    const auto printed = [](double density, double d) { return density / d; };
    EXPECT_GT(printed(0.5, 1), printed(0.5, 10));
    EXPECT_THROW(ParticleIrradianceTable(1), Error);
}

TEST(Shafts, AreFiniteAndNotNegativeForAnyInput) {
    sweep([](SweepDraw& draw) -> std::string {
        ShaftMedium medium;
        medium.scattering = draw.chance(0.1) ? 0 : draw.decades(-12, 12);
        medium.absorption = draw.chance(0.3) ? 0 : draw.decades(-12, 12);
        ShaftLight light;
        light.intensity = draw.decades(-6, 6);
        light.position = {draw.uniform(-9, 9), draw.pick({0, 1e-300, 1, 1e9}), draw.uniform(-9, 9)};
        ShaftRay ray;
        ray.direction = particle_in_cell(static_cast<std::int64_t>(draw.bits()), 0, 0).direction;
        ray.length = draw.chance(0.2) ? HUGE_VAL : draw.decades(-6, 6);
        if (draw.chance(0.2)) ray.origin = light.position;
        ShaftOptions options;
        options.steps = 1 + static_cast<int>(draw.bits() % 8);
        options.spacing = draw.chance(0.5) ? ShaftSteps::even : ShaftSteps::equiangular;
        options.jitter = draw.chance(0.5);
        if (draw.chance(0.3)) options.particle.weight = ParticleWeight::printed;
        if (draw.chance(0.3)) options.particle.extinction = ParticleExtinction::printed;
        const double value = shaft_radiance(medium, light, ray, options, kAllLit, table());
        if (!(value >= 0 && value < HUGE_VAL)) {
            return sweep_report("shaft", {medium.scattering, ray.length}, value);
        }
        return {};
    });
}

TEST(Shafts, RefuseWhatIsOutsideTheirDomainWithNan) {
    const auto value = [](const ShaftMedium& medium, const ShaftLight& light, const ShaftRay& r,
                          const ShaftOptions& options) {
        return shaft_radiance(medium, light, r, options, kAllLit, table());
    };
    ShaftMedium medium = fog();
    medium.absorption = -1;
    EXPECT_TRUE(std::isnan(value(medium, lamp(), ray(), {})));
    ShaftLight light = lamp();
    light.position.x = std::nan("");
    EXPECT_TRUE(std::isnan(value(fog(), light, ray(), {})));
    ShaftRay bent = ray();
    bent.direction.z = 2;
    EXPECT_TRUE(std::isnan(value(fog(), lamp(), bent, {})));
    ShaftOptions options;
    options.steps = 0;
    EXPECT_TRUE(std::isnan(value(fog(), lamp(), ray(), options)));
    options = {};
    options.particle.distribution.sigma = 0;
    EXPECT_TRUE(std::isnan(value(fog(), lamp(), ray(), options)));
}

}  // namespace
}  // namespace airlight
