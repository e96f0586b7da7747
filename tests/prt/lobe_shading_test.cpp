// SPDX-License-Identifier: Apache-2.0
#include "prt/lobe_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "core/error.h"
#include "core/threads.h"
#include "sh/brdf_models.h"
#include "sh/lobes.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/medium/batch_check.h"
#include "tests/prt/shading_light.h"
#include "tests/prt/shapes.h"

namespace airlight {
namespace {

const glm::vec3 kWhite(1.0f);
const LobeShadingMethod kBoth[] = {LobeShadingMethod::product, LobeShadingMethod::matrix};

std::vector<float> shade(const std::vector<double>& lobe, LobeShadingMethod method,
                         const std::vector<float>& rows, int order,
                         const std::vector<glm::vec3>& axes, const ShLight& light) {
    std::vector<float> radiance(3 * axes.size(), -7.0f);
    LobeShader(lobe, method)
        .shade({order, axes.size(), rows.data()}, axes.data(), light, kWhite, radiance.data());
    return radiance;
}

// Everything is visible, below the horizon, too.
std::vector<float> full_visibility(int order, std::size_t count) {
    std::vector<float> rows(count * sh_count(order));
    for (std::size_t v = 0; v < count; ++v) {
        rows[v * sh_count(order)] = static_cast<float>(std::sqrt(4 * kPi));
    }
    return rows;
}

TEST(LobeShading, WithNothingHiddenIsTheConvolutionOfTheLight) {
    const std::vector<glm::vec3> axes = random_directions(67, 1);
    for (const LobeShadingMethod method : kBoth) {
        for (const int order : {1, 2, 4, 6, 8}) {
            const ShLight light = random_light(order, 2);
            for (const double exponent : {1.0, 20.0}) {
                const auto lobe = phong_eigenvalues(exponent, order, LobeScale::integral);
                std::vector<float> convolved = light.coefficients;
                zonal_convolve(lobe, 3, convolved.data());
                const std::vector<float> radiance =
                    shade(lobe, method, full_visibility(order, 67), order, axes, light);
                for (std::size_t i = 0; i < radiance.size(); ++i) {
                    EXPECT_NEAR(radiance[i],
                                value_at(order, &convolved[i % 3 * sh_count(order)],
                                         glm::dvec3(axes[i / 3])),
                                5e-6);
                }
            }
        }
    }
}

TEST(LobeShading, IsTheIntegralOfThreeFunctions) {
    for (const LobeShadingMethod method : kBoth) {
        for (const int order : {2, 3, 5}) {
            const std::size_t size = sh_count(order);
            const std::vector<float> rows = random_floats(5 * size, 1);
            const std::vector<glm::vec3> axes = random_directions(5, 2);
            const ShLight light = random_light(order, 3);
            const auto lobe = phong_eigenvalues(3, order);
            const std::vector<double> g = zonal_coefficients(lobe);
            const std::vector<float> radiance = shade(lobe, method, rows, order, axes, light);
            for (std::size_t v = 0; v < 5; ++v) {
                std::vector<double> b(size);
                rotate_zonal(order, g.data(), glm::dvec3(axes[v]), b.data());
                const double exact = sphere_integral(2 * order, [&](const glm::dvec3& d) {
                    return value_at(order, light.coefficients.data(), d) *
                           value_at(order, &rows[v * size], d) * value_at(order, b.data(), d);
                });
                EXPECT_NEAR(radiance[3 * v], exact, 1e-5);
            }
        }
    }
}

// Of degree 2 each, visibility and cosine have a product of degree 4, which order 5 holds.
TEST(LobeShading, IsTheDotWithTransferWhereTheBandsHoldTheProduct) {
    const int order = 5;
    const std::size_t size = sh_count(order), count = 7;
    std::vector<double> lobe = clamped_cosine_eigenvalues(3);
    lobe.resize(static_cast<std::size_t>(order), 0.0);
    for (double& value : lobe) value /= kPi;
    const std::vector<double> g = zonal_coefficients(lobe);
    const std::vector<glm::vec3> axes = random_directions(count, 1);
    const std::vector<float> narrow = random_floats(count * 9, 2);
    std::vector<float> transfer(count * size);
    for (std::size_t v = 0; v < count; ++v) {
        std::vector<double> b(size), basis(size);
        rotate_zonal(order, g.data(), glm::dvec3(axes[v]), b.data());
        for (std::size_t k = 0; k < size; ++k) {
            transfer[v * size + k] =
                static_cast<float>(sphere_integral(2 * order, [&](const glm::dvec3& d) {
                    evaluate_basis(order, d.x, d.y, d.z, basis.data());
                    return value_at(3, &narrow[v * 9], d) * value_at(order, b.data(), d) * basis[k];
                }));
        }
    }
    const ShLight light = random_light(order, 3);
    std::vector<float> dots(3 * count);
    shade_transfer({order, count, transfer.data()}, light, kWhite, dots.data());
    for (const LobeShadingMethod method : kBoth) {
        const std::vector<float> radiance = shade(lobe, method, narrow, 3, axes, light);
        for (std::size_t i = 0; i < dots.size(); ++i) EXPECT_NEAR(radiance[i], dots[i], 3e-6);
    }
}

TEST(LobeShading, OrdersMayDifferAndMethodsAgree) {
    const std::vector<glm::vec3> axes = random_directions(70, 1);
    for (const int order : {1, 3, 6}) {
        for (const int seen_order : {1, 2, 6, 8}) {
            for (const int light_order : {2, 6, 7}) {
                const std::vector<float> rows = random_floats(70 * sh_count(seen_order), 2);
                const ShLight light = random_light(light_order, 3);
                const auto lobe = phong_eigenvalues(4, order);
                const auto reference = shade(lobe, kBoth[0], rows, seen_order, axes, light);
                for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                    const ForcedTarget forced(target);
                    const auto by_product = shade(lobe, kBoth[0], rows, seen_order, axes, light);
                    const auto by_matrix = shade(lobe, kBoth[1], rows, seen_order, axes, light);
                    for (std::size_t i = 0; i < by_product.size(); ++i) {
                        EXPECT_NEAR(by_product[i], by_matrix[i], 1e-5) << hwy::TargetName(target);
                        EXPECT_NEAR(by_product[i], reference[i], 1e-5) << hwy::TargetName(target);
                    }
                }
            }
        }
    }
}

TEST(LobeShading, InFogIsShadingByTheLightInFog) {
    const int order = 5;
    const std::size_t count = 130;
    const std::vector<float> rows = random_floats(count * sh_count(order), 1);
    const std::vector<glm::vec3> axes = random_directions(count, 2);
    const ShLight light = random_light(order, 3);
    const LobeShader shader(phong_eigenvalues(8, order, LobeScale::integral));
    for (const NamedMethod<FogShadingMethod>& each : kFogShadingMethods) {
        SCOPED_TRACE(each.name);
        const FogShading fog(order, each.method);
        const FogLight lights = fog.light(light);
        std::vector<float> radiance(3 * count);
        // All at one thickness, so that one light can stand for the fog.
        const std::vector<float> thickness(count, 0.7f);
        shader.shade({order, count, rows.data()}, axes.data(), lights,
                     fog.weights(count, thickness.data()), kWhite, radiance.data());
        const FogWeights one = fog.weights(1, thickness.data());
        ShLight foggy{order, std::vector<float>(3 * sh_count(order))};
        for (std::size_t i = 0; i < foggy.coefficients.size(); ++i) {
            const auto l = static_cast<std::size_t>(sh_degree(i % sh_count(order)).l);
            for (std::size_t j = 0; j < (lights.by_degree ? 1 : lights.terms); ++j) {
                foggy.coefficients[i] += one.values[lights.by_degree ? l : j] *
                                         lights.coefficients[j * foggy.coefficients.size() + i];
            }
        }
        std::vector<float> expected(3 * count);
        shader.shade({order, count, rows.data()}, axes.data(), foggy, kWhite, expected.data());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_NEAR(radiance[i], expected[i], 5e-6);
        }
    }
}

