// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRootPi = 1.7724538509055160273;

// `count` blobs in a cube of edge 10 around the origin; their size falls as their number grows.
std::vector<GaussianBlob> cloud(int count, std::uint64_t seed = 1) {
    SweepDraw draw(seed);
    std::vector<GaussianBlob> blobs;
    for (int i = 0; i < count; ++i) {
        GaussianBlob blob;
        blob.center = {draw.uniform(-5, 5), draw.uniform(-5, 5), draw.uniform(-5, 5)};
        blob.scale = draw.uniform(0.1, 0.3) * std::cbrt(count);
        blob.amplitude = draw.decades(-2, 1);
        blobs.push_back(blob);
    }
    return blobs;
}

glm::dvec3 direction_of(SweepDraw& draw) {
    return glm::normalize(
        glm::dvec3(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)));
}

TEST(GaussianTree, OpticalDepthIsWithinTheToleranceOfTheWholeSum) {
    const std::vector<GaussianBlob> blobs = cloud(5000);
    const GaussianTree tree(blobs);
    SweepDraw draw(2);
    double most_left_out = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 origin(draw.uniform(-8, 8), draw.uniform(-8, 8), draw.uniform(-8, 8));
        const glm::dvec3 direction = direction_of(draw);
        const double dist = i % 4 == 0 ? kInfinity : draw.uniform(0, 12);
        const double whole = gaussian_optical_depth({0, blobs}, origin, direction, dist);
        for (const double tolerance : {0.0, 1e-9, 1e-4, 1e-2, 1.0}) {
            const double depth = tree.optical_depth(origin, direction, dist, tolerance);
            // Another order of summation, and exponents up to 700 of rounded distances.
            const double rounding = 1e-12 * whole;
            EXPECT_LE(depth, whole + rounding);
            EXPECT_GE(depth, whole - tolerance - rounding);
            const double quick = tree.quick_optical_depth(origin, direction, dist, tolerance);
            EXPECT_LE(quick, whole + rounding);
            EXPECT_GE(quick, whole - tolerance - rounding);
            EXPECT_GE(quick, depth - tolerance - rounding);
            if (tolerance > 0)
                most_left_out = std::max(most_left_out, (whole - depth - rounding) / tolerance);
        }
    }
    // The bound is used: something is left out, and not next to nothing.
    EXPECT_GT(most_left_out, 0.1);
}

TEST(GaussianTree, DensityIsWithinTheToleranceOfTheWholeSum) {
    const std::vector<GaussianBlob> blobs = cloud(5000, 7);
    const GaussianTree tree(blobs);
    SweepDraw draw(8);
    double most_left_out = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 x(draw.uniform(-8, 8), draw.uniform(-8, 8), draw.uniform(-8, 8));
        double whole = 0;
        for (const GaussianBlob& blob : blobs) whole += gaussian_density(blob, x);
        for (const double tolerance : {0.0, 1e-9, 1e-4, 1e-2, 1.0}) {
            const double density = tree.density(x, tolerance);
            const double rounding = 1e-12 * whole;
            EXPECT_LE(density, whole + rounding);
            EXPECT_GE(density, whole - tolerance - rounding);
            if (tolerance > 0) {
                most_left_out = std::max(most_left_out, (whole - density - rounding) / tolerance);
            }
        }
    }
    // An even share leaves most of the tolerance unused, but not all.
    EXPECT_GT(most_left_out, 1e-4);
    EXPECT_TRUE(std::isnan(tree.density({0, 0, kNan}, 0)));
    EXPECT_TRUE(std::isnan(tree.density({0, 0, 0}, -1)));
    EXPECT_EQ(GaussianTree({}).density({0, 0, 0}, 0), 0);
}

