// SPDX-License-Identifier: Apache-2.0
#include "prt/bake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "prt/hemisphere.h"
#include "prt/morton.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

const BakeKinds kEverything = {true, true, true, true, true};

Bake bake(const Mesh& mesh, const std::vector<const Mesh*>& occluders = {}, int order = 6,
          int rays = 1024, const RaySceneOptions& scene_options = {}) {
    const RayScene scene(mesh, occluders, scene_options);
    BakeOptions options;
    options.order = order;
    options.rays = rays;
    return bake_mesh(mesh, scene, options, kEverything);
}

std::vector<double> rotated(const std::vector<double>& zonal, const glm::dvec3& axis) {
    const int order = static_cast<int>(zonal.size());
    std::vector<double> out(sh_count(order));
    rotate_zonal(order, zonal.data(), axis, out.data());
    return out;
}

template <class Values>
double largest_difference(const float* row, const Values& expected) {
    double error = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        error = std::max(error, std::abs(double(row[i]) - expected[i]));
    }
    return error;
}

bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool same_bytes(const Bake& a, const Bake& b) {
    return same_bytes(a.visibility, b.visibility) && same_bytes(a.transfer, b.transfer) &&
           same_bytes(a.unshadowed_transfer, b.unshadowed_transfer) &&
           same_bytes(a.ambient_occlusion, b.ambient_occlusion) &&
           same_bytes(a.bent_normal, b.bent_normal);
}

bool all_finite(const Bake& b) {
    for (const auto* values : {&b.visibility, &b.transfer, &b.unshadowed_transfer,
                               &b.ambient_occlusion, &b.bent_normal}) {
        for (const float value : *values) {
            if (!std::isfinite(value)) return false;
        }
    }
    return true;
}

TEST(Bake, AnOpenVertexSeesTheHemisphereAndTheClampedCosine) {
    const Bake b = bake(make_floor(), {}, 6, 1);
    // sqrt(pi (2l+1)) int_0^1 P_l, and the zonal coefficients of the clamped cosine, by hand.
    const double root = std::sqrt(kPi);
    const double seen[] = {root, std::sqrt(3 * kPi) / 2,  0, -std::sqrt(7 * kPi) / 8,
                           0,    std::sqrt(11 * kPi) / 16};
    const double cosine[] = {root / 2, std::sqrt(kPi / 3), std::sqrt(5 * kPi) / 8,
                             0,        -root / 16,         0};
    for (std::size_t i = 0; i < 36; ++i) {
        const ShDegree d = sh_degree(i);
        EXPECT_NEAR(b.visibility[i], d.m == 0 ? seen[d.l] : 0.0, 1e-6) << i;
        EXPECT_NEAR(b.transfer[i], d.m == 0 ? cosine[d.l] / kPi : 0.0, 1e-6) << i;
        EXPECT_EQ(b.transfer[i], b.unshadowed_transfer[i]);
    }
    EXPECT_EQ(b.ambient_occlusion[0], 1.0f);
    EXPECT_EQ(b.bent_normal[2], 1.0f);
}

TEST(Bake, EveryOrderIsThatOfTheAnalyticHemisphere) {
    const Mesh sphere = make_sphere(5);
    for (int order = 1; order <= kLargestBakeOrder; ++order) {
        const Bake b = bake(sphere, {}, order, 64);
        ASSERT_EQ(b.report.blocked, 0u);
        const std::size_t size = sh_count(order);
        ASSERT_EQ(b.visibility.size(), size * sphere.positions.size());
        for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
            EXPECT_LE(largest_difference(&b.visibility[v * size],
                                         rotated(zonal_coefficients(phong_eigenvalues(0, order)),
                                                 sphere.normals[v])),
                      1e-6);
        }
    }
}

