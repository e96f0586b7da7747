// SPDX-License-Identifier: Apache-2.0
// Scenes of many blobs and many lights cost what a ray meets, not what the scene holds.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/constants.h"
#include "medium/airlight.h"
#include "tests/viewer/scene_fixture.h"

namespace airlight {
namespace {

class CrowdTest : public SceneFixture {
  protected:
    double between(double a, double b) {
        return a + (b - a) * std::ldexp(double(random_() >> 11), -53);
    }
    std::mt19937_64 random_{6};
};

TEST_F(CrowdTest, AHundredThousandBlobsAreARandomUniformFog) {
    // Evenly spread and each small, they are as dense as their sum over the volume.
    std::vector<GaussianBlob> blobs;
    constexpr int kCount = 100000;
    const double scale = 4, edge = 12;
    for (int i = 0; i < kCount; ++i) {
        const glm::dvec3 center(between(-6, 6), between(-6, 6), between(-6, 6));
        blobs.push_back({center, scale, 0.02});
    }
    const double sigma = kCount * 0.02 * std::pow(std::sqrt(kPi) / scale, 3) / std::pow(edge, 3);
    Scene scene;
    scene.media = {gaussian_medium(blobs)};
    scene.lights = {{{1.5, 1, 0}, glm::dvec3(1)}};
    const World world(scene);
    // Few points tell: each sums some thousands of blobs.
    ReferenceOptions options;
    options.quadrature = 0.01;
    const glm::dvec3 origin(0, 0, 3), direction(0, 0, -1);
    const double found =
        ReferenceRenderer(world, options).airlight_of_lights(origin, direction, 6, counts_).x;
    const glm::dvec3 to_light = scene.lights[0].position - origin;
    const double distance = glm::length(to_light);
    const double gamma = std::acos(glm::dot(to_light, direction) / distance);
    const double expected = sigma * sigma * airlight(gamma, sigma * distance, sigma * 6);
    // The blobs' own unevenness: 19 of them overlap on average, some hundred on a ray.
    EXPECT_NEAR(found, expected, 0.15 * expected);
    EXPECT_LT(counts_.line_points, 6000u);
}

TEST_F(CrowdTest, AThousandLightsAddUp) {
    Scene scene;
    scene.media = {uniform_medium(glm::dvec3(0.1), glm::dvec3(0.02))};
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 position(between(-4, 4), between(-4, 4), between(-8, 0));
        scene.lights.push_back({position, glm::dvec3(1)});
    }
    add_triangle(scene, 1, LambertMaterial{glm::dvec3(0.5)});
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    // Beside the triangle, and unshaded.
    const glm::dvec3 origin(0, 0, 3), direction = glm::normalize(glm::dvec3(1.9, 0, -1));
    double expected = 0;
    for (const PointLight& light : scene.lights) {
        const glm::dvec3 to_light = light.position - origin;
        const double distance = glm::length(to_light);
        const double gamma = std::acos(glm::dot(to_light, direction) / distance);
        expected += 0.1 * 0.12 * airlight(gamma, 0.12 * distance, 0.12 * 1e6);
    }
    ReferenceOptions open;
    open.shadows_in_media = false;
    SampleStream stream(0, 0);
    const double found =
        ReferenceRenderer(world, open).radiance(origin, direction, stream, counts_).x;
    EXPECT_NEAR(found, expected, 1e-6 * expected);
    EXPECT_LT(renderer.radiance(origin, direction, stream, counts_).x, found * (1 + 1e-9));
    const double surface = renderer.radiance(origin, {0, 0, -1}, stream, counts_).x;
    EXPECT_GT(surface, 0);
    EXPECT_TRUE(std::isfinite(surface));
    // A way, a shadow ray and a path of scattered light for each lamp, about.
    EXPECT_LT(counts_.rays, 4000u);
}

}  // namespace
}  // namespace airlight