TEST(GaussianTree, DensityLooksAtFewOfManyBlobs) {
    for (const int count : {1000, 10000, 100000}) {
        const GaussianTree tree(cloud(count));
        SweepDraw draw(9);
        double taken = 0, nodes = 0;
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 x(draw.uniform(-5, 5), draw.uniform(-5, 5), draw.uniform(-5, 5));
            GaussianTreeVisits visits;
            tree.density(x, 1e-8, &visits);
            taken += double(visits.taken) / 100;
            nodes += double(visits.nodes) / 100;
        }
        // Blobs shrink as they grow in number, so about as many reach a point.
        EXPECT_LT(taken, 200) << count;
        EXPECT_LT(nodes, 1000) << count;
    }
}

TEST(GaussianTree, TakesTheBlobsWithTheLargestBounds) {
    const std::vector<GaussianBlob> blobs = cloud(2000, 3);
    const GaussianTree tree(blobs);
    SweepDraw draw(4);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 origin(draw.uniform(-8, 8), draw.uniform(-8, 8), draw.uniform(-8, 8));
        const glm::dvec3 direction = direction_of(draw);
        const double dist = draw.uniform(0, 12), tolerance = draw.decades(-8, 0);
        GaussianTreeVisits visits;
        const std::vector<std::uint32_t> taken =
            tree.along(origin, direction, dist, tolerance, &visits);
        EXPECT_TRUE(std::is_sorted(taken.begin(), taken.end()));
        EXPECT_EQ(visits.taken, taken.size());
        double sum = 0, left_out = 0;
        for (std::uint32_t k = 0; k < blobs.size(); ++k) {
            const double depth = gaussian_optical_depth(blobs[k], origin, direction, dist);
            if (std::binary_search(taken.begin(), taken.end(), k)) {
                sum += depth;
                continue;
            }
            left_out += depth;
        }
        EXPECT_LE(left_out, tolerance);
        EXPECT_NEAR(sum, tree.optical_depth(origin, direction, dist, tolerance), 1e-12 * sum);
        // Whatever is taken has a larger bound than whatever is not.
        const auto bound = [&](std::uint32_t k) {
            const GaussianBlob& blob = blobs[k];
            const glm::dvec3 to = blob.center - origin;
            const double t = std::clamp(glm::dot(to, direction), 0.0, dist);
            const double x = blob.scale * glm::length(to - t * direction);
            return blob.amplitude * kRootPi / blob.scale * std::exp(-x * x);
        };
        double least_taken = kInfinity, most_left = 0;
        for (std::uint32_t k = 0; k < blobs.size(); ++k) {
            if (std::binary_search(taken.begin(), taken.end(), k)) {
                least_taken = std::min(least_taken, bound(k));
            } else {
                most_left = std::max(most_left, bound(k));
            }
        }
        EXPECT_GE(least_taken, most_left * (1 - 1e-9));
    }
}

GaussianTreeVisits mean_visits(const GaussianTree& tree, double dist) {
    SweepDraw draw(6);
    GaussianTreeVisits sum;
    const int rays = 200;
    for (int i = 0; i < rays; ++i) {
        const glm::dvec3 origin(draw.uniform(-4, 4), draw.uniform(-4, 4), draw.uniform(-5, -1));
        GaussianTreeVisits visits;
        tree.along(origin, {0, 0, 1}, dist, 1e-2, &visits);
        sum.nodes += visits.nodes;
        sum.blobs += visits.blobs;
        sum.taken += visits.taken;
    }
    return {sum.nodes / rays, sum.blobs / rays, sum.taken / rays};
}

// 8 times the blobs at the same density, in a cube twice as large: a segment meets as many as
// before, and what it visits besides grows like the height of the tree.
TEST(GaussianTree, VisitsGrowLikeTheLogarithmForTheSameBlobsTaken) {
    GaussianTreeVisits first;
    for (const int count : {8000, 64000}) {
        std::vector<GaussianBlob> blobs = cloud(count, 5);
        const double size = std::cbrt(count / 1000.0);
        for (GaussianBlob& blob : blobs) {
            blob.center *= size;
            blob.scale /= size;
        }
        const GaussianTree tree(std::move(blobs));
        const GaussianTreeVisits mean = mean_visits(tree, 5);
        if (count == 8000) first = mean;
        // Measured: 528 and 600 nodes, 54 and 59 blobs taken; three more levels of the tree.
        EXPECT_GT(mean.taken, 40u);
        EXPECT_LT(mean.taken, 70u);
        EXPECT_LT(mean.nodes, 650u);
        EXPECT_LT(mean.nodes, first.nodes + 3 * 40);
    }
}

