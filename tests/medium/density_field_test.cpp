// SPDX-License-Identifier: Apache-2.0
#include "medium/density_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/height_density.h"
#include "medium/quadrature.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Of everything, around the origin, on a planet of 10 km.
DensityField mixed() {
    return {{UniformDensity{0.01}, LinearHeightDensity{-0.02, 0.1},
             ExponentialHeightDensity{0.05, 3}, ExponentialHeightDensity{0.001, -20},
             SphericalExponentialDensity{{0, -10000, 0}, 10000, 0.03, 25},
             GaussianBlob{{1, 2, -3}, 0.4, 0.5}}};
}

// int_0^distance density ds on panels of 16 Gauss nodes.
double by_quadrature(const DensityField& field, const dvec3& origin, const dvec3& direction,
                     double distance) {
    const detail::QuadratureRule rule = detail::gauss_legendre(16);
    constexpr int kPanels = 400;
    const double half = 0.5 * distance / kPanels;
    double sum = 0;
    for (int panel = 0; panel < kPanels; ++panel) {
        for (int i = 0; i < rule.count; ++i) {
            for (const double side : {-1.0, 1.0}) {
                const double t = half * (2 * panel + 1 + side * rule.nodes[i].x);
                sum += rule.nodes[i].w * density_at(field, origin + t * direction);
            }
        }
    }
    return sum * half;
}

TEST(DensityField, DepthIsTheIntegralOfTheDensity) {
    const DensityField all = mixed();
    const dvec3 directions[] = {{0, 1, 0},
                                {1, 0, 0},
                                {0.6, -0.8, 0},
                                glm::normalize(dvec3(1, 2, -3)),
                                glm::normalize(dvec3(1, -0.01, 2))};
    for (const dvec3& direction : directions) {
        for (const double distance : {0.01, 1.0, 30.0}) {
            const dvec3 origin = {0.5, 1, -0.25};
            for (const Density& part : all.parts) {
                const double expected = by_quadrature({{part}}, origin, direction, distance);
                // The kink of the linear medium costs the quadrature its digits.
                const double tolerance =
                    std::holds_alternative<LinearHeightDensity>(part) ? 1e-5 : 1e-11;
                EXPECT_LT(
                    relative_error(optical_depth(part, origin, direction, distance), expected),
                    tolerance)
                    << part.index() << ' ' << distance;
            }
            double sum = 0;
            for (const Density& part : all.parts) {
                sum += optical_depth(part, origin, direction, distance);
            }
            EXPECT_LT(relative_error(optical_depth(all, origin, direction, distance), sum), 1e-15);
        }
    }
}

TEST(DensityField, PartsHaveTheDensitiesThatTheirNamesSay) {
    const dvec3 x = {3, 2, -1};
    EXPECT_EQ(density_at(UniformDensity{0.5}, x), 0.5);
    EXPECT_EQ(density_at(LinearHeightDensity{-0.25, 1}, x), 0.5);
    EXPECT_EQ(density_at(LinearHeightDensity{-0.25, 0.4}, x), 0);
    EXPECT_NEAR(density_at(ExponentialHeightDensity{0.5, 4}, x), 0.5 * std::exp(-0.5), 1e-16);
    EXPECT_NEAR(density_at(ExponentialHeightDensity{0.5, -4}, x), 0.5 * std::exp(0.5), 1e-15);
    EXPECT_EQ(density_at(ExponentialHeightDensity{0.5, kInfinity}, x), 0.5);
    const SphericalExponentialDensity ball = {{3, -2, -1}, 3, 0.5, 2};
    EXPECT_NEAR(density_at(ball, x), 0.5 * std::exp(-0.5), 1e-16);
    EXPECT_NEAR(density_at(GaussianBlob{{3, 1, -1}, 2, 0.5}, x), 0.5 * std::exp(-4.0), 1e-17);
    EXPECT_EQ(density_at(DensityField{}, x), 0);
    EXPECT_EQ(density_at(SphericalExponentialDensity{{0, 0, 0}, 3, 0.5, kInfinity}, x), 0.5);
    // An exponential out of range times a density that brings it back.
    EXPECT_LT(relative_error(density_at(ExponentialHeightDensity{1e-300, 1}, {0, -800, 0}),
                             1e-300 * std::exp(400.0) * std::exp(400.0)),
              1e-14);
    EXPECT_LT(relative_error(optical_depth(ExponentialHeightDensity{1e-300, 1}, {0, -800, 0},
                                           {0, 1, 0}, kInfinity),
                             1e-300 * std::exp(400.0) * std::exp(400.0)),
              1e-14);
    // 1.7 m above the Earth, whose center is 6371 km below.
    const SphericalExponentialDensity earth = {{0, -6371000, 0}, 6371000, 1, 0.5};
    EXPECT_LT(relative_error(density_at(earth, {0, 1.7, 0}), std::exp(-3.4)), 1e-14);
    EXPECT_LT(relative_error(optical_depth(earth, {0, 1.7, 0}, {0, 1, 0}, kInfinity),
                             0.5 * std::exp(-3.4)),
              1e-14);
}

