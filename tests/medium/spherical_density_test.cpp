// SPDX-License-Identifier: Apache-2.0
#include "medium/spherical_density.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "medium/spherical_rungs.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Measured: 9e-16.
constexpr double kDoubleTolerance = 2e-15;
// Measured: 1.1e-6.
constexpr double kFloatTolerance = 2e-6;

double depth_of(const std::vector<double>& row) {
    return spherical_depth(SphericalProfile{row[0], row[1]}, SphericalRay{row[2], row[3]}, row[4]);
}

std::vector<std::vector<double>> all_rows() {
    auto rows = reference_rows("optdepth_sphere.csv", 6, 860);
    const auto corners = reference_rows("optdepth_sphere_corners.csv", 6, 300);
    rows.insert(rows.end(), corners.begin(), corners.end());
    return rows;
}

TEST(SphericalDensity, MatchesEveryReferenceRow) {
    for (const auto& row : all_rows()) {
        EXPECT_LT(relative_error(depth_of(row), row[5]), kDoubleTolerance)
            << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3] << ' ' << row[4];
    }
}

TEST(SphericalDensity, FloatKeepsItsDigitsOnEveryReferenceRow) {
    for (const auto& row : all_rows()) {
        float a[5];
        for (int i = 0; i < 5; ++i) a[i] = rounded(row[i]);
        const double exact =
            spherical_depth(SphericalProfile{a[0], a[1]}, SphericalRay{a[2], a[3]}, double{a[4]});
        if (!(exact > 1e-37 && exact < 3e38)) continue;
        EXPECT_LT(relative_error(spherical_depth(a[0], a[1], a[2], a[3], a[4]), exact),
                  kFloatTolerance)
            << row[2] << ' ' << row[3] << ' ' << row[4];
        const float altitude = a[2] - a[0];
        if (double{a[0]} + double{altitude} != double{a[2]}) continue;
        EXPECT_LT(
            relative_error(spherical_depth_at_altitude(a[0], a[1], altitude, a[3], a[4]), exact),
            kFloatTolerance);
    }
}

TEST(SphericalDensity, AltitudesKeepTheDigitsThatTheDistanceFromTheCenterHasNot) {
    // 8e-10 m above the surface: r = R + that is R in double.
    const SphericalProfile profile = {6371000, 1e-9};
    const double from_altitude = spherical_depth_at_altitude(profile, 8e-10, 1.0, kInfinity);
    EXPECT_LT(relative_error(from_altitude, 1e-9 * std::exp(-0.8)), 1e-15);
    // A few millimetres in float, where r has a spacing of half a metre.
    for (const float altitude : {0.001f, 0.003f, 2.0f}) {
        const float value = spherical_depth_at_altitude(6371000.0f, 0.01f, altitude, 1.0f, 0.01f);
        const double exact = 0.01 * std::exp(-double{altitude} / double{0.01f}) *
                             -std::expm1(-double{0.01f} / double{0.01f});
        if (exact > 1e-37) {
            EXPECT_LT(relative_error(value, exact), 1e-5) << altitude;
        }
    }
}

TEST(SphericalDensity, HasItsLimits) {
    const SphericalProfile earth = {6371000, 8000};
    EXPECT_EQ(spherical_depth(earth, {6371000, 0.3}, 0.0), 0);
    EXPECT_NEAR(spherical_depth(earth, {6371000, 1}, kInfinity), 8000, 1e-11);
    // From the center outwards, whatever the direction is called: H e^{R / H} would overflow.
    for (const double c : {-1.0, 0.0, 1.0}) {
        EXPECT_EQ(spherical_depth(earth, {0, c}, kInfinity), kInfinity);
        EXPECT_LT(relative_error(spherical_depth({10, 2}, {0, c}, 1e9), 2 * std::exp(5.0)), 1e-15);
    }
    // Straight through the center.
    EXPECT_LT(relative_error(spherical_depth({10, 2}, {10, -1}, kInfinity), 4 * std::exp(5.0) - 2),
              1e-15);
    EXPECT_LT(relative_error(spherical_depth({10, 2}, {10, -1}, 10.0), 2 * std::expm1(5.0)), 1e-15);
    // Tangents underground: a representable value whose exponential alone is not, and one beyond.
    EXPECT_LT(relative_error(spherical_depth({720, 1}, {0, 1}, 1e-10),
                             1e-10 * std::exp(700.0) * std::exp(20.0)),
              2e-10);
    EXPECT_EQ(spherical_depth({6371, 1.2}, {6371, -1}, kInfinity), kInfinity);
    // An infinite scale height is uniform.
    EXPECT_EQ(spherical_depth({10, kInfinity}, {12, -0.3}, 7.5), 7.5);
    EXPECT_EQ(spherical_depth({10, kInfinity}, {12, -0.3}, kInfinity), kInfinity);
    EXPECT_EQ(spherical_distance({10, kInfinity}, {12, -0.3}, 100.0, 7.5), 7.5);
    // Segments of no extent in scale heights.
    EXPECT_EQ(spherical_depth({1, 1e200}, {1, 0.5}, 1e-200), 1e-200);
}