TEST(Bake, ASphereOverAPlaneHidesWhatItShould) {
    const Mesh floor = make_floor();
    for (const double tilt : {0.0, 0.4, 0.8}) {
        // Far enough from the horizon for the whole sphere to be above it.
        const double d = 3, r = 1.2;
        const glm::dvec3 axis(std::sin(tilt), 0, std::cos(tilt));
        const Mesh ball = make_sphere(160, r, d * axis);
        const Bake b = bake(floor, {&ball}, 6, 65536);
        const double a = std::asin(r / d);
        std::vector<double> expected =
            rotated(zonal_coefficients(phong_eigenvalues(0, 6)), {0, 0, 1});
        // sqrt(pi (2l+1)) int_{cos a}^1 P_l.
        std::vector<double> cap = {std::sqrt(kPi) * (1 - std::cos(a))};
        for (unsigned l = 1; l < 6; ++l) {
            cap.push_back(std::sqrt(kPi / (2 * l + 1)) *
                          (std::legendre(l - 1, std::cos(a)) - std::legendre(l + 1, std::cos(a))));
        }
        const std::vector<double> blocked = rotated(cap, axis);
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] -= blocked[i];
        EXPECT_LE(largest_difference(b.visibility.data(), expected), 1e-3) << tilt;
        const double irradiance = 1 - (r / d) * (r / d) * std::cos(tilt);
        EXPECT_NEAR(b.ambient_occlusion[0], irradiance, 1e-3);
        EXPECT_NEAR(b.transfer[0] * std::sqrt(4 * kPi), irradiance, 1e-3);
        // The same moments as the bent normal's.
        const glm::dvec3 bent =
            glm::normalize(kPi * glm::dvec3(0, 0, 1) - kPi * std::pow(std::sin(a), 2) * axis);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(b.bent_normal[k], bent[k], 1e-3);
    }
}

TEST(Bake, ALongWallHidesHalfOfWhatItsHeightSays) {
    const Mesh floor = make_floor();
    for (const double k : {0.3, 1.0, 4.0}) {
        const double d = 1.5;
        const Mesh wall = make_quad({d, -1e4, -0.5}, {0, 2e4, 0}, {0, 0, k * d + 0.5});
        const Bake b = bake(floor, {&wall}, 6, 65536);
        EXPECT_NEAR(b.ambient_occlusion[0], 1 - 0.5 * (1 - 1 / std::sqrt(1 + k * k)), 1e-3) << k;
    }
}

TEST(Bake, MoreRaysComeNearerToTheTruth) {
    const Mesh floor = make_floor();
    const Mesh ball = make_sphere(100, 1.0, {1.2, 0.3, 2});
    const Bake truth = bake(floor, {&ball}, 6, 262144);
    double before = 1;
    for (const int rays : {256, 4096, 65536}) {
        const Bake b = bake(floor, {&ball}, 6, rays);
        const double error = largest_difference(b.visibility.data(), truth.visibility);
        // 16 times the rays: at least the fourth of the error that random rays would have.
        EXPECT_LT(error, before / 3) << rays;
        before = error;
    }
    EXPECT_LT(before, 1e-3);
}

TEST(Bake, EveryMethodComesToTheSameForAnyThreads) {
    const Mesh floor = make_floor();
    const Mesh ball = make_sphere(100, 1.0, {1.2, 0.3, 2});
    const RayScene scene(floor, {&ball});
    const Bake truth = bake(floor, {&ball}, 6, 262144);
    for (const NamedMethod<BakeMethod>& each : kBakeMethods) {
        BakeOptions options;
        options.method = each.method;
        options.rays = 30000;
        if (each.method == BakeMethod::adaptive) options.tolerance = 5e-4;
        const Bake one = bake_mesh(floor, scene, options, kEverything);
        const double random = each.method == BakeMethod::random ? 6 : 1;
        EXPECT_LT(largest_difference(one.visibility.data(), truth.visibility), 2e-3 * random)
            << each.name;
        EXPECT_LT(largest_difference(one.transfer.data(), truth.transfer), 1e-3 * random)
            << each.name;
        EXPECT_FALSE(each.method != BakeMethod::fibonacci &&
                     same_bytes(one.transfer, bake(floor, {&ball}, 6, 30000).transfer));
        for (const int threads : {1, 3}) {
            const ThreadLimit limit(threads);
            EXPECT_TRUE(same_bytes(one, bake_mesh(floor, scene, options, kEverything)));
        }
    }
}

