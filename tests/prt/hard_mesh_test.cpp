// SPDX-License-Identifier: Apache-2.0
// Bakes of meshes that break bakers: what they give is pinned here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "core/threads.h"
#include "prt/bake_scene.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

constexpr BakeKinds kEverything = {true, true, true, true, true};

Bake bake(const Mesh& mesh, const std::vector<const Mesh*>& occluders = {}, int rays = 400,
          int bounces = 0) {
    BakeScene scene;
    scene.meshes = {&mesh};
    scene.meshes.insert(scene.meshes.end(), occluders.begin(), occluders.end());
    scene.albedos.assign(scene.meshes.size(), 0.5);
    BakeOptions options;
    options.order = 4;
    options.rays = rays;
    return bake_scene(scene, options, bounces, kEverything);
}

bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

bool same_bytes(const Bake& a, const Bake& b) {
    return same_bytes(a.visibility, b.visibility) && same_bytes(a.transfer, b.transfer) &&
           same_bytes(a.unshadowed_transfer, b.unshadowed_transfer) &&
           same_bytes(a.ambient_occlusion, b.ambient_occlusion) &&
           same_bytes(a.bent_normal, b.bent_normal);
}

double relative_rms(const std::vector<float>& values, const std::vector<float>& truth) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        error += std::pow(double(values.at(i)) - truth[i], 2);
        size += std::pow(double(truth[i]), 2);
    }
    return std::sqrt(error / size);
}

/// Closed, with hollows: a sixth of its rays are blocked.
Mesh make_star(unsigned steps = 16) {
    Mesh mesh = moved(make_sphere(steps), [](const glm::dvec3& p) {
        return (1 + 0.3 * std::sin(5 * p.x) * std::sin(5 * p.y) * std::sin(5 * p.z)) * p;
    });
    add_normals(mesh);
    return mesh;
}

Mesh with_winding_turned(Mesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    return mesh;
}

/// The vertices and triangles of both.
Mesh joined(Mesh a, const Mesh& b) {
    const auto base = static_cast<unsigned>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(base + t);
    return a;
}

TEST(HardMesh, UnitsOfAMillionthAndOfAMillionGiveTheSame) {
    const Mesh star = make_star();
    for (const int bounces : {0, 2}) {
        const Bake one = bake(star, {}, 400, bounces);
        ASSERT_GT(one.report.blocked, one.report.rays / 20);
        for (const double unit : {1e-6, 1e6, 1e19, 1e-19}) {
            const Bake other =
                bake(moved(star, [&](const glm::dvec3& p) { return unit * p; }), {}, 400, bounces);
            // Coordinates round differently where the unit is no power of two: 0 or 1 of 0.6
            // million rays changes, and the error is up to 6e-5.
            EXPECT_LT(relative_rms(other.transfer, one.transfer), 2e-4) << unit;
            EXPECT_LE(std::abs(double(other.report.blocked) - double(one.report.blocked)), 6);
        }
    }
}

TEST(HardMesh, RepeatedTrianglesChangeNothing) {
    const Mesh star = make_star();
    Mesh twice = star;
    for (const glm::uvec3& t : star.triangles) twice.triangles.emplace_back(t.y, t.z, t.x);
    EXPECT_TRUE(same_bytes(bake(star), bake(twice)));
    // Corners that run on give the same point of the triangle, to rounding.
    const Bake a = bake(star, {}, 400, 1), b = bake(twice, {}, 400, 1);
    for (std::size_t i = 0; i < a.transfer.size(); ++i) {
        ASSERT_NEAR(a.transfer[i], b.transfer[i], 1e-6);
    }
}

TEST(HardMesh, TrianglesWithoutAreaChangeNothing) {
    const Mesh star = make_star();
    Mesh more = star;
    for (unsigned i = 0; i + 2 < star.positions.size(); i += 3) {
        // A point, a line that runs back, and a needle along an edge.
        const auto base = static_cast<unsigned>(more.positions.size());
        const glm::dvec3 p = star.positions[i];
        more.positions.insert(more.positions.end(), {p, p, p, p, 0.7 * p, 0.4 * p});
        more.triangles.emplace_back(base, base + 1, base + 2);
        more.triangles.emplace_back(base + 3, base + 4, base + 5);
        const glm::uvec3& t = star.triangles[i];
        more.positions.push_back(0.5 * (star.positions[t.x] + star.positions[t.y]));
        more.triangles.emplace_back(t.x, t.y, base + 6);
    }
    add_normals(more);
    for (std::size_t v = 0; v < star.positions.size(); ++v) {
        EXPECT_NEAR(glm::distance(more.normals[v], star.normals[v]), 0, 1e-12);
    }
    // The same directions, since these follow from the number of the vertex. Once rounded, needles
    // stop a few rays beside their edges.
    Bake with = bake(more);
    with.transfer.resize(16 * star.positions.size());
    EXPECT_LT(relative_rms(with.transfer, bake(star).transfer), 5e-4);
}