TEST(DensityField, OpacityAndDensityAreParametersOfEachOther) {
    for (const double opacity_there : {0.0, 1e-300, 1e-18, 0.5, 0.999}) {
        const double density = density_of_opacity(opacity_there, 20.0);
        EXPECT_LT(relative_error(opacity_of_density(density, 20.0), opacity_there), 1e-14);
        EXPECT_LT(relative_error(
                      opacity(optical_depth(UniformDensity{density}, dvec3(0), {0, 0, 1}, 20.0)),
                      opacity_there),
                  1e-14);
    }
    EXPECT_EQ(density_of_opacity(1.0, 20.0), kInfinity);
    EXPECT_EQ(opacity_of_density(1.0, kInfinity), 1);
    EXPECT_EQ(opacity_of_density(0.0, kInfinity), 0);
    EXPECT_EQ(opacity(1e-300), 1e-300);
    EXPECT_EQ(opacity(kInfinity), 1);
    EXPECT_EQ(transmittance(0.0), 1);
    EXPECT_EQ(transmittance(kInfinity), 0);
    for (const double bad : {-1e-9, 1.1, kNan}) {
        EXPECT_TRUE(std::isnan(density_of_opacity(bad, 20.0)));
    }
    EXPECT_TRUE(std::isnan(density_of_opacity(0.5, 0.0)));
    EXPECT_TRUE(std::isnan(opacity(-1.0)));
    EXPECT_TRUE(std::isnan(transmittance(-1.0)));
}

TEST(DensityField, RefusesWhatIsOutsideItsDomainWithNan) {
    const dvec3 zero(0), up(0, 1, 0);
    const Density broken[] = {UniformDensity{-1},
                              UniformDensity{kInfinity},
                              LinearHeightDensity{kNan, 1},
                              ExponentialHeightDensity{1, 0},
                              ExponentialHeightDensity{-1, 1},
                              SphericalExponentialDensity{{0, 0, 0}, -1, 1, 1},
                              SphericalExponentialDensity{{0, kNan, 0}, 1, 1, 1},
                              SphericalExponentialDensity{{0, 0, 0}, 1, 1, -1},
                              GaussianBlob{{0, 0, 0}, -1, 1}};
    for (const Density& part : broken) {
        EXPECT_TRUE(std::isnan(density_at(part, zero))) << part.index();
        EXPECT_TRUE(std::isnan(optical_depth(part, zero, up, 1.0))) << part.index();
        EXPECT_TRUE(std::isnan(distance_at_depth(part, zero, up, 1.0, 0.5))) << part.index();
        DensityField field = mixed();
        field.parts.push_back(part);
        EXPECT_TRUE(std::isnan(optical_depth(field, zero, up, 1.0))) << part.index();
        EXPECT_TRUE(std::isnan(distance_at_depth(field, zero, up, 1.0, 0.5))) << part.index();
        EXPECT_EQ(sample_part(field, zero, 0.5), field.parts.size());
    }
    const DensityField field = mixed();
    for (const dvec3& bad : {dvec3(0), dvec3(0, 1.0001, 0), dvec3(kNan, 0, 0), dvec3(kInfinity)}) {
        EXPECT_TRUE(std::isnan(optical_depth(field, zero, bad, 1.0)));
        EXPECT_TRUE(std::isnan(distance_at_depth(field, zero, bad, 1.0, 0.1)));
        EXPECT_TRUE(std::isnan(free_path_pdf(field, zero, bad, 1.0)));
        EXPECT_TRUE(std::isnan(sample_free_path(field, zero, bad, 1.0, 0.5).distance));
    }
    EXPECT_TRUE(std::isnan(density_at(field, dvec3(kInfinity, 0, 0))));
    EXPECT_TRUE(std::isnan(optical_depth(field, dvec3(kNan), up, 1.0)));
    EXPECT_TRUE(std::isnan(optical_depth(field, zero, up, -1.0)));
    EXPECT_TRUE(std::isnan(distance_at_depth(field, zero, up, 1.0, -1.0)));
    EXPECT_TRUE(std::isnan(sample_free_path(field, zero, up, 1.0, 1.1).distance));
    EXPECT_TRUE(std::isnan(sample_collision({}, zero, up, 1.0, 0.5).distance));
    // A direction off by what float leaves.
    const double near = optical_depth(field, zero, {0, 1 + 4e-6, 0}, 1.0);
    EXPECT_EQ(near, optical_depth(field, zero, up, 1.0));
}

