// SPDX-License-Identifier: Apache-2.0
// The adaptive method of prt/bake.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "prt/bake.h"
#include "prt/bake_scene.h"
#include "prt/morton.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/zonal.h"
#include "tests/prt/mesh_files.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

BakeOptions adaptive(double tolerance, int order = 6) {
    BakeOptions options;
    options.order = order;
    options.method = BakeMethod::adaptive;
    options.rays = kAdaptiveBakeRays;
    options.tolerance = tolerance;
    return options;
}

struct Baked {
    std::vector<float> visibility, transfer, seen_error, sent_error;
    std::vector<std::uint32_t> rays;
    BakeReport report;
};

Baked bake(const Mesh& mesh, const RayScene& scene, const BakeOptions& options,
           const std::vector<std::uint32_t>& vertices) {
    const std::size_t size = sh_count(options.order) * vertices.size();
    Baked baked;
    baked.visibility.resize(size);
    baked.transfer.resize(size);
    baked.seen_error.resize(vertices.size());
    baked.sent_error.resize(vertices.size());
    baked.rays.resize(vertices.size());
    BakeRows rows;
    rows.visibility = baked.visibility.data();
    rows.transfer = baked.transfer.data();
    if (options.method == BakeMethod::adaptive) {
        rows.visibility_error = baked.seen_error.data();
        rows.transfer_error = baked.sent_error.data();
    }
    rows.ray_count = baked.rays.data();
    baked.report = bake_vertices(mesh, scene, options, vertices.data(), vertices.size(), rows);
    return baked;
}

/// A sphere with ridges that hide each other.
Mesh ridged_sphere() {
    Mesh mesh = moved(make_sphere(40), [](const glm::dvec3& p) {
        return (1 + 0.15 * std::sin(7 * p.x) * std::sin(8 * p.y + 1) * std::cos(6 * p.z)) * p;
    });
    add_normals(mesh);
    return mesh;
}

Mesh floor_of(unsigned steps) {
    Mesh mesh;
    for (unsigned i = 0; i <= steps; ++i) {
        for (unsigned j = 0; j <= steps; ++j) {
            mesh.positions.emplace_back(2.0 * i / steps - 1, 2.0 * j / steps - 1, 0);
        }
    }
    for (unsigned i = 0; i < steps; ++i) {
        for (unsigned j = 0; j < steps; ++j) {
            const unsigned a = i * (steps + 1) + j;
            mesh.triangles.emplace_back(a, a + steps + 1, a + steps + 2);
            mesh.triangles.emplace_back(a, a + steps + 2, a + 1);
        }
    }
    add_normals(mesh);
    return mesh;
}

/// Blades over the floor, `width` wide.
Mesh blades(int count, double width) {
    Mesh mesh;
    std::mt19937 random(3);
    const auto unit = [&] { return std::ldexp(double(random()), -32); };
    for (int k = 0; k < count; ++k) {
        const double x = 2 * unit() - 1, y = 2 * unit() - 1, turn = 2 * kPi * unit();
        const glm::dvec3 across = 0.5 * width * glm::dvec3(std::cos(turn), std::sin(turn), 0);
        const glm::dvec3 foot(x, y, 0.01);
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.push_back(foot - across);
        mesh.positions.push_back(foot + across);
        mesh.positions.push_back({x + 0.1 * unit(), y + 0.1 * unit(), 0.2 + 0.3 * unit()});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

Mesh boxes() {
    Mesh mesh;
    std::mt19937 random(11);
    const auto unit = [&] { return std::ldexp(double(random()), -32); };
    for (int k = 0; k < 12; ++k) {
        const glm::dvec3 centre(2 * unit() - 1, 2 * unit() - 1, 0.1 + 0.5 * unit());
        const double size = 0.08 + 0.15 * unit();
        const Mesh box = moved(make_box(1), [&](const glm::dvec3& p) { return centre + size * p; });
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), box.positions.begin(), box.positions.end());
        for (const glm::uvec3& t : box.triangles) mesh.triangles.push_back(t + glm::uvec3(first));
    }
    return mesh;
}

std::vector<std::uint32_t> some_of(const Mesh& mesh, std::size_t count) {
    std::vector<std::uint32_t> all = morton_order(mesh), some;
    for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
    return some;
}

struct Trust {
    double rms_error = 0, rms_estimate = 0;
    double over = 0, over_twice = 0;  ///< share of vertices
};

