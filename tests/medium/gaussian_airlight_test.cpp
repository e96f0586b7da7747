// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_airlight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/gaussian_airlight_method.h"
#include "medium/gaussian_airlight_sets.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Method = GaussianAirlightMethod;

struct Row {
    int number;
    GaussianMedium medium;
    AirlightRay ray;
    std::vector<double> values;  // the columns after dr
};

std::vector<Row> rows_of(const char* scenes, const char* blobs, std::size_t columns) {
    std::map<int, std::vector<GaussianBlob>> lists;
    for (const auto& row : reference_rows(blobs, 7, 40)) {
        lists[static_cast<int>(row[0])].push_back({{row[4], row[5], row[6]}, row[2], row[3]});
    }
    std::vector<Row> rows;
    for (const auto& row : reference_rows(scenes, columns, 24)) {
        Row r;
        r.number = static_cast<int>(row[0]);
        r.medium = {row[2], lists[r.number]};
        EXPECT_EQ(r.medium.blobs.size(), row[1]);
        r.ray = {{0, 0, 0}, {row[3], row[4], row[5]}, {row[6], row[7], row[8]}, row[9]};
        r.values.assign(row.begin() + 10, row.end());
        rows.push_back(r);
    }
    return rows;
}

double by(Method method, const GaussianMedium& medium, const AirlightRay& ray) {
    return GaussianAirlightEvaluator(method, medium, ray.viewer, ray.light)(ray.direction,
                                                                            ray.dist);
}

TEST(GaussianAirlight, MatchesEveryReferenceScene) {
    for (const Row& row : rows_of("fogshop_airlight.csv", "fogshop_scenes.csv", 14)) {
        // Measured: 2.6e-15.
        EXPECT_LT(relative_error(gaussian_airlight(row.medium, row.ray), row.values[0]), 1e-13)
            << row.number;
    }
}

TEST(GaussianAirlight, MatchesTheHardScenesComputedInManyDigits) {
    for (const Row& row :
         rows_of("gaussian_airlight_corners.csv", "gaussian_airlight_corner_blobs.csv", 11)) {
        EXPECT_LT(relative_error(gaussian_airlight(row.medium, row.ray), row.values[0]), 1e-10)
            << row.number << ": " << gaussian_airlight(row.medium, row.ray);
    }
}

TEST(GaussianAirlight, OfAUniformMediumIsItsClosedForm) {
    SweepDraw draw(1);
    for (int i = 0; i < 200; ++i) {
        AirlightRay ray;
        ray.light = {draw.uniform(-3, 3), draw.uniform(-3, 3), draw.uniform(-3, 3)};
        ray.direction = glm::normalize(
            glm::dvec3(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)));
        ray.dist = i % 3 == 0 ? kInfinity : draw.uniform(0, 9);
        // A blob without scale is uniform too.
        const GaussianMedium medium{draw.decades(-6, 1), {{{1, 2, 3}, 0, 0.01}}};
        const double beta = medium.beta0 + 0.01;
        const double across = glm::length(glm::cross(ray.direction, ray.light));
        const double gamma = std::atan2(across, glm::dot(ray.direction, ray.light));
        const double closed =
            beta * beta * airlight(gamma, beta * glm::length(ray.light), beta * ray.dist);
        // The angle between nearly parallel vectors is good to 1e-15 / gamma.
        const double tolerance = 1e-10;
        EXPECT_LT(relative_error(gaussian_airlight(medium, ray), closed), tolerance);
        for (const Method method : {Method::fogshop, Method::centroid}) {
            EXPECT_LT(relative_error(by(method, medium, ray), closed), 1e-12);
        }
    }
}

// int_0^b = int_0^a + exp(-T(v, a)) int_a^b: the rest of the ray, seen from its point a.
TEST(GaussianAirlight, PartsOfARayAddUpToTheWhole) {
    for (const GaussianScene& scene : gaussian_scenes("dense", 3, 60)) {
        AirlightRay first = scene.ray, rest = scene.ray;
        first.dist = 0.37 * scene.ray.dist;
        rest.viewer += first.dist * rest.direction;
        rest.dist = scene.ray.dist - first.dist;
        const double depth =
            gaussian_optical_depth(scene.medium, first.viewer, first.direction, first.dist);
        const double sum = gaussian_airlight(scene.medium, first) +
                           std::exp(-depth) * gaussian_airlight(scene.medium, rest);
        EXPECT_LT(relative_error(sum, scene.exact), 1e-12);
    }
}