TEST(HardMesh, NormalsDecideTheSideAndWindingOnlyWhoReflects) {
    const Mesh star = make_star();
    const Mesh turned = with_winding_turned(star);
    EXPECT_TRUE(same_bytes(bake(star), bake(turned)));
    // All that its vertices meet are backs now.
    EXPECT_EQ(bake(turned).transfer, bake(turned, {}, 400, 2).transfer);
    EXPECT_NE(bake(star).transfer, bake(star, {}, 400, 2).transfer);

    Mesh inside = turned;
    add_normals(inside);
    const Bake dark = bake(inside);
    EXPECT_EQ(dark.report.blocked, dark.report.rays);
    EXPECT_EQ(dark.report.mostly_blocked, inside.positions.size());
    for (const float value : dark.ambient_occlusion) EXPECT_NEAR(value, 0, 1e-6);
    for (std::size_t v = 0; v < inside.positions.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_FLOAT_EQ(dark.bent_normal[3 * v + k], float(inside.normals[v][k]));
        }
    }
    // A floor whose normals point down sees what is under it.
    Mesh floor = make_floor();
    for (glm::dvec3& n : floor.normals) n = -n;
    const Mesh cellar = make_quad({-50, -50, -0.1}, {100, 0, 0}, {0, 100, 0});
    const Mesh roof = make_quad({-50, -50, 0.1}, {100, 0, 0}, {0, 100, 0});
    EXPECT_EQ(bake(floor, {&roof}).report.blocked, 0u);
    EXPECT_LT(bake(floor, {&cellar}).ambient_occlusion[0], 1e-2f);
}

// Paper, leaves and cloth: a sheet and its back at the same place.
TEST(HardMesh, CoincidentSheetsDoNotShadowEachOther) {
    const Mesh front = make_floor();
    Mesh back = with_winding_turned(front);
    add_normals(back);
    const Bake both = bake(joined(front, back));
    EXPECT_EQ(both.report.blocked, 0u);
    for (const float value : both.ambient_occlusion) EXPECT_EQ(value, 1.0f);
    // As another mesh, too.
    EXPECT_EQ(bake(front, {&front, &back}).report.blocked, 0u);
    // A little above it hides what it should; nearer than the lift it is missed.
    for (const bool beyond : {false, true}) {
        const double height = 1e-5 * 2 * std::sqrt(2.0) * (beyond ? 1.5 : 0.5);
        const Mesh above =
            moved(front, [&](const glm::dvec3& p) { return p + glm::dvec3(0, 0, height); });
        EXPECT_NEAR(bake(front, {&above}).ambient_occlusion[0], beyond ? 0 : 1, 1e-3);
    }
}

// Which of two coincident triangles a ray meets is up to Embree, but it is the same one each time.
TEST(HardMesh, CoincidentReflectorsGiveTheSameBytesForAnyThreads) {
    const Mesh ball = make_sphere(40);
    const auto first_copy = 4 * ball.positions.size();
    Mesh room = with_winding_turned(make_sphere(8, 3));
    add_normals(room);
    for (const bool opposite : {false, true}) {
        const Mesh both = joined(ball, opposite ? with_winding_turned(ball) : ball);
        std::vector<float> sent(4 * both.positions.size());
        std::fill_n(sent.begin(), first_copy, 1.0f);
        BakeOptions options;
        options.order = 2;
        options.rays = 256;
        std::vector<float> one;
        for (const int threads : {1, 2, 7}) {
            const ThreadLimit limit(threads);
            const Bake b = bake_mesh(room, RayScene(room, {&both}), options, {}, kDefaultMaxMemory,
                                     {{}, {&both, 1, sent.data()}});
            if (one.empty()) one = b.transfer;
            EXPECT_TRUE(same_bytes(one, b.transfer)) << threads;
        }
    }
}

TEST(HardMesh, FacesThatDisagreeAtAVertexGiveFiniteRows) {
    // A strip of squares, every other turned over; a bow tie; three faces on one edge; a cone whose
    // normals cancel at the tip.
    Mesh strip;
    for (unsigned i = 0; i <= 10; ++i) {
        strip.positions.emplace_back(i, 0, 0);
        strip.positions.emplace_back(i, 1, std::sin(i));
        if (i == 0) continue;
        const unsigned a = 2 * i;
        strip.triangles.emplace_back(a - 2, i % 2 ? a - 1 : a, i % 2 ? a : a - 1);
        strip.triangles.emplace_back(a, i % 2 ? a - 1 : a + 1, i % 2 ? a + 1 : a - 1);
    }
    Mesh tie;
    tie.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    tie.triangles = {{0, 1, 2}, {0, 4, 3}, {0, 1, 5}, {1, 0, 4}};
    Mesh fold;
    fold.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
    fold.triangles = {{0, 1, 2}, {1, 0, 3}};
    for (Mesh* mesh : {&strip, &tie, &fold}) {
        add_normals(*mesh);
        const Bake b = bake(*mesh, {}, 400, 2);
        for (const auto* values : {&b.visibility, &b.transfer, &b.unshadowed_transfer,
                                   &b.ambient_occlusion, &b.bent_normal}) {
            for (const float value : *values) ASSERT_TRUE(std::isfinite(value));
        }
        for (const float value : b.ambient_occlusion) {
            EXPECT_GE(value, 0);
            EXPECT_LE(value, 1);
        }
        for (std::size_t v = 0; v < mesh->positions.size(); ++v) {
            const float* const bent = &b.bent_normal[3 * v];
            EXPECT_NEAR(bent[0] * bent[0] + bent[1] * bent[1] + bent[2] * bent[2], 1, 1e-5);
            // What a mesh of albedo 1/2 sends back, it received.
            EXPECT_LE(b.transfer[16 * v] * std::sqrt(4 * 3.14159265358979), 1 + 1e-5);
        }
    }
}

}  // namespace
}  // namespace airlight
