// SPDX-License-Identifier: Apache-2.0
#include "prt/ray_scene.h"

#include <emmintrin.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/error.h"
#include "prt/bake.h"
#include "prt/hemisphere.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

struct Rays {
    std::vector<float> x, y, z;
    explicit Rays(std::size_t count, unsigned seed = 1) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 d =
                glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            x.push_back(static_cast<float>(d.x));
            y.push_back(static_cast<float>(d.y));
            z.push_back(static_cast<float>(d.z));
        }
    }
    std::vector<std::uint32_t> blocked(const RayScene& scene, const glm::vec3& origin) const {
        std::vector<std::uint32_t> hits(x.size());
        hits.resize(scene.find_blocked(origin, glm::mat3(1), x.size(), x.data(), y.data(), z.data(),
                                       hits.data()));
        return hits;
    }
};

std::uint64_t count_blocked(const Mesh& mesh, int rays) {
    const RayScene scene(mesh);
    BakeOptions options;
    options.order = 1;
    options.rays = rays;
    BakeKinds kinds;
    return bake_mesh(mesh, scene, options, kinds).report.blocked;
}

// How far beyond the triangle, in units of its size, a ray from p to d passes; negative inside.
double signed_miss(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& a,
                   const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 e = b - a, f = c - a, q = glm::cross(d, f);
    const double det = glm::dot(e, q);
    const glm::dvec3 s = p - a, r = glm::cross(s, e);
    const double u = glm::dot(s, q) / det, v = glm::dot(d, r) / det, t = glm::dot(f, r) / det;
    return std::max({-u, -v, u + v - 1, -t});
}

std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(RayScene, AgreesWithIntersectionsInDouble) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1, 1);
    Mesh soup;
    for (unsigned i = 0; i < 60; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random));
        for (int corner = 0; corner < 3; ++corner) {
            soup.positions.push_back(at +
                                     0.4 * glm::dvec3(place(random), place(random), place(random)));
        }
        soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const Mesh moved_soup =
        moved(soup, [](const glm::dvec3& p) { return 3.0 * p + glm::dvec3(1e5, -2e5, 3e5); });
    const RayScene scene(moved_soup);
    const Rays rays(20000);
    const glm::dvec3 from(0.1, 0.2, -0.1);
    const glm::dvec3 world = 3.0 * from + glm::dvec3(1e5, -2e5, 3e5);
    const std::vector<std::uint32_t> hits =
        rays.blocked(scene, scene.origin(world, glm::dvec3(0, 0, 0)));
    std::vector<char> blocked(rays.x.size(), 0);
    for (const std::uint32_t i : hits) blocked[i] = 1;
    std::size_t clear = 0, wrong = 0;
    for (std::size_t i = 0; i < rays.x.size(); ++i) {
        double miss = 1e30;
        for (const glm::uvec3& t : soup.triangles) {
            miss = std::min(
                miss, signed_miss(from, {rays.x[i], rays.y[i], rays.z[i]}, soup.positions[t.x],
                                  soup.positions[t.y], soup.positions[t.z]));
        }
        // Beside an edge the rounding of Embree's coordinates decides.
        if (std::abs(miss) < 1e-4) continue;
        ++clear;
        wrong += (miss < 0) != (blocked[i] == 1);
    }
    EXPECT_GT(clear, 19000u);
    EXPECT_GT(hits.size(), 4000u);
    EXPECT_EQ(wrong, 0u);
}

