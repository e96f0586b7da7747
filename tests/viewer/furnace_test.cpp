// SPDX-License-Identifier: Apache-2.0
// Energy: surfaces and media under light from everywhere, by viewer/reference.h.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

#include "core/constants.h"
#include "sh/brdf_models.h"
#include "tests/viewer/scene_fixture.h"
#include "viewer/material.h"

namespace airlight {
namespace {

class FurnaceTest : public SceneFixture {};

// int reflect() over all directions, midpoints in the cosine and the azimuth.
glm::dvec3 reflected(const SurfaceMaterial& material, double theta) {
    constexpr int kSteps = 2000, kSides = 200;
    const glm::dvec3 to_viewer(std::sin(theta), 0, std::cos(theta));
    glm::dvec3 sum(0);
    for (int i = 0; i < kSteps; ++i) {
        const double z = (i + 0.5) / kSteps, across = std::sqrt(1 - z * z);
        for (int j = 0; j < kSides; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / kSides;
            sum += reflect(material, {0, 0, 1}, to_viewer,
                           {across * std::cos(phi), across * std::sin(phi), z});
        }
    }
    return sum * (2 * kPi / (double(kSteps) * kSides));
}

TEST_F(FurnaceTest, NoMaterialSendsMoreThanItsAlbedo) {
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
        const double theta = degrees * kPi / 180;
        const glm::dvec3 lambert = reflected({LambertMaterial{{0.2, 0.7, 1}}, nullptr}, theta);
        EXPECT_NEAR(lambert.x, 0.2, 1e-5);
        EXPECT_NEAR(lambert.y, 0.7, 1e-5);
        EXPECT_NEAR(lambert.z, 1, 1e-5);
        for (const double exponent : {1.0, 10.0, 200.0}) {
            PhongMaterial phong;
            phong.diffuse = glm::dvec3(0.3);
            phong.specular = glm::dvec3(0.6);
            phong.exponent = exponent;
            const double sent = reflected({phong, nullptr}, theta).x;
            // The lobe is cut at the horizon, never more than by half.
            EXPECT_LE(sent, 0.9 * (1 + 1e-3)) << exponent << " " << degrees;
            EXPECT_GE(sent, 0.6 * (1 - 1e-3)) << exponent << " " << degrees;
            if (degrees == 0) {
                EXPECT_NEAR(sent, 0.9, 1e-3) << exponent;
            }
        }
        RoughMetal metal;
        metal.roughness = 0.4;
        const SurfaceMaterial table = {TabulatedMaterial{},
                                       std::make_shared<BrdfLobe>(tabulate(metal, {90, 45, 90}))};
        EXPECT_LE(reflected(table, theta).x, 1) << degrees;
        EXPECT_GT(reflected(table, theta).x, 0.1) << degrees;
    }
}

TEST_F(FurnaceTest, AWhiteSphereIsNotSeenBeforeAWhiteSky) {
    Scene scene;
    add_sky(scene, 1, 10);
    add_ball(scene, {0.2, -0.1, 0}, 1, 64, LambertMaterial{glm::dvec3(1)});
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    double sum = 0;
    constexpr int kRays = 40;
    for (std::uint64_t i = 0; i < kRays; ++i) {
        SampleStream place(3, i);
        const glm::dvec3 to(1.9 * place.next() - 0.75, 1.9 * place.next() - 1.05, 0);
        const glm::dvec3 ray = glm::normalize(to - glm::dvec3(0, 0, 6));
        const double one = mean_radiance(renderer, {0, 0, 6}, ray, 1024, i).value.x;
        EXPECT_NEAR(one, 1, 0.03) << i;
        sum += one;
    }
    // Triangles are flat under the normals of a sphere: the horizon is off by their angle, 1.4
    // degrees, once to either side.
    EXPECT_NEAR(sum / kRays, 1, 2e-3);
}

// Around a medium that absorbs nothing the light of a white sky is 1 in all orders together. Direct
// and once scattered it is 1 less what is scattered twice, of second order in the thickness.
TEST_F(FurnaceTest, MediaThatAbsorbNothingLackWhatScattersTwice) {
    const auto scenes = [&](double density) {
        const SceneBox box{{-1, -0.7, -1.2}, {1, 0.9, 1}};
        std::vector<SceneMedium> media(7);
        media[0] = uniform_medium(glm::dvec3(density), glm::dvec3(0));
        media[1] = media[0];
        media[1].phase.type = PhaseType::henyey_greenstein;
        media[1].phase.g = 0.7;
        media[2] = gaussian_medium({{{0, 0, 0}, 1.3, density}, {{0.5, 0.2, 0.3}, 2, density}});
        media[3].kind = SceneExponentialHeight{glm::dvec3(density), 0.8, glm::dvec3(1)};
        media[4].kind = SceneLinearHeight{glm::dvec3(density), glm::dvec3(-density), glm::dvec3(1)};
        media[5].kind = SceneAtmosphere{{0, -50, 0}, 50, glm::dvec3(density), 0.8, glm::dvec3(1)};
        media[6].kind = SceneSlab{box, 1, glm::dvec3(density), glm::dvec3(0)};
        for (const std::size_t i : {0, 1, 3, 4, 5}) media[i].bounds = box;
        return media;
    };
    std::vector<double> deficits[2];
    for (const bool half : {false, true}) {
        for (const SceneMedium& medium : scenes(half ? 0.03 : 0.06)) {
            Scene scene;
            scene.media = {medium};
            add_sky(scene, 1, 40);
            const World world(scene);
            const ReferenceRenderer renderer(world, {});
            double sum = 0;
            constexpr int kRays = 8;
            for (std::uint64_t i = 0; i < kRays; ++i) {
                const glm::dvec3 ray =
                    glm::normalize(glm::dvec3(0.03 * double(i) - 0.1, 0.02 * double(i) - 0.1, -1));
                sum += mean_radiance(renderer, {0, 0.1, 5}, ray, 8192, i).value.x / kRays;
            }
            deficits[half ? 1 : 0].push_back(1 - sum);
        }
    }
    for (std::size_t i = 0; i < deficits[0].size(); ++i) {
        EXPECT_GT(deficits[0][i], 0) << i;
        EXPECT_LT(deficits[0][i], 0.03) << i;
        // 4 to first order, less of third order in the thickness of 0.1.
        EXPECT_NEAR(deficits[0][i] / deficits[1][i], 3.85, 0.2) << i;
    }
    // The slab of index 1 is the medium in its box.
    EXPECT_NEAR(deficits[0][6], deficits[0][0], 2e-4);
}

TEST_F(FurnaceTest, TheScattersOfABoxAreTheSecondOrderThatQuadratureSays) {
    // 1 - L = int sigma e^{-tau(t)} (1 - mean over directions of e^{-tau(x, w)}) dt.
    const double sigma = 0.1;
    const SceneBox box{glm::dvec3(-1), glm::dvec3(1)};
    Scene scene;
    scene.media = {uniform_medium(glm::dvec3(sigma), glm::dvec3(0))};
    scene.media[0].bounds = box;
    add_sky(scene, 1, 40);
    const World world(scene);
    const double found = mean_radiance({world, {}}, {0, 0, 5}, {0, 0, -1}, 1 << 16).value.x;
    double expected = 0;
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps; ++i) {
        const double t = 2.0 * (i + 0.5) / kSteps;
        double left = 0;
        for (int j = 0; j < kSteps; ++j) {
            const double z = 2 * (j + 0.5) / kSteps - 1, across = std::sqrt(1 - z * z);
            for (int k = 0; k < kSteps; ++k) {
                const double phi = 2 * kPi * (k + 0.5) / kSteps;
                const glm::dvec3 w(across * std::cos(phi), across * std::sin(phi), z);
                // From (0, 0, 1 - t) to the face that it leaves through.
                const double out = std::min(
                    {1 / std::abs(w.x), 1 / std::abs(w.y), (w.z > 0 ? t : 2 - t) / std::abs(w.z)});
                left += 1 - std::exp(-sigma * out);
            }
        }
        expected += sigma * std::exp(-sigma * t) * left * 2 / (double(kSteps) * kSteps * kSteps);
    }
    EXPECT_NEAR(1 - found, expected, 1e-3 * expected + 1e-4);
}