Trust compare(const std::vector<float>& rows, const std::vector<float>& truth,
              const std::vector<float>& estimates, double open) {
    const std::size_t count = estimates.size(), size = rows.size() / count;
    Trust trust;
    for (std::size_t k = 0; k < count; ++k) {
        double square = 0;
        for (std::size_t i = k * size; i < (k + 1) * size; ++i) {
            square += std::pow(double(rows[i]) - double(truth[i]), 2);
        }
        const double error = std::sqrt(square) / open, estimate = double(estimates[k]);
        trust.rms_error += error * error / double(count);
        trust.rms_estimate += estimate * estimate / double(count);
        trust.over += (error > estimate ? 1.0 : 0.0) / double(count);
        trust.over_twice += (error > 2 * estimate ? 1.0 : 0.0) / double(count);
    }
    trust.rms_error = std::sqrt(trust.rms_error);
    trust.rms_estimate = std::sqrt(trust.rms_estimate);
    return trust;
}

double open_norm(double exponent) {
    double square = 0;
    for (const double c : zonal_coefficients(phong_eigenvalues(exponent, 6))) square += c * c;
    return std::sqrt(square) / (exponent == 1 ? kPi : 1);
}

class AdaptiveTrust : public testing::Test {
  protected:
    // Against 65536 rays, whose own error is 3e-4. Measured on five scanned and modelled meshes at
    // tolerances of 1e-2 to 5e-4: 0 to 4 % of vertices over twice their estimate, estimates of 1.0
    // to 1.9 times the error; with things thinner than cells, 0.6 to 1.2 times and up to 11 %.
    void expect_trust(const Mesh& mesh, const std::vector<const Mesh*>& occluders, double tolerance,
                      double largest_share_over_twice, double least, double most) {
        const RayScene scene(mesh, occluders);
        const std::vector<std::uint32_t> vertices = some_of(mesh, 120);
        BakeOptions exact;
        exact.rays = 65536;
        const Baked truth = bake(mesh, scene, exact, vertices);
        const Baked baked = bake(mesh, scene, adaptive(tolerance), vertices);
        const Trust seen =
            compare(baked.visibility, truth.visibility, baked.seen_error, open_norm(0));
        const Trust sent = compare(baked.transfer, truth.transfer, baked.sent_error, open_norm(1));
        for (const Trust& trust : {seen, sent}) {
            EXPECT_LE(trust.over_twice, largest_share_over_twice);
            EXPECT_GT(trust.rms_estimate, least * trust.rms_error);
            EXPECT_LT(trust.rms_estimate, most * trust.rms_error);
            RecordProperty("rms_error", std::to_string(trust.rms_error));
        }
        seen_ = seen;
        sent_ = sent;
        report_ = baked.report;
    }

    Trust seen_, sent_;
    BakeReport report_;
};

TEST_F(AdaptiveTrust, OfRidgesThatHideEachOther) {
    const Mesh mesh = ridged_sphere();
    for (const double tolerance : {3e-3, 1e-3}) {
        expect_trust(mesh, {}, tolerance, 0.05, 1, 2);
        EXPECT_LT(seen_.rms_error, tolerance);
        EXPECT_LT(sent_.rms_error, tolerance);
        // A fixed number of rays needs some 4000 and 16000 for the same (prt/bake.h).
        EXPECT_LT(report_.rays / report_.vertices, tolerance > 2e-3 ? 1500u : 4000u);
    }
}

TEST_F(AdaptiveTrust, OfBoxesOverAFloor) {
    const Mesh mesh = floor_of(10), over = boxes();
    expect_trust(mesh, {&over}, 2e-3, 0.08, 0.6, 2);
    EXPECT_LT(std::max(seen_.rms_error, sent_.rms_error), 2e-3);
}

TEST_F(AdaptiveTrust, OfAThicketIsHonestWhereNothingIsMet) {
    // Blades are a tenth of the cells that the rays allowed make.
    const Mesh mesh = floor_of(10), over = blades(1000, 0.008);
    expect_trust(mesh, {&over}, 1e-3, 0.3, 0.7, 2);
    EXPECT_GT(seen_.rms_estimate, 2e-3);
}