TEST(DensityField, VacuumLetsEverythingPass) {
    const DensityField vacuum;
    EXPECT_EQ(optical_depth(vacuum, dvec3(0), {0, 1, 0}, kInfinity), 0);
    EXPECT_EQ(distance_at_depth(vacuum, dvec3(0), {0, 1, 0}, kInfinity, 1.0), kInfinity);
    EXPECT_EQ(distance_at_depth(vacuum, dvec3(0), {0, 1, 0}, kInfinity, 0.0), 0);
    const FreePath path = sample_free_path(vacuum, dvec3(0), {0, 1, 0}, kInfinity, 0.5);
    EXPECT_EQ(path.distance, kInfinity);
    EXPECT_EQ(path.pdf, 1);
    EXPECT_EQ(sample_part(vacuum, dvec3(0), 0.5), 0u);
}

TEST(DensityField, DensitiesOfFreePathsIntegrateToTheOpacity) {
    const DensityField field = mixed();
    const dvec3 origin = {0.5, 1, -0.25}, direction = glm::normalize(dvec3(1, 0.5, -2));
    const double limit = 12;
    const detail::QuadratureRule rule = detail::gauss_legendre(16);
    double free_paths = 0, collisions = 0;
    constexpr int kPanels = 200;
    for (int panel = 0; panel < kPanels; ++panel) {
        for (int i = 0; i < rule.count; ++i) {
            for (const double side : {-1.0, 1.0}) {
                const double half = 0.5 * limit / kPanels;
                const double t = half * (2 * panel + 1 + side * rule.nodes[i].x);
                const double weight = rule.nodes[i].w * half;
                free_paths += weight * free_path_pdf(field, origin, direction, t);
                collisions += weight * collision_pdf(field, origin, direction, limit, t);
            }
        }
    }
    const double whole = opacity(optical_depth(field, origin, direction, limit));
    // The kink of the linear medium costs the quadrature its digits.
    EXPECT_NEAR(free_paths, whole, 1e-6);
    EXPECT_NEAR(collisions, 1, 1e-6);
    EXPECT_EQ(collision_pdf(field, origin, direction, limit, 12.5), 0);
}

TEST(DensityField, SamplesFollowTheirDistributions) {
    const DensityField field = mixed();
    const dvec3 origin = {0.5, 1, -0.25}, direction = glm::normalize(dvec3(1, 0.5, -2));
    const double limit = 12, whole = optical_depth(field, origin, direction, limit);
    for (int i = 0; i < 1000; ++i) {
        const double xi = (i + 0.5) / 1000;
        // [Golubev] eq. 24, mended: the distribution function at the sample is xi.
        const FreePath hit = sample_collision(field, origin, direction, limit, xi);
        const double passed = optical_depth(field, origin, direction, hit.distance);
        EXPECT_NEAR(opacity(passed) / opacity(whole), xi, 1e-14);
        EXPECT_LT(
            relative_error(hit.pdf, collision_pdf(field, origin, direction, limit, hit.distance)),
            1e-15);
        // As printed its middle is -ln O: another distance.
        EXPECT_GT(std::abs(-std::log(opacity(passed)) - passed), 1e-6 * passed);

        const FreePath path = sample_free_path(field, origin, direction, limit, xi);
        if (xi < opacity(whole)) {
            EXPECT_NEAR(opacity(optical_depth(field, origin, direction, path.distance)), xi, 1e-14);
        } else {
            EXPECT_EQ(path.distance, kInfinity);
            EXPECT_LT(relative_error(path.pdf, transmittance(whole)), 1e-15);
        }
    }
    EXPECT_LE(sample_collision(field, origin, direction, limit, 1.0).distance, limit);
    EXPECT_EQ(sample_collision(field, origin, direction, limit, 0.0).distance, 0);
}