TEST(SphericalDensity, RefusesWhatIsOutsideItsDomainWithNan) {
    const auto depth = [](double radius, double scale, double r, double c, double distance) {
        return spherical_depth(SphericalProfile{radius, scale}, SphericalRay{r, c}, distance);
    };
    for (const double bad : {kNan, -1.0, -kInfinity}) {
        EXPECT_TRUE(std::isnan(depth(bad, 1, 1, 0.5, 1)));
        EXPECT_TRUE(std::isnan(depth(1, bad, 1, 0.5, 1)));
        EXPECT_TRUE(std::isnan(depth(1, 1, bad, 0.5, 1)));
        EXPECT_TRUE(std::isnan(depth(1, 1, 1, 0.5, bad)));
        EXPECT_TRUE(std::isnan(spherical_distance({1, 1}, {1, 0.5}, bad, 0.5)));
        EXPECT_TRUE(std::isnan(spherical_distance({1, 1}, {1, 0.5}, 1, bad)));
        const SphericalComponent component = {bad, 1};
        EXPECT_TRUE(std::isnan(spherical_depth(&component, 1, 1.0, {1, 0.5}, 1.0)));
        const float f = rounded(bad);
        EXPECT_TRUE(std::isnan(spherical_depth(f, 1.0f, 1.0f, 0.5f, 1.0f)));
        EXPECT_TRUE(std::isnan(spherical_depth(1.0f, f, 1.0f, 0.5f, 1.0f)));
        EXPECT_TRUE(std::isnan(spherical_depth(1.0f, 1.0f, 1.0f, 0.5f, f)));
    }
    EXPECT_TRUE(std::isnan(depth(1, 0, 1, 0.5, 1)));
    EXPECT_TRUE(std::isnan(depth(kInfinity, 1, 1, 0.5, 1)));
    EXPECT_TRUE(std::isnan(depth(1, 1, kInfinity, 0.5, 1)));
    EXPECT_TRUE(std::isnan(depth(1, 1, 1, 1.0000001, 1)));
    EXPECT_TRUE(std::isnan(spherical_depth_at_altitude({1, 1}, -1.5, 0.5, 1.0)));
}

TEST(SphericalDensity, DistancesMatchEveryReferenceRow) {
    for (const auto& row : reference_rows("sample_sphere.csv", 7, 60)) {
        const SphericalProfile profile = {row[0], row[1]};
        const SphericalRay ray = {row[2], row[3]};
        const double distance = spherical_distance(profile, ray, row[4], row[5]);
        EXPECT_LT(relative_error(spherical_depth(profile, ray, distance), row[5]), 1e-14);
        EXPECT_LE(distance, row[4]);
    }
}

TEST(SphericalDensity, DistancesHaveTheirLimits) {
    const SphericalProfile earth = {6371000, 8000};
    const SphericalRay up = {6371000, 1}, down = {6471000, -1};
    EXPECT_EQ(spherical_distance(earth, up, 1e5, 0.0), 0);
    EXPECT_EQ(spherical_distance(earth, up, 1e5, 1e9), kInfinity);
    EXPECT_EQ(spherical_distance(earth, up, kInfinity, 8001.0), kInfinity);
    EXPECT_EQ(spherical_distance(earth, up, kInfinity, kInfinity), kInfinity);
    const double whole = spherical_depth(earth, down, 1e5);
    EXPECT_EQ(spherical_distance(earth, down, 1e5, whole), 1e5);
    EXPECT_EQ(spherical_distance(earth, down, 1e5, whole * (1 + 1e-15)), 1e5);
    EXPECT_EQ(spherical_distance(earth, down, 1e5, whole * (1 + 1e-12)), kInfinity);
    EXPECT_EQ(spherical_distance(6371.0f, 8.0f, 6371.0f, 1.0f, 100.0f, 0.0f), 0.0f);
}

TEST(SphericalDensity, ConstituentsAddUpAndAreInvertedTogether) {
    const SphericalComponent air[] = {{1.2e-5, 8000}, {2e-5, 1200}, {0, 100}};
    const SphericalRay ray = {6373000, -0.02};
    const double sum = 1.2e-5 * spherical_depth({6371000, 8000}, ray, 4e5) +
                       2e-5 * spherical_depth({6371000, 1200}, ray, 4e5);
    EXPECT_LT(relative_error(spherical_depth(air, 3, 6371000, ray, 4e5), sum), 1e-15);
    for (const double part : {1e-12, 1e-6, 0.01, 0.5, 0.999999}) {
        const double distance = spherical_distance(air, 3, 6371000, ray, 4e5, sum * part);
        EXPECT_LT(relative_error(spherical_depth(air, 3, 6371000, ray, distance), sum * part),
                  1e-13)
            << part;
    }
    EXPECT_EQ(spherical_depth(air, 0, 6371000, ray, 4e5), 0);
    EXPECT_EQ(spherical_distance(air, 0, 6371000, ray, 4e5, 1.0), kInfinity);
}