TEST(AdaptiveBake, RowsDoNotDependOnThreadsNorOnNeighbours) {
    const Mesh mesh = ridged_sphere();
    const RayScene scene(mesh);
    const std::vector<std::uint32_t> vertices = some_of(mesh, 300);
    Baked one;
    {
        const ThreadLimit limit(1);
        one = bake(mesh, scene, adaptive(3e-3), vertices);
    }
    for (const int threads : {2, 5}) {
        const ThreadLimit limit(threads);
        const Baked other = bake(mesh, scene, adaptive(3e-3), vertices);
        EXPECT_EQ(one.visibility, other.visibility);
        EXPECT_EQ(one.transfer, other.transfer);
        EXPECT_EQ(one.seen_error, other.seen_error);
        EXPECT_EQ(one.rays, other.rays);
    }
    for (std::size_t k = 0; k < vertices.size(); k += 37) {
        const Baked alone = bake(mesh, scene, adaptive(3e-3), {vertices[k]});
        EXPECT_EQ(alone.rays[0], one.rays[k]);
        EXPECT_EQ(
            std::memcmp(alone.transfer.data(), one.transfer.data() + 36 * k, 36 * sizeof(float)),
            0);
    }
    std::uint64_t rays = 0;
    for (const std::uint32_t count : one.rays) rays += count;
    EXPECT_EQ(one.report.rays, rays);
    EXPECT_LT(*std::min_element(one.rays.begin(), one.rays.end()),
              *std::max_element(one.rays.begin(), one.rays.end()));
}

TEST(AdaptiveBake, AllKindsComeFromTheSameRays) {
    const Mesh mesh = floor_of(6), over = boxes();
    const RayScene scene(mesh, {&over});
    const BakeKinds kinds = {true, true, true, true, true};
    BakeOptions exact;
    exact.rays = 65536;
    const Bake truth = bake_mesh(mesh, scene, exact, kinds);
    const Bake b = bake_mesh(mesh, scene, adaptive(1e-3), kinds);
    EXPECT_EQ(b.unshadowed_transfer, truth.unshadowed_transfer);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(b.ambient_occlusion[v], truth.ambient_occlusion[v], 2e-3);
        EXPECT_NEAR(b.ambient_occlusion[v], b.transfer[36 * v] * std::sqrt(4 * kPi), 2e-6);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(b.bent_normal[3 * v + axis], truth.bent_normal[3 * v + axis], 6e-3);
        }
    }
    // The by-products alone take the rays of the kind that they are moments of.
    const Bake alone = bake_mesh(mesh, scene, adaptive(1e-3), {false, false, false, true, false});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(alone.ambient_occlusion[v], truth.ambient_occlusion[v], 3e-3);
    }
}

TEST(AdaptiveBake, LightBouncesAtTheBlockedPoints) {
    const Mesh floor = floor_of(6), ball = make_sphere(8, 0.3, {0.2, 0.1, 0.5});
    BakeScene scene;
    scene.meshes = {&floor, &ball};
    scene.albedos = {0.6, 0.8};
    BakeOptions exact;
    exact.rays = 32768;
    const Bake truth = bake_scene(scene, exact, 2), before = bake_scene(scene, exact, 0);
    const Bake b = bake_scene(scene, adaptive(1e-3), 2);
    double error = 0, bounced = 0;
    for (std::size_t i = 0; i < truth.transfer.size(); ++i) {
        error += std::pow(double(b.transfer[i]) - double(truth.transfer[i]), 2);
        bounced += std::pow(double(truth.transfer[i]) - double(before.transfer[i]), 2);
    }
    const double vertices = static_cast<double>(floor.positions.size());
    EXPECT_LT(std::sqrt(error / vertices) / open_norm(1), 1e-3);
    EXPECT_GT(std::sqrt(bounced / vertices) / open_norm(1), 1e-2);
}

TEST(AdaptiveBake, WhatItCannotDoIsRefused) {
    const Mesh floor = make_floor();
    const RayScene scene(floor);
    const auto refused = [&](const BakeOptions& options, const char* text) {
        try {
            bake_mesh(floor, scene, options);
            FAIL() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::usage);
            EXPECT_NE(error.describe().find(text), std::string::npos) << error.describe();
        }
    };
    refused(adaptive(0), "the tolerance of the adaptive method must be 1e-06 to 1, got 0");
    refused(adaptive(2), "got 2");
    refused(adaptive(std::nan("")), "got nan");
    BakeOptions options = adaptive(1e-3);
    options.rays = 63;
    refused(options, "takes 64 rays per vertex or more, got 63");
    options.method = BakeMethod::fibonacci;
    refused(options, "the method fibonacci takes no tolerance");
    options.tolerance = 0;
    std::vector<float> errors(floor.positions.size());
    const std::uint32_t vertex = 0;
    BakeRows rows;
    rows.transfer_error = errors.data();
    EXPECT_THROW(bake_vertices(floor, scene, options, &vertex, 1, rows), Error);
}

}  // namespace
}  // namespace airlight