TEST(GaussianAirlight, DoesNotDependOnTheOrderOfTheBlobsNorOnEmptyOnes) {
    for (const GaussianScene& scene : gaussian_scenes("medium", 5, 20)) {
        GaussianMedium other = scene.medium;
        std::reverse(other.blobs.begin(), other.blobs.end());
        other.blobs.push_back({{1, 1, 1}, 2, 0});
        EXPECT_LT(relative_error(gaussian_airlight(other, scene.ray), scene.exact), 1e-12);
        for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
            EXPECT_LT(relative_error(by(info.method, other, scene.ray),
                                     by(info.method, scene.medium, scene.ray)),
                      1e-11)
                << info.name;
        }
    }
}

TEST(GaussianAirlight, CornersAreTheirLimits) {
    const GaussianMedium medium{0.1, {{{0, 0, 4}, 1, 1}}};
    const GaussianMedium empty{0, {}};
    const GaussianMedium blob{0, medium.blobs};
    for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
        const auto value = [&](const GaussianMedium& m, const AirlightRay& ray) {
            return by(info.method, m, ray);
        };
        const glm::dvec3 o(0), z(0, 0, 1);
        EXPECT_EQ(value(medium, {o, {1, 0, 3}, z, 0}), 0) << info.name;
        EXPECT_EQ(value(empty, {o, {1, 0, 3}, z, 5}), 0) << info.name;
        EXPECT_EQ(value(empty, {o, {1, 0, 3}, z, kInfinity}), 0) << info.name;
        // Light on the ray, light at the viewer, with no medium, beyond the end, behind the viewer.
        EXPECT_EQ(value(medium, {o, {0, 0, 3}, z, 5}), kInfinity) << info.name;
        EXPECT_EQ(value(blob, {o, {0, 0, 3}, z, kInfinity}), kInfinity) << info.name;
        EXPECT_EQ(value(medium, {o, o, z, 5}), kInfinity) << info.name;
        EXPECT_EQ(value(empty, {o, o, z, 5}), 0) << info.name;
        for (const double place : {-2.0, 7.0}) {
            const double on = value(medium, {o, {0, 0, place}, z, 5});
            const double beside = value(medium, {o, {1e-9, 0, place}, z, 5});
            EXPECT_GT(on, 0) << info.name;
            EXPECT_LT(relative_error(on, beside), 1e-8) << info.name << ' ' << place;
        }
        // Nothing lies beyond a long ray.
        EXPECT_LT(relative_error(value(blob, {o, {1, 0, 3}, z, kInfinity}),
                                 value(blob, {o, {1, 0, 3}, z, 31.0})),
                  info.name == "exact" || info.name == "fogshop" || info.name == "centroid" ? 1e-12
                                                                                            : 1e-1)
            << info.name;
    }
}

TEST(GaussianAirlight, RefusesWhatIsOutsideItsDomainWithNan) {
    const GaussianMedium good{0.1, {{{0, 0, 4}, 1, 1}}};
    const AirlightRay ray{{0, 0, 0}, {1, 0, 3}, {0, 0, 1}, 5};
    for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
        for (const double bad : {kNan, -1.0, kInfinity, 1e101}) {
            GaussianMedium medium = good;
            medium.beta0 = bad;
            EXPECT_TRUE(std::isnan(by(info.method, medium, ray))) << info.name << bad;
            medium = good;
            medium.blobs[0].scale = bad;
            EXPECT_TRUE(std::isnan(by(info.method, medium, ray))) << info.name << bad;
            medium = good;
            medium.blobs[0].amplitude = bad;
            EXPECT_TRUE(std::isnan(by(info.method, medium, ray))) << info.name << bad;
            if (bad == -1) continue;
            medium = good;
            medium.blobs[0].center.y = bad;
            EXPECT_TRUE(std::isnan(by(info.method, medium, ray))) << info.name << bad;
            AirlightRay other = ray;
            other.light.x = bad;
            EXPECT_TRUE(std::isnan(by(info.method, good, other))) << info.name << bad;
        }
        for (const double bad : {kNan, -1.0, -kInfinity}) {
            AirlightRay other = ray;
            other.dist = bad;
            EXPECT_TRUE(std::isnan(by(info.method, good, other))) << info.name << bad;
        }
        for (const double length : {0.0, 0.9, 2.0, kNan}) {
            AirlightRay other = ray;
            other.direction = {0, 0, length};
            EXPECT_TRUE(std::isnan(by(info.method, good, other))) << info.name << length;
        }
    }
}