TEST(Bake, ByProductsAreThoseOfTheCoefficients) {
    const Mesh globe = [] {
        Mesh mesh = make_globe(12);
        add_normals(mesh);
        return mesh;
    }();
    const Mesh ball = make_sphere(20, 0.8, {0.5, 1.9, 0.2});
    const Bake b = bake(globe, {&ball}, 3, 2000);
    ASSERT_GT(b.report.blocked, 1000u);
    for (std::size_t v = 0; v < globe.positions.size(); ++v) {
        EXPECT_NEAR(b.ambient_occlusion[v], b.transfer[9 * v] * std::sqrt(4 * kPi), 2e-6);
        const float* const seen = &b.visibility[9 * v];
        const glm::dvec3 mean = glm::normalize(glm::dvec3(seen[3], seen[1], seen[2]));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(b.bent_normal[3 * v + k], mean[k], 1e-5);
    }
    // Order 1 has no degree 1 to take them from, and gives the same.
    const Bake one = bake(globe, {&ball}, 1, 2000);
    for (std::size_t i = 0; i < b.bent_normal.size(); ++i) {
        EXPECT_NEAR(b.bent_normal[i], one.bent_normal[i], 1e-5);
    }
}

TEST(Bake, BytesDoNotDependOnThreadsNorOnShards) {
    Mesh globe = make_globe(24);
    add_normals(globe);
    const Mesh ball = make_sphere(20, 0.8, {0.5, 1.9, 0.2});
    Bake one;
    {
        const ThreadLimit limit(1);
        one = bake(globe, {&ball}, 6, 300);
    }
    ASSERT_GT(one.report.blocked, 1000u);
    for (const int threads : {2, 3, 7}) {
        const ThreadLimit limit(threads);
        EXPECT_TRUE(same_bytes(one, bake(globe, {&ball}, 6, 300))) << threads;
    }
    const RayScene scene(globe, {&ball});
    const std::vector<std::uint32_t> order = morton_order(globe);
    BakeOptions options;
    options.rays = 300;
    for (const std::size_t shards : {2u, 5u}) {
        std::vector<float> rows(globe.positions.size() * 36);
        for (std::size_t i = 0; i < shards; ++i) {
            const std::size_t begin = order.size() * i / shards,
                              end = order.size() * (i + 1) / shards;
            BakeRows part;
            part.transfer = rows.data();
            bake_vertices(globe, scene, options, order.data() + begin, end - begin,
                          part.from(begin, options.order));
        }
        for (std::size_t k = 0; k < order.size(); ++k) {
            ASSERT_EQ(std::memcmp(&rows[36 * k], &one.transfer[36 * order[k]], 36 * sizeof(float)),
                      0);
        }
    }
}

TEST(Bake, UnitsAndPlacesDoNotMatter) {
    Mesh globe = make_globe(10);
    add_normals(globe);
    const Mesh ball = make_sphere(20, 0.8, {0.5, 1.9, 0.2});
    const Bake one = bake(globe, {&ball}, 4, 500);
    ASSERT_GT(one.report.blocked, 1000u);
    const auto in_units = [&](double unit, const glm::dvec3& place) {
        const auto move = [&](const glm::dvec3& p) { return unit * (p + place); };
        const Mesh a = moved(globe, move), b = moved(ball, move);
        return bake(a, {&b}, 4, 500);
    };
    for (const double unit : {0x1p-20, 0x1p20, 0x1p-300}) {
        EXPECT_TRUE(same_bytes(one, in_units(unit, glm::dvec3(0)))) << unit;
    }
    for (const double unit : {1e-6, 1e6, 1e19, 1e-30, 1e90}) {
        const Bake other = in_units(unit, {3e3, -5e3, 1e3});
        double sum = 0, size = 0;
        for (std::size_t i = 0; i < one.visibility.size(); ++i) {
            sum += std::pow(other.visibility[i] - one.visibility[i], 2);
            size += std::pow(one.visibility[i], 2);
        }
        // A few rays beside an edge change their minds, and lifts follow the coordinates'
        // precision.
        EXPECT_LT(std::sqrt(sum / size), 2e-3) << unit;
    }
}