// Segments up to a metre, 10 cm above sea level to 100 km up, in kilometres.
TEST(SphericalDensity, TheArticlesCodeIsNoiseOnMetresWhereOursKeepsItsDigits) {
    std::vector<double> article;
    double ours = 0;
    for (int i = 0; i < 20000; ++i) {
        SweepDraw draw(i);
        const auto r = rounded(6371 + draw.decades(-4, 2));
        const auto c = rounded(draw.uniform(-1, 1));
        const auto distance = rounded(draw.decades(-5, -3));
        const float scale = draw.chance(0.5) ? 8.0f : 1.2f;
        const double exact =
            spherical_depth(SphericalProfile{6371, scale}, SphericalRay{r, c}, double{distance});
        if (exact < 1e-30) continue;
        article.push_back(
            relative_error(spherical_depth_article(6371, scale, r, c, distance), exact));
        ours = std::max(ours, relative_error(spherical_depth(6371, scale, r, c, distance), exact));
    }
    std::sort(article.begin(), article.end());
    EXPECT_GT(article[article.size() / 2], 0.7);
    EXPECT_GT(article.back(), 4);
    EXPECT_LT(ours, kFloatTolerance);
}

TEST(SphericalDensity, TheArticlesCodeOverflowsAboveTangentsFarUnderground) {
    // 100 scale heights below ground, and straight down.
    const float c = -0.2f;
    EXPECT_FALSE(std::isfinite(spherical_depth_article(6371, 1.2f, 6371, c, kInfinity)));
    EXPECT_FALSE(std::isfinite(spherical_depth_article(6371, 1.2f, 6371, -1, kInfinity)));
    const double exact = spherical_depth({6371, double{1.2f}}, {6371, double{c}}, kInfinity);
    EXPECT_GT(exact, 1e40);
    EXPECT_TRUE(std::isfinite(exact));
}

TEST(SphericalDensity, TheArticlesInverseReturnsItsFirstGuessForSmallDepths) {
    double article = 0, ours = 0;
    for (const auto& row : reference_rows("sample_sphere.csv", 7, 60)) {
        if (row[5] > 1e-5) continue;
        float a[6];
        for (int i = 0; i < 6; ++i) a[i] = rounded(row[i]);
        const SphericalProfile profile = {a[0], a[1]};
        const SphericalRay ray = {a[2], a[3]};
        if (!(spherical_depth(profile, ray, double{a[4]}) > double{a[5]})) continue;
        const float theirs = spherical_distance_article(a[0], a[1], a[2], a[3], a[4], a[5]);
        const float mine = spherical_distance(a[0], a[1], a[2], a[3], a[4], a[5]);
        article =
            std::max(article, relative_error(spherical_depth(profile, ray, double{theirs}), a[5]));
        ours = std::max(ours, relative_error(spherical_depth(profile, ray, double{mine}), a[5]));
    }
    EXPECT_GT(article, 1);
    // A rounding of the distance, 6e-8, times the number of scale heights that it falls through.
    EXPECT_LT(ours, 1e-5);
}

struct Case {
    SphericalProfile profile;
    SphericalRay ray;
    double distance;

    std::string report(const char* what, double value) const {
        return sweep_report(
            what,
            {profile.radius, profile.scale_height, ray.center_distance, ray.cos_zenith, distance},
            value);
    }
};

Case ordinary(SweepDraw& draw) {
    const double scale = draw.decades(-2, 2);
    const double radius = scale * draw.decades(-2, 5);
    const double r =
        draw.chance(0.5) ? radius + scale * draw.uniform(-5, 20) : radius * draw.uniform(0, 2);
    Case c = {{radius, scale}, {std::abs(r), draw.between(-1, 1)}, scale * draw.decades(-6, 2)};
    if (draw.chance(0.3)) c.ray.cos_zenith = draw.sign() * draw.decades(-16, 0);
    if (draw.chance(0.3)) c.distance = c.ray.center_distance * draw.uniform(0, 3);
    return c;
}