TEST(RayScene, NothingConvexShadowsItself) {
    const glm::dmat3 turn = vertex_frame(glm::normalize(glm::dvec3(1, 2, -3)), 5);
    struct Shape {
        Mesh mesh;
        int rays;
    };
    // Far from the origin the rounding of the fine sphere and of the faces askew makes dents that
    // are deeper than the surface is curved.
    const Shape shapes[] = {{make_sphere(24), 512},
                            {make_sphere(50), 128},
                            {make_box(16), 256},
                            {make_box(1), 512},
                            {make_cube(20, [&](const glm::dvec3& p) { return turn * p; }), 256},
                            {make_cube(20,
                                       [](const glm::dvec3& p) {
                                           const glm::dvec3 q = glm::normalize(p);
                                           return glm::dvec3(q.x, 0.3 * q.y, 5 * q.z);
                                       }),
                             256}};
    const glm::dvec3 places[] = {{0, 0, 0}, {-1e4, 3e3, 1e4}, {100, -1e3, 10}};
    for (std::size_t s = 0; s < std::size(shapes); ++s) {
        for (const glm::dvec3& place : places) {
            for (const bool rounded : {false, true}) {
                Mesh mesh = moved(shapes[s].mesh, [&](const glm::dvec3& p) {
                    const glm::dvec3 q = p + place;
                    if (!rounded) return q;
                    const volatile float x = static_cast<float>(q.x), y = static_cast<float>(q.y),
                                         z = static_cast<float>(q.z);
                    return glm::dvec3(x, y, z);
                });
                add_normals(mesh);
                EXPECT_EQ(count_blocked(mesh, shapes[s].rays), 0u)
                    << "shape " << s << " at " << place.x << (rounded ? ", floats" : ", doubles");
            }
        }
    }
}

TEST(RayScene, TheLiftFollowsThePrecisionOfThePositions) {
    const auto lift_at = [](const glm::dvec3& place) {
        const Mesh mesh = moved(make_box(2), [&](const glm::dvec3& p) { return p + place; });
        return RayScene(mesh).lift(mesh.positions[0]);
    };
    const double diagonal = 2 * std::sqrt(3.0);
    EXPECT_NEAR(lift_at({0, 0, 0}), 1e-5 * diagonal, 1e-12);
    // 8 float ulps of 8192; in double, of no account.
    EXPECT_NEAR(lift_at({8191, 0, 0}), 8 * 0x1p-23 * 8190, 2e-5);
    EXPECT_NEAR(lift_at({8191 + 0x1p-30, 0, 0}), 1e-5 * diagonal, 1e-12);
    // Never more than a small part of the mesh.
    EXPECT_NEAR(lift_at({0x1p22, 0, 0}), 4e-3 * diagonal, 1e-9);
}

TEST(RayScene, RaysThatAreNotFiniteAreRefused) {
    const Mesh mesh = make_sphere(4);
    const RayScene scene(mesh);
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        for (int place = 0; place < 3; ++place) {
            for (const std::size_t at : {0u, 255u, 256u, 299u}) {
                Rays rays(300);
                (place == 0 ? rays.x : place == 1 ? rays.y : rays.z)[at] = bad;
                EXPECT_THROW(rays.blocked(scene, glm::vec3(0)), Error);
            }
            glm::vec3 origin(0);
            origin[place] = bad;
            EXPECT_THROW(Rays(2).blocked(scene, origin), Error);
        }
    }
    // The frame counts, too.
    const Rays rays(3);
    std::vector<std::uint32_t> hits(3);
    glm::mat3 frame(1);
    frame[1][2] = kNan;
    EXPECT_THROW(scene.find_blocked(glm::vec3(0), frame, 3, rays.x.data(), rays.y.data(),
                                    rays.z.data(), hits.data()),
                 Error);
    // What is finite reaches Embree and comes back.
    Rays odd(6);
    odd.x = {0, 1e-45f, 3e38f, -3e38f, 1e-38f, 0};
    odd.y = {0, 0, 3e38f, 0, 1e-38f, -1e-45f};
    odd.z = {0, 0, 3e38f, 1, 0, 0};
    for (const float far : {0.0f, 1e-45f, 1e15f, -1e15f}) {
        EXPECT_LE(odd.blocked(scene, glm::vec3(far)).size(), 6u);
    }
}

TEST(RayScene, TheAnswerForARayDoesNotDependOnTheOthers) {
    const Mesh mesh = make_sphere(12);
    const Mesh other = make_sphere(9, 0.5, {0, 0, 3});
    const RayScene scene(mesh, {&other});
    const Rays rays(1500);
    const glm::vec3 origin = scene.origin({0.1, 0.3, 1.2}, {0, 0, 1});
    const std::vector<std::uint32_t> together = rays.blocked(scene, origin);
    std::vector<std::uint32_t> alone;
    for (std::uint32_t i = 0; i < rays.x.size(); ++i) {
        std::uint32_t hit = 0;
        if (scene.find_blocked(origin, glm::mat3(1), 1, &rays.x[i], &rays.y[i], &rays.z[i], &hit) ==
            1) {
            alone.push_back(i);
        }
    }
    EXPECT_GT(together.size(), 100u);
    EXPECT_EQ(together, alone);
}