TEST(LobeShading, NanStaysWithItsVertexWhateverTheThreads) {
    const int order = 4;
    const std::size_t count = 5000;
    std::vector<float> rows = random_floats(count * sh_count(order), 1);
    std::vector<glm::vec3> axes = random_directions(count, 2);
    rows[7 * sh_count(order) + 3] = std::numeric_limits<float>::quiet_NaN();
    axes[9].y = std::numeric_limits<float>::infinity();
    for (const LobeShadingMethod method : kBoth) {
        const auto lobe = phong_eigenvalues(2, order);
        const auto radiance = shade(lobe, method, rows, order, axes, random_light(order, 3));
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            ASSERT_EQ(std::isnan(radiance[i]), i / 3 == 7 || i / 3 == 9) << i;
        }
        const ThreadLimit one(1);
        const auto alone = shade(lobe, method, rows, order, axes, random_light(order, 3));
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            if (!std::isnan(radiance[i])) {
                ASSERT_EQ(alone[i], radiance[i]);
            }
        }
    }
}

TEST(LobeShading, AxesAreNormalsOrMirrorTheView) {
    const Mesh floor = make_floor();
    EXPECT_EQ(normal_axes(floor)[0], glm::vec3(0, 0, 1));
    const glm::vec3 axis = mirrored_axes(floor, {3, 0, 4})[0];
    EXPECT_NEAR(axis.x, -0.6, 1e-7);
    EXPECT_NEAR(axis.z, 0.8, 1e-7);
    EXPECT_EQ(mirrored_axes(floor, {0, 0, 0})[0], glm::vec3(0));
}