// A scene from the corners: sizes over many orders of magnitude, centers and lights on the ray.
GaussianScene hard_scene(SweepDraw& draw) {
    GaussianScene scene;
    const double size = draw.chance(0.8) ? 1 : draw.decades(-90, 90);
    const auto coordinate = [&] {
        return size * draw.sign() * (draw.chance(0.5) ? draw.uniform(0, 5) : draw.decades(-9, 1));
    };
    scene.ray.direction =
        draw.chance(0.3)
            ? glm::dvec3(0, 0, 1)
            : glm::normalize(glm::dvec3(draw.uniform(-1, 1), draw.uniform(-1, 1), 0.3));
    const auto point = [&] {
        if (draw.chance(0.4)) return scene.ray.direction * coordinate();
        return glm::dvec3(coordinate(), coordinate(), coordinate());
    };
    scene.ray.light = draw.chance(0.05) ? scene.ray.viewer : point();
    scene.ray.dist = draw.chance(0.2) ? draw.not_negative() : size * draw.uniform(0, 12);
    scene.medium.beta0 = draw.chance(0.5) ? 0 : draw.decades(-8, 2) / size;
    if (draw.chance(0.05)) scene.medium.beta0 = std::min(draw.not_negative(false), 1e100);
    const int count = static_cast<int>(draw.bits() % 4);
    for (int i = 0; i < count; ++i) {
        GaussianBlob blob;
        blob.center = draw.chance(0.1) ? scene.ray.light : point();
        blob.scale = (draw.chance(0.7) ? draw.uniform(0.1, 3) : draw.decades(-5, 5)) / size;
        blob.amplitude = draw.decades(-3, 3) / size;
        // As narrow as the domain has them, 1e-12 of 40 sizes, or as wide as anything.
        if (draw.chance(0.05)) {
            blob.scale = std::min({draw.not_negative(false), 1e10 / size, 1e100});
        }
        if (draw.chance(0.05)) blob.amplitude = std::min(draw.not_negative(false), 1e100);
        scene.medium.blobs.push_back(blob);
    }
    return scene;
}

std::string report(std::string_view name, const GaussianScene& s, double value) {
    std::string line =
        sweep_report(std::string(name).c_str(),
                     {s.medium.beta0, s.ray.light.x, s.ray.light.y, s.ray.light.z,
                      s.ray.direction.x, s.ray.direction.y, s.ray.direction.z, s.ray.dist},
                     value);
    for (const GaussianBlob& blob : s.medium.blobs) {
        line += sweep_report(" blob", {blob.center.x, blob.center.y, blob.center.z, blob.scale},
                             blob.amplitude);
    }
    return line;
}

TEST(GaussianAirlight, SweepOfEveryMethodGivesNeitherNanNorNegative) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const GaussianScene scene = hard_scene(draw);
            for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
                if (info.method == Method::exact && !draw.chance(0.02)) continue;
                if (info.method > Method::mixed_gl16 && info.method < Method::exact) continue;
                const double value = by(info.method, scene.medium, scene.ray);
                if (!(value >= 0)) return report(info.name, scene, value);
            }
            return "";
        },
        kSweepInputs / 10);
}

TEST(GaussianAirlight, SweepGrowsWithTheLengthOfTheRay) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            GaussianScene scene = hard_scene(draw);
            GaussianAirlightOptions options;
            options.tolerance = 1e-8;
            const double value = gaussian_airlight(scene.medium, scene.ray, options);
            scene.ray.dist *= 1 + draw.decades(-6, 1);
            const double longer = gaussian_airlight(scene.medium, scene.ray, options);
            if (longer >= value * (1 - 1e-7)) return "";
            return report("longer", scene, longer / value - 1);
        },
        kSweepInputs / 500);
}

TEST(GaussianAirlightMethod, FogshopMatchesTheColumnsOfThePaper) {
    for (const Row& row : rows_of("fogshop_airlight.csv", "fogshop_scenes.csv", 14)) {
        const GaussianAirlightEvaluator evaluator(Method::fogshop, row.medium, row.ray.viewer,
                                                  row.ray.light);
        const FogshopAirlight parts = evaluator.parts(row.ray.direction, row.ray.dist);
        // Measured: 9e-14, 4e-14 and 4e-13, of which the references' own 14 digits are a part.
        EXPECT_LT(relative_error(evaluator(row.ray.direction, row.ray.dist), row.values[1]), 1e-12);
        EXPECT_LT(relative_error(parts.gaussians, row.values[2]), 1e-12);
        EXPECT_LT(relative_error(parts.uniform, row.values[3]), 1e-12);
    }
}