TEST(RayScene, TheFrameTurnsDirections) {
    const Mesh other = make_sphere(9, 0.5, {0, 0, 3});
    const Mesh mesh = make_sphere(4);
    const RayScene scene(mesh, {&other});
    const Rays rays(1023);
    const glm::mat3 frame(vertex_frame(glm::normalize(glm::dvec3(1, -2, 0.5)), 7));
    Rays turned = rays;
    for (std::size_t i = 0; i < rays.x.size(); ++i) {
        turned.x[i] = frame[0].x * rays.x[i] + frame[1].x * rays.y[i] + frame[2].x * rays.z[i];
        turned.y[i] = frame[0].y * rays.x[i] + frame[1].y * rays.y[i] + frame[2].y * rays.z[i];
        turned.z[i] = frame[0].z * rays.x[i] + frame[1].z * rays.y[i] + frame[2].z * rays.z[i];
    }
    const glm::vec3 origin = scene.origin({0.1, 0.3, 1.2}, {0, 0, 1});
    std::vector<std::uint32_t> hits(rays.x.size());
    hits.resize(scene.find_blocked(origin, frame, rays.x.size(), rays.x.data(), rays.y.data(),
                                   rays.z.data(), hits.data()));
    EXPECT_GT(hits.size(), 50u);
    EXPECT_EQ(hits, turned.blocked(scene, origin));
}

TEST(RayScene, DenormalsAreFlushedWhileTracingOnly) {
    const Mesh mesh = make_sphere(4);
    const RayScene scene(mesh);
    const unsigned before = _mm_getcsr();
    Rays(10).blocked(scene, glm::vec3(0));
    EXPECT_EQ(_mm_getcsr(), before);
    Rays bad(10);
    bad.x[3] = kNan;
    EXPECT_THROW(bad.blocked(scene, glm::vec3(0)), Error);
    EXPECT_EQ(_mm_getcsr(), before);
}

TEST(RayScene, TheGroundIsSolidBelowItsHeight) {
    Mesh floor = make_floor();
    floor = moved(floor, [](const glm::dvec3& p) { return glm::dvec3(p.y, p.z + 7, p.x); });
    add_normals(floor);
    RaySceneOptions options;
    options.ground_height = 6.5;
    const Rays rays(1000);
    const RayScene above(floor, {}, options);
    std::vector<std::uint32_t> down;
    for (std::uint32_t i = 0; i < rays.x.size(); ++i) {
        if (rays.y[i] < 0) down.push_back(i);
    }
    EXPECT_EQ(rays.blocked(above, above.origin({0, 7.5, 0}, {0, 1, 0})), down);
    EXPECT_EQ(rays.blocked(above, above.origin({0, 6, 0}, {0, 1, 0})).size(), rays.x.size());
    // A vertex on the ground itself stands on it.
    options.ground_height = 7;
    const RayScene on(floor, {}, options);
    EXPECT_EQ(rays.blocked(on, on.origin({0, 7, 0}, {0, 1, 0})), down);
}

TEST(RayScene, MemoryIsCountedAndHeldToTheLimit) {
    const Mesh mesh = make_sphere(60);
    const RayScene scene(mesh);
    const RaySceneReport& report = scene.report();
    EXPECT_EQ(report.triangles, mesh.triangles.size());
    // The buffers alone take 12 bytes for each triangle and vertex.
    EXPECT_GT(report.bytes, 12 * (mesh.triangles.size() + mesh.positions.size()));
    EXPECT_GE(report.peak_bytes, report.bytes);
    for (const std::size_t limit : {std::size_t{0}, std::size_t{100000}, report.bytes / 2}) {
        RaySceneOptions options;
        options.max_memory = limit;
        EXPECT_NE(error_of([&] { RayScene(mesh, {}, options); }).find("--max-memory"),
                  std::string::npos)
            << limit;
    }
}