TEST(LobeShading, OrdersThatAreNoneAreRefused) {
    EXPECT_THROW(LobeShader({}), Error);
    EXPECT_THROW(LobeShader(std::vector<double>(33, 1.0)), Error);
    EXPECT_THROW(BrdfShader(0, tabulate_lambertian(1, {9, 9, 18})), Error);
    EXPECT_THROW(BrdfShader(3, tabulate_lambertian(1, {9, 9, 18}), 1), Error);
}

TEST(BrdfShading, OfALambertianTableIsTheClampedCosine) {
    const int order = 4;
    const BrdfShader shader(order, tabulate_lambertian(0.6, {9, 9, 18}), 8);
    auto lobe = clamped_cosine_eigenvalues(order);
    for (double& value : lobe) value *= 0.6 / kPi;
    const std::vector<float> rows = random_floats(40 * sh_count(order), 1);
    const std::vector<glm::vec3> normals = random_directions(40, 2);
    const std::vector<glm::vec3> views = random_directions(40, 3);
    const ShLight light = random_light(order, 4);
    const auto expected = shade(lobe, kBoth[0], rows, order, normals, light);
    std::vector<float> radiance(expected.size());
    shader.shade({order, 40, rows.data()}, normals.data(), views.data(), light, radiance.data());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(radiance[i], expected[i], 1e-5);
}

// The metal itself, integrated in the frame of the surface, which has the viewer at x > 0.
TEST(BrdfShading, OfAMetalIsItsIntegralOverTheLight) {
    const int order = 4;
    RoughMetal metal;
    metal.roughness = 0.5;
    const BrdfShader shader(order, tabulate(metal));
    const ShLight light = random_light(order, 4);
    const glm::dvec3 n(0.6, 0.0, 0.8), t(0.8, 0.0, -0.6), b(0, 1, 0);
    const std::vector<float> rows = full_visibility(order, 1);
    for (const double tilt : {0.0, 0.4, 1.1}) {
        for (const double azimuth : {0.0, 2.0}) {
            const glm::dvec3 local(std::sin(tilt), 0, std::cos(tilt));
            const glm::dvec3 side = std::cos(azimuth) * t + std::sin(azimuth) * b;
            const glm::dvec3 across = glm::cross(n, side);
            const glm::vec3 normal(n), view(local.x * side + local.z * n);
            float radiance[3];
            shader.shade({order, 1, rows.data()}, &normal, &view, light, radiance);
            for (int c = 0; c < 3; ++c) {
                const float* const channel =
                    &light.coefficients[static_cast<std::size_t>(c) * sh_count(order)];
                const double exact = sphere_integral(100, [&](const glm::dvec3& in) {
                    if (in.z <= 0) return 0.0;
                    return evaluate_metal(metal, in, local)[c] * in.z *
                           value_at(order, channel, in.x * side + in.y * across + in.z * n);
                });
                EXPECT_NEAR(radiance[c], exact, 2e-3) << tilt;
            }
        }
    }
}

}  // namespace
}  // namespace airlight
