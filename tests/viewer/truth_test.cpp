// SPDX-License-Identifier: Apache-2.0
// The reference renderer against the integral that it states, summed here from the formulas alone.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "core/constants.h"
#include "envmap/latlong.h"
#include "tests/viewer/scene_fixture.h"
#include "viewer/axes.h"

namespace airlight {
namespace {

constexpr double kFar = 1e4;
using Density = std::function<double(const glm::dvec3&)>;

class TruthTest : public SceneFixture {
  protected:
    /// Rays about -Z, a picture of 8 x 6.
    static std::vector<glm::dvec3> picture() {
        std::vector<glm::dvec3> rays;
        for (int row = 0; row < 6; ++row) {
            for (int column = 0; column < 8; ++column) {
                rays.push_back(
                    glm::normalize(glm::dvec3(0.1 * (column - 3.5), 0.1 * (2.5 - row), -1)));
            }
        }
        return rays;
    }
};

double uniform_depth(double beta, const glm::dvec3& a, const glm::dvec3& b) {
    return beta * glm::length(b - a);
}

// int density between two points: Simpson's rule.
double depth_of(const Density& density, const glm::dvec3& a, const glm::dvec3& b, int steps) {
    double sum = density(a) + density(b);
    for (int i = 1; i < steps; ++i) {
        sum += (i % 2 == 1 ? 4 : 2) * density(a + (b - a) * (double(i) / steps));
    }
    return sum * glm::length(b - a) / (3.0 * steps);
}

// int_0^end sigma(x) / (4 pi) I / r^2 e^{-depths} dt, t = sinh(v) / 2, midpoints in v.
double brute_airlight(const Density& density,
                      const std::function<double(const glm::dvec3&, const glm::dvec3&)>& depth,
                      const glm::dvec3& origin, const glm::dvec3& direction, double end,
                      const PointLight& light, int steps) {
    const double last = std::asinh(2 * end);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double v = last * (i + 0.5) / steps;
        const glm::dvec3 x = origin + 0.5 * std::sinh(v) * direction;
        const glm::dvec3 to_light = light.position - x;
        const double sigma = density(x);
        if (!(sigma > 1e-12)) continue;
        sum += 0.5 * std::cosh(v) * sigma * std::exp(-depth(origin, x) - depth(x, light.position)) /
               glm::dot(to_light, to_light);
    }
    return light.intensity.x / (4 * kPi) * sum * last / steps;
}

// What a Lambertian surface of albedo 1 at +Z sends of a lamp: direct, and by way of the medium in
// polar coordinates about the lamp, where the airlight times the sine is smooth.
double brute_surface(const Density& density,
                     const std::function<double(const glm::dvec3&, const glm::dvec3&)>& depth,
                     const glm::dvec3& at, const PointLight& light, double end, bool zonal,
                     int rings, int steps) {
    const glm::dvec3 to_light = light.position - at, axis = glm::normalize(to_light);
    glm::dvec3 right, up;
    make_axes(axis, right, up);
    double sum = light.intensity.x * axis.z / glm::dot(to_light, to_light) *
                 std::exp(-depth(at, light.position));
    for (int i = 0; i < rings; ++i) {
        const double gamma = kPi * (i + 0.5) / rings;
        double ring = -1;
        for (int j = 0; j < rings; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / rings;
            const glm::dvec3 direction =
                std::cos(gamma) * axis +
                std::sin(gamma) * (std::cos(phi) * right + std::sin(phi) * up);
            if (!(direction.z > 0)) continue;
            // In a uniform medium it depends on gamma alone.
            if (!zonal || ring < 0) {
                ring = brute_airlight(density, depth, at, direction, end, light, steps);
            }
            sum += std::sin(gamma) * direction.z * ring * 2 * kPi * kPi / (double(rings) * rings);
        }
    }
    return sum / kPi;
}

TEST_F(TruthTest, AirlightOfALampInFog) {
    for (const double beta : {0.02, 0.1, 0.5}) {
        Scene scene;
        scene.media = {uniform_medium(glm::dvec3(beta), glm::dvec3(0))};
        scene.lights = {{4.0 * glm::normalize(glm::dvec3(0.21, 0.13, -1)), glm::dvec3(10)}};
        const World world(scene);
        const ReferenceRenderer renderer(world, {});
        double found = 0, expected = 0;
        for (const glm::dvec3& ray : picture()) {
            SampleStream stream(0, 0);
            const double one = renderer.radiance(glm::dvec3(0), ray, stream, counts_).x;
            const double truth = brute_airlight(
                [&](const glm::dvec3&) { return beta; },
                [&](const glm::dvec3& a, const glm::dvec3& b) { return uniform_depth(beta, a, b); },
                glm::dvec3(0), ray, kFar, scene.lights[0], 20000);
            EXPECT_NEAR(one, truth, 1e-3 * truth) << beta;
            found += one;
            expected += truth;
        }
        EXPECT_NEAR(found, expected, 1e-4 * expected) << beta;
    }
}

TEST_F(TruthTest, APlaneBehindFog) {
    for (const double beta : {0.02, 0.1, 0.5}) {
        Scene scene;
        scene.media = {uniform_medium(glm::dvec3(beta), glm::dvec3(0))};
        const glm::dvec3 eye(0, 0, 6);
        scene.lights = {{eye + 4.0 * glm::normalize(glm::dvec3(0.4, 0.3, -1)), glm::dvec3(10)}};
        add_triangle(scene, 3000, LambertMaterial{glm::dvec3(0.6)});
        const World world(scene);
        const ReferenceRenderer renderer(world, {});
        const Density density = [&](const glm::dvec3&) { return beta; };
        const auto depth = [&](const glm::dvec3& a, const glm::dvec3& b) {
            return uniform_depth(beta, a, b);
        };
        double found = 0, expected = 0;
        std::uint64_t pixel = 0;
        for (const glm::dvec3& ray : picture()) {
            const double distance = eye.z / -ray.z;
            const double surface = 0.6 * brute_surface(density, depth, eye + distance * ray,
                                                       scene.lights[0], kFar, true, 100, 500);
            expected += surface * std::exp(-beta * distance) +
                        brute_airlight(density, depth, eye, ray, distance, scene.lights[0], 4000);
            found += mean_radiance(renderer, eye, ray, 2048, ++pixel).value.x;
        }
        EXPECT_NEAR(found, expected, 1e-3 * expected) << beta;
    }
}

TEST_F(TruthTest, FourGaussiansAndALampBeforeAPlane) {
    const std::vector<GaussianBlob> blobs = {{{-1, 0.2, 2}, 0.9, 0.5},
                                             {{0.8, -0.5, 3}, 1.3, 0.9},
                                             {{0.3, 0.9, 1.2}, 1.1, 0.4},
                                             {{0, 0, 2.5}, 0.6, 0.2}};
    const Density density = [&](const glm::dvec3& x) {
        double sum = 0;
        for (const GaussianBlob& blob : blobs) {
            const glm::dvec3 off = x - blob.center;
            sum += blob.amplitude * std::exp(-blob.scale * blob.scale * glm::dot(off, off));
        }
        return sum;
    };
    const auto depth = [&](const glm::dvec3& a, const glm::dvec3& b) {
        return depth_of(density, a, b, 32);
    };
    const glm::dvec3 eye(0, 0, 6);
    for (const bool plane : {false, true}) {
        Scene scene;
        scene.media = {gaussian_medium(blobs)};
        scene.lights = {{{1.2, 0.7, 2}, glm::dvec3(10)}};
        if (plane) add_triangle(scene, 100, LambertMaterial{glm::dvec3(0.6)});
        const World world(scene);
        const ReferenceRenderer renderer(world, {});
        double found = 0, expected = 0;
        const std::vector<glm::dvec3> rays = picture();
        for (std::size_t i = 0; i < rays.size(); i += plane ? 16 : 1) {
            const double distance = plane ? eye.z / -rays[i].z : 20;
            expected +=
                brute_airlight(density, depth, eye, rays[i], distance, scene.lights[0], 1500);
            if (plane) {
                const glm::dvec3 at = eye + distance * rays[i];
                expected += std::exp(-depth(eye, at)) * 0.6 *
                            brute_surface(density, depth, at, scene.lights[0], 10, false, 48, 80);
            }
            found += mean_radiance(renderer, eye, rays[i], plane ? 8192 : 1, i).value.x;
        }
        EXPECT_NEAR(found, expected, 1e-3 * expected) << plane;
    }
}

TEST_F(TruthTest, ABallOfFogUnderAMap) {
    const GaussianBlob ball = {{0, 0, 0}, 1.2, 0.9};
    const Density density = [&](const glm::dvec3& x) {
        return ball.amplitude * std::exp(-ball.scale * ball.scale * glm::dot(x, x));
    };
    std::mt19937_64 random(8);
    Image map(16, 8, 3);
    for (float& value : map.pixels) value = float(std::ldexp(double(random() >> 40), -24));
    Scene scene;
    scene.media = {gaussian_medium({ball}, 0.8)};
    add_map(scene, map, 50);
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    const glm::dvec3 eye(0, 0.5, 4);
    double found = 0, expected = 0;
    for (std::uint64_t i = 0; i < 12; ++i) {
        const glm::dvec3 ray =
            glm::normalize(glm::dvec3(0.06 * double(i) - 0.3, 0.01 * double(i) - 0.15, -1));
        constexpr int kSteps = 60, kParts = 3;
        double sum = 0, before = 0;
        for (int k = 0; k < kSteps; ++k) {
            const double width = 8.0 / kSteps, t = width * (k + 0.5);
            const glm::dvec3 x = eye + t * ray;
            double light = 0;
            for (int row = 0; row < kParts * 8; ++row) {
                for (int column = 0; column < kParts * 16; ++column) {
                    const auto [a, b, c] = pixel_direction(row, column, kParts * 16, kParts * 8);
                    light += pixel_solid_angle(row, kParts * 16, kParts * 8) *
                             map.at(row / kParts, column / kParts, 0) *
                             std::exp(-depth_of(density, x, x + 7.0 * glm::dvec3(a, b, c), 20));
                }
            }
            const double here = density(x) * width;
            sum += 0.8 * here * light / (4 * kPi) * std::exp(-before - here / 2);
            before += here;
        }
        const LatLongPixel p = pixel_of({ray.x, ray.y, ray.z}, 16, 8);
        expected += sum + std::exp(-before) * map.at(p.row, p.column, 0);
        found += mean_radiance(renderer, eye, ray, 4096, i).value.x;
    }
    EXPECT_NEAR(found, expected, 1e-3 * expected);
}

}  // namespace
}  // namespace airlight