TEST(RayScene, MeshesThatNoReaderMakesAreRefused) {
    Mesh mesh = make_box(1);
    mesh.positions[5].y = kNan;
    EXPECT_NE(error_of([&] { RayScene scene(mesh); }).find("vertex 5 of the mesh"),
              std::string::npos);
    mesh.positions[5].y = 1e101;
    EXPECT_THROW(RayScene{mesh}, Error);
    mesh = make_box(1);
    const Mesh whole = mesh;
    mesh.triangles[3].z = 8;
    EXPECT_NE(error_of([&] {
                  RayScene(whole, {&whole, &mesh});
              }).find("triangle 3 of the occluder 2 names vertex 8"),
              std::string::npos);
    RaySceneOptions options;
    options.ground_height = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(RayScene(whole, {}, options), Error);
}

TEST(RayScene, OccludersBeyondAllMeasureAreCounted) {
    const Mesh mesh = make_box(1);
    Mesh far = make_box(1);
    far.positions[0] = {1e90, 0, 0};
    const RayScene scene(mesh, {&far});
    std::size_t touched = 0;
    for (const glm::uvec3& t : far.triangles) touched += t.x == 0 || t.y == 0 || t.z == 0;
    EXPECT_EQ(scene.report().far_triangles, touched);
    EXPECT_EQ(scene.report().triangles, 24u);
    const RayScene huge(mesh, {&mesh, &far, &mesh});
    EXPECT_EQ(Rays(100).blocked(huge, glm::vec3(0)).size(), 100u);
}

TEST(RayScene, SingleRaysMeetWhatStreamsOfThemMeet) {
    const Mesh ball = make_sphere(24, 3, {5, -2, 1});
    const Mesh other = make_sphere(12, 1, {5, 4, 1});
    const RayScene scene(ball, {&other});
    const glm::dvec3 eye(1, 9, -3);
    const HemisphereDirections local = fibonacci_hemisphere(4000);
    const glm::dvec3 view = glm::normalize(glm::dvec3(5, 0, 1) - eye);
    const glm::mat3 frame(vertex_frame(view, 0));
    std::vector<RayHit> hits(local.count());
    hits.resize(scene.find_hits(scene.origin(eye, glm::dvec3(0)), frame, local.count(),
                                local.x.data(), local.y.data(), local.z.data(), hits.data()));
    ASSERT_GT(hits.size(), 100u);
    std::size_t next = 0;
    for (std::size_t i = 0; i < local.count(); ++i) {
        const glm::vec3 d = frame * glm::vec3(local.x[i], local.y[i], local.z[i]);
        const auto hit = scene.find_nearest(eye, glm::dvec3(d), 1e9);
        const bool met = next < hits.size() && hits[next].ray == i;
        ASSERT_EQ(hit.has_value(), met) << i;
        EXPECT_EQ(scene.is_blocked(eye, eye + 100.0 * glm::dvec3(d)), met);
        if (!met) continue;
        EXPECT_EQ(hit->mesh, hits[next].mesh);
        EXPECT_EQ(hit->triangle, hits[next].triangle);
        const Mesh& mesh = hit->mesh == 0 ? ball : other;
        const glm::uvec3 c = mesh.triangles[hit->triangle];
        const glm::dvec3 at = (1.0 - hit->u - hit->v) * mesh.positions[c.x] +
                              double(hit->u) * mesh.positions[c.y] +
                              double(hit->v) * mesh.positions[c.z];
        // Before and behind the place.
        const double distance = glm::length(at - eye);
        EXPECT_FALSE(scene.is_blocked(eye, eye + 0.999 * distance * glm::dvec3(d)));
        EXPECT_TRUE(scene.is_blocked(eye, eye + 1.001 * distance * glm::dvec3(d)));
        EXPECT_FALSE(scene.find_nearest(eye, glm::dvec3(d), 0.999 * distance));
        ++next;
    }
    EXPECT_EQ(next, hits.size());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(scene.find_nearest({nan, 0, 0}, {0, 0, 1}, 1));
    EXPECT_FALSE(scene.find_nearest(eye, {0, nan, 1}, 1));
    EXPECT_FALSE(scene.is_blocked(eye, {0, nan, 1}));
}

}  // namespace
}  // namespace airlight