// A cube of the same size, filled with more and smaller ones: visits go with the blobs taken.
TEST(GaussianTree, VisitsGrowLikeTheBlobsTaken) {
    for (const int count : {1000, 8000, 64000}) {
        const GaussianTree tree(cloud(count, 5));
        const GaussianTreeVisits mean = mean_visits(tree, kInfinity);
        EXPECT_LT(static_cast<double>(mean.nodes),
                  6 * (std::log2(count) + static_cast<double>(mean.taken)));
        EXPECT_LT(static_cast<double>(mean.blobs),
                  6 * (std::log2(count) + static_cast<double>(mean.taken)));
        EXPECT_LT(tree.node_count(), static_cast<std::size_t>(count));
    }
}

TEST(GaussianTree, AirlightOfTheBlobsAroundARayIsWithinItsBound) {
    std::vector<GaussianBlob> blobs = cloud(60, 7);
    const GaussianTree tree(blobs);
    SweepDraw draw(8);
    std::size_t most = 0;
    for (int i = 0; i < 10; ++i) {
        AirlightRay ray;
        ray.viewer = {draw.uniform(-6, 6), draw.uniform(-6, 6), draw.uniform(-6, 6)};
        ray.light = {draw.uniform(-6, 6), draw.uniform(-6, 6), draw.uniform(-6, 6)};
        ray.direction = direction_of(draw);
        ray.dist = i % 2 == 0 ? kInfinity : draw.uniform(1, 10);
        GaussianAirlightOptions options;
        options.tolerance = 1e-8;
        const double whole = gaussian_airlight({0, blobs}, ray, options);
        const double h = glm::length(glm::cross(ray.direction, ray.light - ray.viewer));
        for (const double tolerance : {1e-4, 0.1}) {
            GaussianMedium around;
            for (const std::uint32_t k : tree.around(ray, tolerance)) {
                around.blobs.push_back(blobs[k]);
            }
            most = std::max(most, around.blobs.size());
            const double value = gaussian_airlight(around, ray, options);
            EXPECT_GE(value, whole * (1 - 1e-7) - tolerance / (4 * 3.14159 * h * h));
            EXPECT_LE(value, whole * (1 + 1e-7) * std::exp(2 * tolerance));
        }
    }
    EXPECT_LT(most, blobs.size());
}

