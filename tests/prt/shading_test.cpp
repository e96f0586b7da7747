// SPDX-License-Identifier: Apache-2.0
#include "prt/shading.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numeric>

#include "core/threads.h"
#include "prt/bake.h"
#include "sh/rotation.h"
#include "tests/medium/batch_check.h"
#include "tests/prt/shading_light.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

const glm::vec3 kWhite(1.0f);

// Of a floor under a ball, with many corners.
Mesh make_scene() {
    Mesh mesh = make_sphere(6, 1, {0, 0, 1.2});
    const Mesh floor = make_floor();
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (const glm::dvec3& p : floor.positions) mesh.positions.push_back(3.0 * p);
    for (const glm::uvec3& t : floor.triangles) mesh.triangles.push_back(t + first);
    mesh.normals.clear();
    add_normals(mesh);
    return mesh;
}

Bake bake(const Mesh& mesh, int order) {
    BakeOptions options;
    options.order = order;
    options.rays = 256;
    BakeKinds kinds;
    kinds.ambient_occlusion = true;
    return bake_mesh(mesh, RayScene(mesh), options, kinds);
}

std::vector<float> shade(const std::vector<float>& transfer, int order, const ShLight& light,
                         const glm::vec3& albedo = kWhite) {
    const std::size_t count = transfer.size() / sh_count(order);
    std::vector<float> radiance(3 * count, -7.0f);
    shade_transfer({order, count, transfer.data()}, light, albedo, radiance.data());
    return radiance;
}

TEST(Shading, AWhiteSkyGivesAmbientOcclusionTimesTheAlbedo) {
    const Mesh mesh = make_scene();
    const Bake b = bake(mesh, 5);
    ASSERT_GT(b.report.blocked, 1000u);
    const glm::vec3 albedo(0.8f, 0.5f, 0.1f);
    const std::vector<float> radiance = shade(b.transfer, 5, white_sky(5), albedo);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(radiance[3 * v + static_cast<std::size_t>(c)],
                        float(c + 1) * albedo[c] * b.ambient_occlusion[v], 1e-6);
        }
    }
}

// A tilted plane under a bright upper hemisphere sees (1 + cos tilt) / 2 of it. The cosine has no
// odd degrees beyond 1 and the hemisphere no even ones beyond 0, so that order 2 is exact.
TEST(Shading, ABrightHemisphereLightsByTheTiltOfTheSurface) {
    const Mesh ball = make_sphere(8);
    for (const int order : {2, 3, 6}) {
        const Bake b = bake(ball, order);
        ASSERT_EQ(b.report.blocked, 0u);
        std::vector<double> light(3 * sh_count(order));
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < sh_count(order); ++k) {
                // By hand, sqrt(pi (2l+1)) int_0^1 P_l, about +Y, slot (1, -1).
                if (k == 0) light[c * sh_count(order)] = std::sqrt(kPi);
                if (k == 1) light[c * sh_count(order) + 1] = std::sqrt(3 * kPi) / 2;
            }
        }
        const std::vector<float> radiance = shade(b.transfer, order, sh_light(order, light.data()));
        for (std::size_t v = 0; v < ball.positions.size(); ++v) {
            EXPECT_NEAR(radiance[3 * v], 0.5 * (1 + ball.normals[v].y), 1e-6) << order;
        }
    }
}

TEST(Shading, TurningLightAndMeshTogetherChangesNothing) {
    const int order = 6;
    const Mesh ball = make_sphere(5);
    const glm::dquat turn = glm::normalize(glm::dquat(0.3, 0.5, -0.7, 0.2));
    Mesh turned = moved(ball, [&](const glm::dvec3& p) { return turn * p; });
    for (glm::dvec3& n : turned.normals) n = turn * n;
    const ShLight light = random_light(order, 1);
    ShLight turned_light = light;
    ShRotation(order, turn).rotate(3, light.coefficients.data(), turned_light.coefficients.data());
    const std::vector<float> before = shade(bake(ball, order).transfer, order, light);
    const std::vector<float> after = shade(bake(turned, order).transfer, order, turned_light);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 2e-6);
    // The light is none that would look the same from everywhere.
    EXPECT_GT(std::abs(before[0] - before[30]), 1e-2);
}