TEST(Bake, DegenerateMeshesHaveRows) {
    const auto up = [](Mesh mesh) {
        mesh.normals.assign(mesh.positions.size(), glm::dvec3(0, 1, 0));
        return mesh;
    };
    EXPECT_EQ(bake(Mesh()).report.vertices, 0u);

    Mesh points;
    points.positions = {{0, 0, 0}, {1, 0, 0}, {0, 5, 0}};
    EXPECT_EQ(bake(up(points)).report.blocked, 0u);

    Mesh one = points;
    one.triangles = {{0, 1, 2}};
    add_normals(one);
    const Bake b = bake(one);
    EXPECT_EQ(b.report.blocked, 0u);
    EXPECT_EQ(b.ambient_occlusion, std::vector<float>(3, 1.0f));

    Mesh point = points;
    point.positions = {{1e19, 0, 0}, {1e19, 0, 0}, {1e19, 0, 0}};
    point.triangles = {{0, 1, 2}};
    EXPECT_EQ(bake(up(point)).report.blocked, 0u);

    // Triangles on top of each other and side by side, of both windings.
    Mesh flat;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    for (unsigned i = 0; i < 300; ++i) {
        flat.positions.emplace_back(place(random), 0.25, place(random));
        if (i % 3 == 2) flat.triangles.emplace_back(i, i - 1, i - 2);
        if (i % 6 == 2) flat.triangles.emplace_back(i - 2, i - 1, i);
    }
    EXPECT_EQ(bake(up(flat)).report.blocked, 0u);
    EXPECT_TRUE(all_finite(bake(flat = [&] {
        add_normals(flat);
        return flat;
    }())));
}

TEST(Bake, VerticesFarFromTheirMeshAreFinite) {
    Mesh mesh = make_sphere(6);
    const std::size_t before = mesh.positions.size();
    mesh.positions.insert(mesh.positions.end(),
                          {{1e19, 0, 0}, {0, -1e100, 1e100}, {0, 0, 3}, {0, 0, 0}});
    mesh.normals.insert(mesh.normals.end(), {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}});
    const Bake b = bake(mesh, {}, 6, 4096);
    EXPECT_TRUE(all_finite(b));
    // The mesh does not see the far ones, which are isolated, nor they it.
    for (std::size_t v = 0; v < before + 2; ++v) EXPECT_EQ(b.ambient_occlusion[v], 1.0f);
    EXPECT_NEAR(b.ambient_occlusion[before + 2], 1 - 1.0 / 9, 5e-3);
    EXPECT_NEAR(b.ambient_occlusion[before + 3], 0, 1e-6);

    // Within one mesh, what is small beside it becomes a point and stays finite.
    Mesh wide = make_sphere(6);
    wide.positions[0] = {1e19, 0, 0};
    EXPECT_TRUE(all_finite(bake(wide)));
}

