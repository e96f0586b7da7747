// SPDX-License-Identifier: Apache-2.0
// The environment map in fog, by viewer/reference.h.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "envmap/fog.h"
#include "envmap/latlong.h"
#include "medium/phase_airlight.h"
#include "tests/viewer/scene_fixture.h"
#include "viewer/axes.h"

namespace airlight {
namespace {

class EnvironmentFogTest : public SceneFixture {
  protected:
    /// 16 x 8 pixels, one of them a lamp.
    static Image random_map(float lamp = 40) {
        std::mt19937_64 random(5);
        Image map(16, 8, 3);
        for (float& value : map.pixels) value = float(std::ldexp(double(random() >> 40), -24));
        for (std::size_t c = 0; c < 3; ++c) map.pixels[3 * (16 * 2 + 11) + c] = lamp;
        return map;
    }
    static glm::dvec3 pixel_at(const Image& map, const glm::dvec3& d) {
        const LatLongPixel p = pixel_of({d.x, d.y, d.z}, map.width, map.height);
        return {map.at(p.row, p.column, 0), map.at(p.row, p.column, 1), map.at(p.row, p.column, 2)};
    }
    /// int L PSF_T d omega around a direction, in polar coordinates, where sin(gamma) takes the
    /// peak away: midpoints, so the error is that of the pixels' borders, 3e-4.
    static double scattered(const Image& map, const glm::dvec3& axis, int channel, double thickness,
                            const PhaseFunction& phase) {
        constexpr int kRings = 600, kSides = 600;
        glm::dvec3 x, y;
        make_axes(axis, x, y);
        double sum = 0;
        for (int i = 0; i < kRings; ++i) {
            const double gamma = kPi * (i + 0.5) / kRings;
            double around = 0;
            for (int j = 0; j < kSides; ++j) {
                const double phi = 2 * kPi * (j + 0.5) / kSides;
                around += pixel_at(
                    map, std::cos(gamma) * axis +
                             std::sin(gamma) * (std::cos(phi) * x + std::sin(phi) * y))[channel];
            }
            sum += std::sin(gamma) * psf(thickness, gamma, phase) * around;
        }
        return sum * 2 * kPi * kPi / (double(kRings) * kSides);
    }
};

SceneMedium coloured_fog() {
    return uniform_medium({0.02, 0.05, 0.2}, {0, 0.01, 0.05});
}

TEST_F(EnvironmentFogTest, BackgroundIsWhatTheFogOfMapsWrites) {
    for (const double g : {0.0, 0.6}) {
        Scene scene;
        scene.media = {coloured_fog()};
        FogOptions options;
        options.optical_thickness = {0.02 * 8, 0.06 * 8, 0.25 * 8};
        options.albedo = {1, 0.05 / 0.06, 0.8};
        options.method = FogMethod::rings;
        if (g != 0) {
            scene.media[0].phase.type = PhaseType::henyey_greenstein;
            scene.media[0].phase.g = g;
            options.phase = PhaseFunction::henyey_greenstein(g);
        }
        const Image map = random_map(10);
        add_map(scene, map, 8);
        const World world(scene);
        const ReferenceRenderer renderer(world, {});
        const FogPlan plan = plan_fog(map.height, map.width, 3, options);
        const Image scattered_map = scattered_light(map, plan);
        Image foggy = scattered_map;
        add_direct_light(map, plan, foggy);
        double sum[3] = {}, expected[3] = {};
        for (int row = 0; row < map.height; ++row) {
            for (int column = row % 2; column < map.width; column += 2) {
                const auto [x, y, z] = pixel_direction(row, column, map.width, map.height);
                const std::uint64_t pixel = static_cast<std::uint64_t>(16 * row + column);
                const Mean mean = mean_radiance(renderer, {3, 1, -2}, {x, y, z}, 1024, pixel);
                for (int c = 0; c < 3; ++c) {
                    sum[c] += mean.value[c];
                    expected[c] += foggy.at(row, column, c);
                    EXPECT_NEAR(mean.value[c], foggy.at(row, column, c),
                                0.04 * scattered_map.at(row, column, c) + 4 * mean.error);
                }
            }
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-3 * expected[c]) << c;
    }
}

TEST_F(EnvironmentFogTest, BackgroundIsTheQuadratureOfThePointSpreadFunction) {
    Scene scene;
    scene.media = {coloured_fog()};
    const Image map = random_map();
    add_map(scene, map, 8);
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    glm::dvec3 sum(0), expected(0);
    for (const auto& [row, column] : {std::pair(0, 3), {2, 11}, {2, 12}, {3, 10}, {5, 2}, {7, 9}}) {
        const auto [x, y, z] = pixel_direction(row, column, map.width, map.height);
        const glm::dvec3 direction(x, y, z);
        sum += mean_radiance(renderer, glm::dvec3(0), direction, 8192).value;
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 extinction(0.02, 0.06, 0.25), albedo(1, 0.05 / 0.06, 0.8);
            const double thickness = 8 * extinction[c];
            expected[c] += std::exp(-thickness) * pixel_at(map, direction)[c] +
                           albedo[c] * scattered(map, direction, c, thickness, {});
        }
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-3 * expected[c]) << c;
}

TEST_F(EnvironmentFogTest, BackgroundOfOneColourIsTheClosedFormOfThePhaseFunction) {
    for (const double g : {0.0, -0.3, 0.8}) {
        Scene scene;
        scene.media = {uniform_medium(glm::dvec3(0.06), glm::dvec3(0.02))};
        scene.media[0].phase.type = PhaseType::henyey_greenstein;
        scene.media[0].phase.g = g;
        add_sky(scene, 3, 10);
        const World world(scene);
        const ReferenceRenderer renderer(world, {});
        // 4 pi T int_0^pi p(alpha) int_0^{alpha/2} e^{-T cos(phi) / cos(alpha/2)} d phi d alpha.
        const double thickness = 0.8;
        constexpr int kSteps = 1000;
        double integral = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double alpha = kPi * (i + 0.5) / kSteps;
            double inner = 0;
            for (int j = 0; j < kSteps; ++j) {
                const double phi = 0.5 * alpha * (j + 0.5) / kSteps;
                inner += std::exp(-thickness * std::cos(phi) / std::cos(0.5 * alpha));
            }
            integral += phase_hg_at_angle(alpha, g) * 0.5 * alpha * inner;
        }
        integral *= 4 * kPi * thickness * kPi / (double(kSteps) * kSteps);
        const double expected = 3 * (std::exp(-thickness) + 0.75 * integral);
        const double found = mean_radiance(renderer, glm::dvec3(0), {0, 0.6, -0.8}, 8192).value.x;
        EXPECT_NEAR(found, expected, 1e-3 * expected) << g;
    }
}