TEST(DensityField, CollisionsBelongToPartsInProportionToTheirDensities) {
    const DensityField field = mixed();
    const dvec3 x = {0.5, 1, -0.25};
    std::vector<int> counts(field.parts.size() + 1);
    constexpr int kDraws = 100000;
    for (int i = 0; i < kDraws; ++i) ++counts[sample_part(field, x, (i + 0.5) / kDraws)];
    EXPECT_EQ(counts.back(), 0);
    const double whole = density_at(field, x);
    for (std::size_t i = 0; i < field.parts.size(); ++i) {
        EXPECT_NEAR(counts[i], kDraws * density_at(field.parts[i], x) / whole, 2) << i;
    }
    // Parts without density are never chosen, not even at the ends.
    const DensityField gaps = {{UniformDensity{0}, UniformDensity{1}, LinearHeightDensity{0, -1}}};
    EXPECT_EQ(sample_part(gaps, x, 0.0), 1u);
    EXPECT_EQ(sample_part(gaps, x, 1.0), 1u);
    EXPECT_EQ(sample_part({{UniformDensity{0}}}, x, 0.5), 1u);
}

Density random_part(SweepDraw& draw) {
    const auto coordinate = [&draw] { return draw.uniform(-10, 10); };
    const double density = draw.decades(-4, 0);
    switch (draw.bits() % 5) {
        case 0:
            return UniformDensity{density};
        case 1:
            return LinearHeightDensity{draw.sign() * density * 0.1, draw.sign() * density};
        case 2:
            return ExponentialHeightDensity{density, draw.sign() * draw.decades(0, 4)};
        case 3: {
            const double radius = draw.decades(0, 3), scale = draw.decades(0, 3);
            return SphericalExponentialDensity{
                {coordinate(), -radius + coordinate(), coordinate()}, radius, density, scale};
        }
        default:
            return GaussianBlob{
                {coordinate(), coordinate(), coordinate()}, draw.decades(-3, 0), density};
    }
}

struct FieldCase {
    DensityField field;
    dvec3 origin, direction;
    double distance;

    std::string report(const char* what, double expected, double value) const {
        return sweep_report(
            what,
            {double(field.parts.size()), double(field.parts[0].index()), origin.x, origin.y,
             origin.z, direction.x, direction.y, direction.z, distance, expected},
            value);
    }
};

FieldCase random_case(SweepDraw& draw) {
    FieldCase each;
    for (std::size_t i = 0, count = 1 + draw.bits() % 3; i < count; ++i) {
        each.field.parts.push_back(random_part(draw));
    }
    each.origin = {draw.uniform(-10, 10), draw.uniform(-10, 10), draw.uniform(-10, 10)};
    dvec3 direction = {draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    if (draw.chance(0.1)) direction.y = 0;
    if (draw.chance(0.1)) direction = {0, draw.sign(), 0};
    each.direction = glm::normalize(direction);
    each.distance = draw.decades(-4, 2);
    return each;
}

TEST(Sweep, FieldDepthIsReciprocalAdditiveAndGrows) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const FieldCase each = random_case(draw);
            const auto depth = [&](double from, double length, double way) {
                return optical_depth(each.field, each.origin + from * each.direction,
                                     way * each.direction, length);
            };
            const double value = depth(0, each.distance, 1);
            if (!(value >= 0) || std::signbit(value)) return each.report("depth", 0, value);
            // Points on the ray are rounded, and small densities lie steeply beside large ones.
            const double most =
                std::max({density_at(each.field, each.origin),
                          density_at(each.field, each.origin + each.distance * each.direction),
                          value / each.distance});
            const double tolerance = 1e-12 * value + 1e-13 * most;
            const double back = depth(each.distance, each.distance, -1);
            if (!(std::abs(back - value) <= tolerance))
                return each.report("backwards", value, back);
            const double part = each.distance * draw.unit();
            const double first = depth(0, part, 1);
            const double sum = first + depth(part, each.distance - part, 1);
            if (!(std::abs(sum - value) <= tolerance)) return each.report("in parts", value, sum);
            if (!(first <= value * (1 + 1e-14))) return each.report("grows", value, first);
            return {};
        },
        kSweepInputs);
}