TEST(Sweep, SphericalDepthIsADepthAndGrowsWithTheDistance) {
    sweep([](SweepDraw& draw) -> std::string {
        Case each = ordinary(draw);
        if (draw.chance(0.5)) {
            each = {{draw.not_negative(false), draw.not_negative()},
                    {draw.not_negative(false), draw.between(-1, 1)},
                    draw.not_negative()};
            if (!(each.profile.scale_height > 0) ||
                each.ray.center_distance / each.profile.scale_height > 1e300)
                return {};
        }
        const double value = spherical_depth(each.profile, each.ray, each.distance);
        if (!(value >= 0) || std::signbit(value)) return each.report("spherical_depth", value);
        Case longer = each;
        longer.distance += draw.not_negative();
        const double there = spherical_depth(longer.profile, longer.ray, longer.distance);
        if (!(there >= value * (1 - 4 * kDoubleTolerance))) {
            return longer.report("spherical_depth of a longer ray", there);
        }
        const float single =
            spherical_depth(rounded(each.profile.radius), rounded(each.profile.scale_height),
                            rounded(each.ray.center_distance), rounded(each.ray.cos_zenith),
                            rounded(each.distance));
        const bool fits = each.profile.radius < 1e38 && each.ray.center_distance < 1e38 &&
                          each.profile.scale_height > 1e-45;
        if (fits && !(single >= 0)) return each.report("spherical_depth in float", single);
        return {};
    });
}

TEST(Sweep, SphericalDepthInFloatIsThatInDouble) {
    sweep([](SweepDraw& draw) -> std::string {
        const Case each = ordinary(draw);
        const auto radius = rounded(each.profile.radius);
        const auto scale = rounded(each.profile.scale_height);
        const auto r = rounded(each.ray.center_distance);
        const auto cosine = rounded(each.ray.cos_zenith);
        const auto distance = rounded(each.distance);
        const double exact = spherical_depth(SphericalProfile{radius, scale},
                                             SphericalRay{r, cosine}, double{distance});
        const float value = spherical_depth(radius, scale, r, cosine, distance);
        if (exact > 1e-37 && exact < 3e38 && !(relative_error(value, exact) < kFloatTolerance)) {
            return each.report("spherical_depth in float", value);
        }
        return {};
    });
}

TEST(Sweep, SphericalDepthIsReciprocalAndAdditive) {
    sweep([](SweepDraw& draw) -> std::string {
        const Case each = ordinary(draw);
        const double r = each.ray.center_distance, c = each.ray.cos_zenith;
        const double periapsis = r * std::sqrt((1 - c) * (1 + c));
        const auto ray_at = [&](double t, double direction) {
            const double along = r * c + t, there = std::hypot(along, periapsis);
            const double cosine = there > 0 ? along / there : 1;
            return SphericalRay{there, direction * std::min(1.0, std::max(-1.0, cosine))};
        };
        const double value = spherical_depth(each.profile, each.ray, each.distance);
        if (!(value > 1e-280 && value < 1e280)) return {};
        // Where a part begins its cosine is rounded, which turns the ray and moves its lowest
        // point.
        const double lengths = r + each.distance;
        const double first = r * c, last = r * c + each.distance;
        const double lowest =
            first < 0 && last > 0
                ? periapsis
                : std::hypot(periapsis, std::min(std::abs(first), std::abs(last)));
        const double tolerance =
            1e-13 + 4 * kEpsilon * lengths * (lengths / lowest) / each.profile.scale_height;
        const double back = spherical_depth(each.profile, ray_at(each.distance, -1), each.distance);
        if (!(relative_error(back, value) < tolerance)) return each.report("backwards", back);
        const double part = each.distance * draw.unit();
        const double sum = spherical_depth(each.profile, each.ray, part) +
                           spherical_depth(each.profile, ray_at(part, 1), each.distance - part);
        if (!(relative_error(sum, value) < tolerance)) return each.report("in parts", sum);
        return {};
    });
}

TEST(Sweep, SphericalDistanceInvertsTheDepth) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Case each = ordinary(draw);
            const double whole = spherical_depth(each.profile, each.ray, each.distance);
            if (!(whole > 1e-280 && whole < 1e280)) return {};
            const double depth = whole * (draw.chance(0.2) ? draw.decades(-20, 0) : draw.unit());
            const double distance =
                spherical_distance(each.profile, each.ray, each.distance, depth);
            if (!(distance >= 0 && distance <= each.distance)) {
                return each.report("spherical_distance", distance);
            }
            const double again = spherical_depth(each.profile, each.ray, distance);
            // The depths of the distances next to it: no double does better.
            const double before =
                spherical_depth(each.profile, each.ray, std::nextafter(distance, 0));
            const double after =
                spherical_depth(each.profile, each.ray, std::nextafter(distance, kInfinity));
            const double spacing = std::max(after - again, again - before);
            if (!(std::abs(again - depth) <= 1e-14 * depth + spacing)) {
                return each.report("spherical_depth of spherical_distance", again / depth - 1);
            }
            return {};
        },
        kSweepInputs);
}

}  // namespace
}  // namespace airlight