TEST_F(EnvironmentFogTest, SurfacesGatherTheGlowOfTheMap) {
    // A tiny triangle: fog is all around it. Lambertian, so that what it sends is
    // sum_j L_j int_{pixel j} (e^-T max(0, n.w) + H(w)) d omega / pi,
    // with H = int PSF_T(angle(w, w')) max(0, n.w') d omega'.
    Scene scene;
    scene.media = {coloured_fog()};
    add_triangle(scene, 1e-4, LambertMaterial{glm::dvec3(0.5)});
    const Image map = random_map(5);
    add_map(scene, map, 8);
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    const Mean found = mean_radiance(renderer, {0, 0, 1e-4}, {0, 0, -1}, 1 << 19);
    const glm::dvec3 extinction(0.02, 0.06, 0.25), albedo(1, 0.05 / 0.06, 0.8);
    for (int c = 0; c < 3; ++c) {
        const double thickness = 8 * extinction[c];
        // H at 0 ... pi.
        constexpr int kSteps = 200;
        std::vector<double> response;
        for (int i = 0; i <= kSteps; ++i) {
            const double theta = kPi * i / kSteps;
            double gathered = 0;
            for (int j = 0; j < kSteps; ++j) {
                const double gamma = kPi * (j + 0.5) / kSteps;
                double around = 0;
                for (int k = 0; k < kSteps; ++k) {
                    const double phi = kPi * (k + 0.5) / kSteps;
                    around += std::max(0.0, std::cos(theta) * std::cos(gamma) +
                                                std::sin(theta) * std::sin(gamma) * std::cos(phi));
                }
                gathered += std::sin(gamma) * psf(thickness, gamma) * around;
            }
            response.push_back(gathered * 2 * kPi * kPi / (double(kSteps) * kSteps));
        }
        double expected = 0;
        constexpr int kParts = 16;
        for (int row = 0; row < kParts * map.height; ++row) {
            for (int column = 0; column < kParts * map.width; ++column) {
                const auto [x, y, z] =
                    pixel_direction(row, column, kParts * map.width, kParts * map.height);
                const double theta = std::acos(z) / kPi * kSteps;
                const auto step = static_cast<std::size_t>(std::min(theta, kSteps - 1.0));
                const double gathered =
                    response[step] + (theta - double(step)) * (response[step + 1] - response[step]);
                expected += pixel_solid_angle(row, kParts * map.width, kParts * map.height) *
                            map.at(row / kParts, column / kParts, c) *
                            (std::exp(-thickness) * std::max(0.0, z) + albedo[c] * gathered);
            }
        }
        expected *= 0.5 / kPi;
        EXPECT_NEAR(found.value[c], expected, 1e-3 * expected) << c << " " << found.error;
    }
}