TEST(GaussianTree, CornersHaveAnswers) {
    const GaussianTree empty({});
    EXPECT_EQ(empty.optical_depth({0, 0, 0}, {0, 0, 1}, kInfinity, 0), 0);
    EXPECT_TRUE(empty.along({0, 0, 0}, {0, 0, 1}, kInfinity, 0).empty());
    EXPECT_TRUE(empty.around({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 3}, 0).empty());

    // Many blobs in one place, some of them empty; one that is huge beside them.
    std::vector<GaussianBlob> blobs(100, GaussianBlob{{1, 2, 3}, 1, 0.5});
    for (std::size_t i = 0; i < 50; ++i) blobs[2 * i].amplitude = 0;
    blobs.push_back({{0, 0, 0}, 1e-3, 1});
    const GaussianTree tree(blobs);
    const double whole = gaussian_optical_depth({0, blobs}, {0, 0, 0}, {0, 0, 1}, 7.0);
    EXPECT_NEAR(tree.optical_depth({0, 0, 0}, {0, 0, 1}, 7, 0), whole, 1e-13 * whole);
    EXPECT_EQ(tree.along({0, 0, 0}, {0, 0, 1}, 7, 0).size(), 51u);
    EXPECT_EQ(tree.optical_depth({0, 0, 0}, {0, 0, 1}, 7, kInfinity), 0);
    EXPECT_EQ(tree.optical_depth({0, 0, 0}, {0, 0, 1}, 0, 0), 0);
    // A triangle without area: the light on the ray, at the viewer.
    EXPECT_EQ(tree.around({{0, 0, 0}, {0, 0, 5}, {0, 0, 1}, 7}, 0).size(), 51u);
    EXPECT_EQ(tree.around({{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 0}, 0).size(), 51u);

    EXPECT_TRUE(std::isnan(tree.optical_depth({kNan, 0, 0}, {0, 0, 1}, 7, 0)));
    EXPECT_TRUE(std::isnan(tree.optical_depth({0, 0, 0}, {0, 0, 2}, 7, 0)));
    EXPECT_TRUE(std::isnan(tree.optical_depth({0, 0, 0}, {0, 0, 1}, -1, 0)));
    EXPECT_TRUE(std::isnan(tree.optical_depth({0, 0, 0}, {0, 0, 1}, 7, -1)));
    EXPECT_TRUE(std::isnan(tree.optical_depth({0, 0, 0}, {0, 0, 1}, 7, kNan)));
}

TEST(GaussianTree, RefusesBlobsThatAreNoneAndNamesThem) {
    const GaussianBlob good{{1, 2, 3}, 1, 1};
    const auto message = [&](const GaussianBlob& bad) -> std::string {
        try {
            const GaussianTree tree({good, bad});
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::data);
            return error.what();
        }
        return "taken";
    };
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e101}) {
        EXPECT_NE(message({{1, bad, 3}, 1, 1}).find("blob 1: center"), std::string::npos);
        EXPECT_NE(message({{1, 2, 3}, bad, 1}).find("blob 1: scale"), std::string::npos);
        EXPECT_NE(message({{1, 2, 3}, 1, bad}).find("blob 1: amplitude"), std::string::npos);
    }
    EXPECT_NE(message({{1, 2, 3}, -1, 1}).find("scale is -1"), std::string::npos);
    EXPECT_NE(message({{1, 2, 3}, 1, -1}).find("amplitude is -1"), std::string::npos);
    EXPECT_NE(message({{1, 2, 3}, 0, 1}).find("scale is 0"), std::string::npos);
    EXPECT_EQ(message({{1, 2, 3}, 0, 0}), "taken");
}

// [Zhou07] eq. 30 as printed: sin xi = sqrt(ln c - ln eps) / (a |b - v|), eps = e^-9.
TEST(GaussianTree, ThePrintedConeHasNoAnswerForThinBlobsNorFromInside) {
    const auto printed = [](const GaussianBlob& blob, const glm::dvec3& viewer) {
        return std::sqrt(std::log(blob.amplitude) + 9) /
               (blob.scale * glm::length(blob.center - viewer));
    };
    const GaussianBlob thin{{0, 0, 4}, 1e-3, 1e-4}, near{{0, 0, 1}, 1, 1};
    const glm::dvec3 viewer(0);
    EXPECT_TRUE(std::isnan(printed(thin, viewer)));
    EXPECT_GT(printed(near, viewer), 1);
    // The thin one is wide: an optical depth of .09 that the paper drops.
    EXPECT_GT(gaussian_optical_depth(thin, viewer, {0, 0, 1}, kInfinity), 0.08);
    const GaussianTree tree({thin, near});
    EXPECT_EQ(tree.along(viewer, {0, 0, 1}, kInfinity, 1e-2).size(), 2u);
    // Looking away from the near one, whose tail is behind the viewer's back.
    EXPECT_EQ(tree.along(viewer, {0, 0, -1}, kInfinity, 1e-2).size(), 2u);
}

}  // namespace
}  // namespace airlight