// Any orders and numbers of vertices, on every target.
TEST(Shading, IsTheSumOverTheCoefficientsThatBothHave) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const int order : {1, 2, 3, 4, 6, 7, 10, 13}) {
            for (const int light_order : {1, 2, 3, 5, 6, 8}) {
                const ShLight light = random_light(light_order, 3);
                const std::size_t size = sh_count(order), light_size = sh_count(light_order);
                const std::size_t common = std::min(size, light_size);
                for (const std::size_t count : {0, 1, 2, 3, 4, 5, 33}) {
                    const std::vector<float> rows = random_floats(count * size, 4);
                    const std::vector<float> radiance = shade(rows, order, light);
                    ASSERT_EQ(radiance.size(), 3 * count);
                    for (std::size_t i = 0; i < radiance.size(); ++i) {
                        const float* const row = &rows[i / 3 * size];
                        const float* const l = &light.coefficients[i % 3 * light_size];
                        double sum = 0, scale = 0;
                        for (std::size_t k = 0; k < common; ++k) {
                            sum += double{row[k]} * double{l[k]};
                            scale += std::abs(double{row[k]} * double{l[k]});
                        }
                        ASSERT_NEAR(radiance[i], sum, 1e-6 * scale) << order << " " << light_order;
                    }
                }
            }
        }
    }
}

TEST(Shading, IsLinearAndMayBeNegative) {
    const ShLight a = random_light(4, 1), b = random_light(4, 2);
    ShLight sum = a;
    for (std::size_t i = 0; i < sum.coefficients.size(); ++i) {
        sum.coefficients[i] += 2 * b.coefficients[i];
    }
    const std::vector<float> rows = random_floats(50 * 16, 3);
    const std::vector<float> of_a = shade(rows, 4, a), of_b = shade(rows, 4, b);
    const std::vector<float> of_sum = shade(rows, 4, sum);
    for (std::size_t i = 0; i < of_sum.size(); ++i) {
        EXPECT_NEAR(of_sum[i], of_a[i] + 2 * of_b[i], 1e-5);
    }
    EXPECT_LT(*std::min_element(of_a.begin(), of_a.end()), -0.1f);
}

TEST(Shading, NanStaysWithItsVertexAndItsChannel) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const int order : {1, 3, 6}) {
        const std::size_t size = sh_count(order);
        std::vector<float> rows = random_floats(9 * size, 3);
        const ShLight light = random_light(order, 1);
        const std::vector<float> good = shade(rows, order, light);
        for (std::size_t k = 0; k < size; ++k) {
            std::vector<float> bad = rows;
            bad[4 * size + k] = nan;
            const std::vector<float> radiance = shade(bad, order, light);
            for (std::size_t i = 0; i < radiance.size(); ++i) {
                if (i / 3 == 4) {
                    EXPECT_TRUE(std::isnan(radiance[i]));
                } else {
                    EXPECT_EQ(radiance[i], good[i]);
                }
            }
            ShLight bad_light = light;
            bad_light.coefficients[size + k] = nan;
            const std::vector<float> lit = shade(rows, order, bad_light);
            for (std::size_t i = 0; i < lit.size(); ++i) {
                EXPECT_EQ(std::isnan(lit[i]), i % 3 == 1);
            }
        }
    }
}

TEST(Shading, AVertexDependsOnItselfAloneWhateverTheThreads) {
    const int order = 5;
    const std::size_t size = sh_count(order), count = 10001;
    const std::vector<float> rows = random_floats(count * size, 3);
    const ShLight light = random_light(order, 1);
    const std::vector<float> radiance = shade(rows, order, light);
    {
        const ThreadLimit one(1);
        EXPECT_EQ(shade(rows, order, light), radiance);
    }
    for (const std::size_t first : {1, 4098, 9999}) {
        const std::vector<float> some(
            rows.begin() + static_cast<std::ptrdiff_t>(first * size),
            rows.begin() + static_cast<std::ptrdiff_t>((first + 2) * size));
        const std::vector<float> alone = shade(some, order, light);
        EXPECT_EQ(std::memcmp(alone.data(), &radiance[3 * first], 6 * sizeof(float)), 0);
    }
}

}  // namespace
}  // namespace airlight