TEST_F(EnvironmentFogTest, WaysToSumItSeeTheSameShadows) {
    // By closed forms between borders of shadows, by points with shadow rays, and by points because
    // of another medium, next to nothing.
    Scene scene;
    scene.media = {coloured_fog(), uniform_medium(glm::dvec3(0.03), glm::dvec3(0))};
    scene.media[1].phase.type = PhaseType::henyey_greenstein;
    scene.media[1].phase.g = 0.4;
    add_map(scene, random_map(), 8);
    PhongMaterial phong;
    phong.diffuse = glm::dvec3(0.3);
    phong.specular = glm::dvec3(0.3);
    phong.exponent = 30;
    add_ball(scene, {0, 0, 0}, 1, 6, phong);
    add_ball(scene, {1, 1.2, 0.5}, 0.8, 7, LambertMaterial{glm::dvec3(0.6)});
    const World closed(scene);
    scene.media.push_back(uniform_medium(glm::dvec3(1e-9), glm::dvec3(0)));
    scene.media.back().bounds = SceneBox{glm::dvec3(-1), glm::dvec3(1)};
    const World mixed(scene);
    ReferenceOptions points;
    points.airlight = RayAirlight::points;
    glm::dvec3 sums[3] = {};
    for (std::uint64_t pixel = 0; pixel < 300; ++pixel) {
        SampleStream place(99, pixel);
        const glm::dvec3 to(3 * place.next() - 1.5, 3 * place.next() - 1.5, 0);
        const glm::dvec3 eye(0.5, 0.3, 4), direction = glm::normalize(to - eye);
        sums[0] += mean_radiance({closed, {}}, eye, direction, 128, pixel).value;
        sums[1] += mean_radiance({closed, points}, eye, direction, 128, pixel).value;
        sums[2] += mean_radiance({mixed, {}}, eye, direction, 128, pixel).value;
    }
    // Noise of 300 pixels: 2e-3 each.
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sums[1][c], sums[0][c], 4e-3 * sums[0][c]) << c;
        EXPECT_NEAR(sums[2][c], sums[0][c], 4e-3 * sums[0][c]) << c;
    }
}

TEST_F(EnvironmentFogTest, LimitedMediaHaveTheMapInfinitelyFar) {
    for (const bool box : {false, true}) {
        Scene scene;
        scene.media = {gaussian_medium({{{0, 0, 0}, 1.2, 0.8}, {{0.7, 0.2, 0}, 2, 0.5}}, 0.9)};
        if (box) {
            scene.media = {coloured_fog()};
            scene.media[0].bounds = SceneBox{glm::dvec3(-1), {1, 2, 1.5}};
        }
        add_triangle(scene, 0.4, LambertMaterial{glm::dvec3(0.5)});
        const Image map = random_map();
        double before = 0;
        for (const double distance : {30.0, 1e4}) {
            add_map(scene, map, distance);
            const World world(scene);
            const ReferenceRenderer renderer(world, {});
            double sum = 0;
            for (std::uint64_t i = 0; i < 20; ++i) {
                const glm::dvec3 direction =
                    glm::normalize(glm::dvec3(0.03 * double(i) - 0.3, 0.1, -1));
                sum += mean_radiance(renderer, {0.3, 0.2, 5}, direction, 2048, i).value.x;
            }
            if (before > 0) {
                EXPECT_NEAR(sum, before, 1e-3 * before) << distance;
            }
            before = sum;
        }
    }
}

}  // namespace
}  // namespace airlight