TEST(Bake, TheGroundHidesTheLowerHalf) {
    Mesh box = make_box(1);
    RaySceneOptions options;
    options.ground_height = -1;
    box.normals.assign(box.positions.size(), glm::dvec3(0, 1, 0));
    box.normals[0] = {0, -1, 0};
    box.positions.push_back({0, 4, 0});
    box.normals.push_back({1, 0, 0});
    box.positions.push_back({0, 4, 0});
    box.normals.push_back({0, -1, 0});
    const Bake b = bake(box, {}, 6, 65536, options);
    // A vertex on the ground that looks down is dark, on a wall half of its light is gone.
    EXPECT_NEAR(b.ambient_occlusion[box.positions[0].y < 0 ? 0 : 1], 0, 1e-3);
    EXPECT_NEAR(b.ambient_occlusion[8], 0.5, 1e-3);
    EXPECT_NEAR(b.ambient_occlusion[9], 0, 1e-3);
}

TEST(Bake, OptionsAndNormalsOutsideTheirDomainAreRefused) {
    Mesh mesh = make_box(1);
    const RayScene scene(mesh);
    const std::uint32_t beyond = 8;
    const auto code = [&](int order, int rays) {
        try {
            BakeOptions options;
            options.order = order;
            options.rays = rays;
            bake_mesh(mesh, scene, options);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::io;
    };
    EXPECT_EQ(code(0, 64), ErrorCode::usage);
    EXPECT_EQ(code(11, 64), ErrorCode::usage);
    EXPECT_EQ(code(6, 0), ErrorCode::usage);
    EXPECT_EQ(code(6, kLargestBakeRays + 1), ErrorCode::usage);
    EXPECT_THROW(bake_vertices(mesh, scene, {}, &beyond, 1, {}), Error);
    EXPECT_THROW(bake_mesh(mesh, scene, {}, {}, 100), Error);
    mesh.normals[2] *= 1.1;
    EXPECT_EQ(code(6, 64), ErrorCode::data);
    mesh.normals[2].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(code(6, 64), ErrorCode::data);
    mesh.normals.pop_back();
    EXPECT_EQ(code(6, 64), ErrorCode::data);
}

TEST(Hemisphere, FibonacciPointsAreUnitEvenAndAbove) {
    for (const std::size_t count : {1u, 7u, 1024u}) {
        const HemisphereDirections d = fibonacci_hemisphere(count);
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 v(d.x[i], d.y[i], d.z[i]);
            EXPECT_NEAR(glm::length(v), 1, 2e-7);
            EXPECT_GT(v.z, 0);
            sum += v / double(count);
        }
        EXPECT_NEAR(sum.z, 0.5, 1e-6);
        EXPECT_LT(std::hypot(sum.x, sum.y), 1.0 / std::sqrt(double(count)));
    }
}

TEST(Hemisphere, FramesAreRotationsAndDifferBetweenVertices) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    double sine = 0, cosine = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const glm::dvec3 n =
            i < 3 ? glm::dvec3(i == 0, i == 1, i == 2)
                  : glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dmat3 f = vertex_frame(n, i);
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) EXPECT_NEAR(glm::dot(f[a], f[b]), a == b, 1e-14);
        }
        EXPECT_GT(glm::determinant(f), 0);
        EXPECT_EQ(f[2], n);
        const glm::dmat3 g = vertex_frame({0, 0, 1}, i);
        sine += g[0].y;
        cosine += g[0].x;
    }
    // Turns of 2000 vertices are spread over the circle.
    EXPECT_LT(std::hypot(sine, cosine), 3 * std::sqrt(2000.0));
}

TEST(Morton, OrderVisitsEveryVertexAndKeepsNeighboursTogether) {
    const Mesh box = make_box(16);
    const std::vector<std::uint32_t> order = morton_order(box);
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    double along = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        ASSERT_EQ(sorted[k], k);
        if (k > 0) along += glm::distance(box.positions[order[k]], box.positions[order[k - 1]]);
    }
    // Steps of the grid are 0.125; vertices taken at random would be 1.3 apart.
    EXPECT_LT(along / double(order.size()), 0.3);
    EXPECT_TRUE(morton_order(Mesh()).empty());
    Mesh same;
    same.positions.assign(5, glm::dvec3(1e19));
    EXPECT_EQ(morton_order(same), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace airlight