TEST(GaussianAirlightMethod, ErrsAsItsHeaderSays) {
    const struct {
        Method method;
        const char* set;
        int blobs;
        double median, p90;
    } cases[] = {
        {Method::fogshop, "thin", 1, .03, .25},       {Method::fogshop, "dense", 1, .12, .8},
        {Method::centroid, "thin", 1, .02, .15},      {Method::centroid, "dense", 1, .1, .7},
        {Method::march8, "thin", 1, 1e-2, .2},        {Method::march16, "thin", 1, 2e-3, 2e-2},
        {Method::march32, "dense", 5, 1e-3, 5e-3},    {Method::march64, "dense", 5, 2e-4, 1e-3},
        {Method::mixed_gl8, "thin", 1, 4e-3, .25},    {Method::mixed_gl16, "thin", 1, 1e-5, 5e-3},
        {Method::mixed_gl16, "dense", 5, 3e-4, .02},  {Method::mixed_gl32, "thin", 1, 1e-11, 1e-6},
        {Method::mixed_gl32, "dense", 5, 1e-8, 1e-4}, {Method::mixed_gl64, "dense", 5, 1e-13, 1e-8},
    };
    for (const auto& c : cases) {
        const ErrorQuantiles errors = gaussian_scene_errors(
            gaussian_scenes(c.set, c.blobs, 150),
            [&](const auto& scene) { return gaussian_scene_airlight(c.method, scene); });
        const std::string_view name = method_name(kGaussianAirlightMethods, c.method);
        EXPECT_LT(errors.median, c.median) << name << ' ' << c.set << c.blobs;
        EXPECT_LT(errors.p90, c.p90) << name << ' ' << c.set << c.blobs;
        // And not by much less, or the header is out of date.
        EXPECT_GT(errors.median, c.median / 1000) << name;
    }
}

TEST(GaussianAirlightMethod, NamesComeBack) {
    for (const NamedMethod<GaussianAirlightMethod>& info : kGaussianAirlightMethods) {
        EXPECT_EQ(method_from_name(kGaussianAirlightMethods, info.name), info.method);
        EXPECT_EQ(method_name(kGaussianAirlightMethods, info.method), info.name);
    }
    EXPECT_FALSE(method_from_name(kGaussianAirlightMethods, "none").has_value());
}

// [Zhou07] eq. 12 and 13 as printed: f^0 has exp(+T_i(s, b_i) + T_i(v, b_i)), f^1 the inverse.
TEST(GaussianAirlightMethod, ThePrintedCompensationOverflowsInADenseBlob) {
    const GaussianBlob blob{{0, 0, 4}, 0.4, 1e3};
    const glm::dvec3 viewer(0, 7, 0), light(0, 9, 4);
    const double compensation = gaussian_optical_depth(blob, light, blob.center) +
                                gaussian_optical_depth(blob, viewer, blob.center);
    const double f1 = std::exp(-compensation);
    EXPECT_EQ(f1, 0);
    EXPECT_EQ(std::exp(compensation), kInfinity);
    EXPECT_TRUE(std::isnan(f1 * std::exp(compensation)));
    const GaussianMedium medium{0, {blob}};
    const AirlightRay ray{viewer, light, {0, 0, 1}, 12};
    for (const Method method : {Method::fogshop, Method::centroid, Method::exact}) {
        EXPECT_GT(by(method, medium, ray), 0);
        EXPECT_LT(by(method, medium, ray), 1);
    }
}

TEST(GaussianCentroid, IsTheCentroidOfTheClippedGaussian) {
    for (const double m : {-40.0, -6.0, -2.1, -1.9, -0.5, 0.0, 0.3, 1.0, 1.7, 3.1, 5.0, 60.0}) {
        for (const double dist : {1e-4, 0.3, 1.0, 4.0}) {
            double mass = 0, moment = 0;
            const double peak = std::min(std::max(m, 0.0), dist) - m;
            for (int i = 0; i < 40000; ++i) {
                const double t = dist * (i + 0.5) / 40000;
                const double weight = std::exp(peak * peak - (t - m) * (t - m));
                mass += weight;
                moment += weight * t;
            }
            EXPECT_NEAR(gaussian_centroid(1, m, dist) / dist, moment / mass / dist, 2e-7)
                << m << ' ' << dist;
        }
    }
    EXPECT_NEAR(gaussian_centroid(2, 0, kInfinity), 0.5 / std::sqrt(kPi), 1e-15);
    EXPECT_GE(gaussian_centroid(1, -1e9, 1), 0);
    EXPECT_LE(gaussian_centroid(1e200, 1e200, 1), 1);
}

TEST(GaussianAirlight, BlobsNarrowerThanCoordinatesTellAreOutsideTheDomain) {
    const AirlightRay ray = {glm::dvec3(0), glm::dvec3(0, 1, 1), glm::dvec3(0, 0, 1),
                             std::numeric_limits<double>::infinity()};
    const auto airlight_of = [&](double scale) {
        return gaussian_airlight({0, {{glm::dvec3(0, 0, 5), scale, scale}}}, ray);
    };
    // The limit of a thin wall of fixed depth.
    EXPECT_NEAR(airlight_of(1e10), 0.0022769, 1e-6);
    EXPECT_NEAR(airlight_of(1e11), 0.0022769, 1e-6);
    EXPECT_TRUE(std::isnan(airlight_of(1e14)));
    EXPECT_TRUE(std::isnan(airlight_of(1e100)));
}

}  // namespace
}  // namespace airlight