TEST_F(FurnaceTest, ASlabIsTheIntegralOfItsPaper) {
    std::ifstream file(AIRLIGHT_SLAB_ROWS);
    std::string line;
    ASSERT_TRUE(std::getline(file, line)) << AIRLIGHT_SLAB_ROWS;
    int rows = 0;
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        double v[8];
        char comma;
        for (double& value : v) cells >> value >> comma;
        const double sigma = v[0], s = v[1], l = v[2], a = v[3], b = v[4], c = v[5];
        // w in the plane of x and z; the light where its two cosines put it.
        const double across = std::sqrt(1 - a * a);
        const double x = across > 0 ? (c - a * b) / across : std::sqrt(1 - b * b);
        const double y = 1 - b * b - x * x;
        if (!(b > 0) || y < -1e-12 || (across == 0 && std::abs(c - b) > 1e-12)) continue;
        const glm::dvec3 w(across, 0, a), to_light(x, std::sqrt(std::max(0.0, y)), b);
        Scene scene;
        SceneMedium slab;
        slab.kind = SceneSlab{SceneBox{{-1e4, -1e4, -s * a}, {1e4, 1e4, 0}}, 1, glm::dvec3(sigma),
                              glm::dvec3(0)};
        scene.media = {slab};
        scene.lights = {{l * to_light, glm::dvec3(4 * kPi)}};
        const World world(scene);
        ReferenceOptions options;
        options.quadrature = 1e-6;
        SampleStream stream(0, 0);
        const double found = ReferenceRenderer(world, options).radiance(w, -w, stream, counts_).x;
        EXPECT_NEAR(found, sigma * v[7], 1e-4 * sigma * v[7]) << line;
        ++rows;
    }
    EXPECT_GT(rows, 50);
}

}  // namespace
}  // namespace airlight