TEST(Sweep, FieldDistanceInvertsTheDepth) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const FieldCase each = random_case(draw);
            const bool infinite = draw.chance(0.3);
            const double limit = infinite ? kInfinity : each.distance;
            const double whole = optical_depth(each.field, each.origin, each.direction, limit);
            if (!(whole > 0)) return {};
            const double depth = std::isinf(whole)  ? draw.decades(-6, 2)
                                 : draw.chance(0.2) ? whole * draw.decades(-15, 0)
                                                    : whole * draw.unit();
            const double distance =
                distance_at_depth(each.field, each.origin, each.direction, limit, depth);
            if (!(distance >= 0 && distance <= limit && distance < kInfinity)) {
                return each.report("distance_at_depth", depth, distance);
            }
            const auto at = [&](double t) {
                return optical_depth(each.field, each.origin, each.direction, t);
            };
            const double again = at(distance);
            const double spacing = std::max(at(std::nextafter(distance, kInfinity)) - again,
                                            again - at(std::nextafter(distance, 0)));
            if (!(std::abs(again - depth) <= 1e-12 * depth + 2 * spacing)) {
                return each.report("depth of distance_at_depth", depth, again);
            }
            return {};
        },
        kSweepInputs);
}

TEST(Sweep, FieldsTakeEverySizeWithoutNanOrNegatives) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            FieldCase each = random_case(draw);
            const auto any = [&draw] { return draw.sign() * draw.not_negative(false); };
            each.field.parts = {UniformDensity{draw.not_negative(false)}};
            switch (draw.bits() % 4) {
                case 0:
                    each.field.parts.push_back(LinearHeightDensity{any(), any()});
                    break;
                case 1:
                    each.field.parts.push_back(ExponentialHeightDensity{
                        draw.not_negative(false), draw.sign() * draw.decades(-300, 300)});
                    break;
                case 2:
                    each.field.parts.push_back(
                        SphericalExponentialDensity{{0, draw.uniform(-10, 10), 0},
                                                    draw.not_negative(false),
                                                    draw.not_negative(false),
                                                    draw.decades(-290, 300)});
                    break;
                default:
                    each.field.parts.push_back(GaussianBlob{{draw.uniform(-10, 10), 0, 0},
                                                            draw.not_negative(false),
                                                            draw.not_negative(false)});
            }
            const double distance = draw.not_negative();
            const double value = optical_depth(each.field, each.origin, each.direction, distance);
            const double density = density_at(each.field, each.origin);
            if (!(value >= 0 && density >= 0)) return each.report("optical_depth", density, value);
            const double back = distance_at_depth(each.field, each.origin, each.direction, distance,
                                                  draw.not_negative());
            if (!(back >= 0)) return each.report("distance_at_depth", value, back);
            return {};
        },
        kSweepInputs);
}

TEST(DensityField, FarPointsAreOrdinary) {
    const glm::dvec3 right(1, 0, 0);
    for (const double far : {1e154, 1e155, 1e300}) {
        const glm::dvec3 there(0, far, 0);
        const double infinity = std::numeric_limits<double>::infinity();
        const Density uniform = SphericalExponentialDensity{glm::dvec3(0), 1, 1, infinity};
        EXPECT_EQ(optical_depth(uniform, there, right, 1), 1) << far;
        const Density blob = GaussianBlob{glm::dvec3(0), 1, 1};
        EXPECT_EQ(optical_depth(blob, there, right, 1), 0) << far;
    }
    // r / H = 1: e^{-1} of the density at the center.
    const Density wide = SphericalExponentialDensity{glm::dvec3(0), 0, 1, 1e300};
    EXPECT_NEAR(density_at(wide, glm::dvec3(0, 1e300, 0)), std::exp(-1.0), 1e-15);
    EXPECT_NEAR(optical_depth(wide, glm::dvec3(0, 1e300, 0), right, 1), std::exp(-1.0), 1e-15);
}

TEST(DensityField, HugeDepthsAreReachedWhereTheyAre) {
    const DensityField planet{
        {SphericalExponentialDensity{glm::dvec3(0, -6371000, 0), 6371000, 0.00718, 16.658}}};
    const glm::dvec3 origin(0, 60, 0), down(0, -1, 0);
    for (const double depth : {1e303, 5e304, 1e305}) {
        const double distance = distance_at_depth(planet, origin, down, 11812, depth);
        EXPECT_LT(distance, 11812) << depth;
        EXPECT_NEAR(optical_depth(planet, origin, down, distance) / depth, 1, 1e-12) << depth;
    }
}

TEST(DensityField, ACollisionLiesWithinItsSegment) {
    DensityField field{{ExponentialHeightDensity{1, 1}}};
    const glm::dvec3 origin(0), down(0, -1, 0);
    EXPECT_LE(sample_collision(field, origin, down, 2000, 1).distance, 2000);
    field.parts.push_back(UniformDensity{1});
    EXPECT_LE(sample_collision(field, origin, down, 2000, 1).distance, 2000);
    EXPECT_LE(sample_free_path(field, origin, down, 2000, 1).distance, 2000);
}

}  // namespace
}  // namespace airlight
