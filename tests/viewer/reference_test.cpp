// SPDX-License-Identifier: Apache-2.0
#include "viewer/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "bench/ball.h"
#include "core/threads.h"
#include "medium/airlight.h"
#include "medium/gaussian_airlight.h"
#include "medium/phase_airlight.h"
#include "medium/shafts.h"
#include "medium/surface_shading.h"
#include "tests/viewer/scene_fixture.h"
#include "viewer/camera.h"
#include "viewer/reference_picture.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

class ReferenceTest : public SceneFixture {
  protected:
    /// A triangle of 200 m that looks up, askew.
    void write_wall(const std::string& name) const {
        std::ofstream(directory_ / name) << "v -99 -20 -99\nv 0 9 99\nv 99 -9 -99\nf 1 2 3\n";
    }
    Scene shady_scene(std::uint64_t seed) const;
};

TEST_F(ReferenceTest, AirlightOfUniformFogIsTheClosedForm) {
    Scene scene;
    scene.media = {uniform_medium(0.3, 0.1)};
    scene.lights = {{{1, 2, 5}, glm::dvec3(10)}, {{0, -0.01, 3}, glm::dvec3(4, 5, 6)}};
    const World world(scene);
    ReferenceOptions options;
    options.quadrature = 1e-8;
    const ReferenceRenderer renderer(world, options);
    const double sigma_t = 0.4;
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1),
                                        glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 0.6, -0.8)}) {
        for (const double distance : {0.01, 1.0, 20.0, kInfinite}) {
            glm::dvec3 expected(0);
            for (const PointLight& light : scene.lights) {
                const double d = glm::length(light.position);
                const double gamma = std::atan2(glm::length(glm::cross(direction, light.position)),
                                                glm::dot(direction, light.position));
                expected += 0.3 * sigma_t * light.intensity *
                            airlight(gamma, sigma_t * d, sigma_t * distance);
            }
            const glm::dvec3 found =
                renderer.airlight_of_lights(glm::dvec3(0), direction, distance, counts_);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-7 * expected[c]);
        }
    }
}

// Narrow places of the ray to which the lamp shines through a blob.
TEST_F(ReferenceTest, ShadowsOfGaussiansAreFound) {
    Scene scene;
    scene.lights = {{{-20, -10.6, 16.7}, glm::dvec3(1)}};
    scene.media = {uniform_medium(0.0012, 0), gaussian_medium({{{-9.2, -9, -0.1}, 0.42, 0.037},
                                                               {{-3.1, -31.3, -17.8}, 0.88, 0.234},
                                                               {{17.6, 38.9, 0.5}, 2.9, 0.227}})};
    const World world(scene);
    ReferenceOptions coarse, fine;
    coarse.quadrature = 2e-4;
    fine.quadrature = 1e-9;
    std::mt19937 random(5);
    std::normal_distribution<> normal;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dvec3 origin(-0.8, 0.2, 1);
        const double found = ReferenceRenderer(world, coarse)
                                 .airlight_of_lights(origin, direction, kInfinite, counts_)
                                 .x;
        const double exact = ReferenceRenderer(world, fine)
                                 .airlight_of_lights(origin, direction, kInfinite, counts_)
                                 .x;
        EXPECT_NEAR(found, exact, 2e-4 * exact);
    }
}

// Most of such a ray is a sliver of the angle at the lamp.
TEST_F(ReferenceTest, RaysThatPassALampCloselyMeetTheirTolerance) {
    Scene scene;
    scene.media = {gaussian_medium({{{0, 0.3, 4}, 0.8, 0.5}})};
    ReferenceOptions coarse, fine;
    coarse.quadrature = 2e-3;
    fine.quadrature = 1e-9;
    for (const double height : {1e-6, 1e-4, 1e-2}) {
        scene.lights = {{{0, height, 0}, glm::dvec3(1)}};
        const World world(scene);
        for (const double z : {0.7, 0.9, 0.99, 1.0}) {
            const glm::dvec3 direction(std::sqrt(1 - z * z), 0, z);
            const auto airlight = [&](const ReferenceOptions& options) {
                return ReferenceRenderer(world, options)
                    .airlight_of_lights(glm::dvec3(0), direction, kInfinite, counts_)
                    .x;
            };
            const double exact = airlight(fine);
            EXPECT_NEAR(airlight(coarse), exact, 2e-3 * exact) << height << " " << z;
        }
    }
}

TEST_F(ReferenceTest, AnAtmosphereIsFoundHoweverFarTheLampIs) {
    Scene scene;
    SceneMedium air;
    air.kind = SceneAtmosphere{{0, -6371000, 0}, 6371000, glm::dvec3(1e-5), 8000, glm::dvec3(1)};
    scene.media = {air};
    const double far = 1e10;
    scene.lights = {{{0.6 * far, 0.8 * far, 0}, glm::dvec3(far * far)}};
    const World world(scene);
    ReferenceOptions options;
    options.quadrature = 1e-6;
    const ReferenceRenderer renderer(world, options);
    for (const glm::dvec3& direction : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0.6, 0.8),
                                        glm::dvec3(-0.8, 0.6, 0), glm::dvec3(0, 0.02, 1)}) {
        const glm::dvec3 unit = glm::normalize(direction), origin(0, 100, 0);
        // Steps of 100 m up to 2000 km, where nothing is left.
        double expected = 0;
        for (int i = 0; i < 20000; ++i) {
            const double t = 100 * (i + 0.5);
            const glm::dvec3 x = origin + t * unit, to_light(0.6, 0.8, 0);
            expected += 100 * world.media().density(x).x / (4 * kPi) *
                        std::exp(-world.media().depth(origin, unit, t).x -
                                 world.media().depth(x, to_light, far).x);
        }
        EXPECT_NEAR(renderer.airlight_of_lights(origin, unit, kInfinite, counts_).x, expected,
                    2e-4 * expected);
    }
}

TEST_F(ReferenceTest, PhaseFunctionsTurnTheRightWay) {
    Scene scene;
    scene.media = {uniform_medium(0.3, 0)};
    scene.media[0].phase.type = PhaseType::henyey_greenstein;
    scene.media[0].phase.g = 0.7;
    scene.lights = {{{1, 0, 3}, glm::dvec3(2)}};
    const World world(scene);
    ReferenceOptions options;
    options.quadrature = 1e-8;
    const ReferenceRenderer renderer(world, options);
    const double d = std::sqrt(10.0);
    for (const double sign : {1.0, -1.0}) {
        const double gamma = sign > 0 ? std::atan2(1.0, 3.0) : kPi - std::atan2(1.0, 3.0);
        const double expected = 0.09 * 2 * airlight_hg(gamma, 0.3 * d, 0.3 * 8, 0.7);
        const double found = renderer.airlight_of_lights(glm::dvec3(0), {0, 0, sign}, 8, counts_).x;
        EXPECT_NEAR(found, expected, 1e-7 * expected) << sign;
    }
}

TEST_F(ReferenceTest, AirlightOfGaussiansIsThatOfTheirQuadrature) {
    GaussianMedium medium{0.05,
                          {{{0.2, 0.1, 2}, 3, 2}, {{-0.5, 0, 4}, 0.7, 0.5}, {{0, 0.01, 6}, 40, 5}}};
    Scene scene;
    scene.media = {uniform_medium(0.05, 0), gaussian_medium(medium.blobs)};
    scene.lights = {{{0.5, 1, 3}, glm::dvec3(1)}};
    const World world(scene);
    ReferenceOptions options;
    options.quadrature = 1e-7;
    const ReferenceRenderer renderer(world, options);
    for (const double distance : {1.0, 5.0, 30.0, kInfinite}) {
        const double expected =
            gaussian_airlight(medium, {{0, 0, 0}, {0.5, 1, 3}, {0, 0, 1}, distance});
        const double found =
            renderer.airlight_of_lights(glm::dvec3(0), {0, 0, 1}, distance, counts_).x;
        EXPECT_NEAR(found, expected, 1e-6 * expected) << distance;
    }
}

TEST_F(ReferenceTest, AMediumInABoxIsThePartOfItsRayInIt) {
    Scene scene;
    scene.media = {uniform_medium(0.4, 0)};
    scene.media[0].bounds = SceneBox{{-10, -10, 2}, {10, 10, 5}};
    scene.lights = {{{0.3, 0, 3}, glm::dvec3(1)}};
    const World world(scene);
    ReferenceOptions options;
    options.quadrature = 1e-8;
    const ReferenceRenderer renderer(world, options);
    // The light is inside, too: the same as from the box's near face on.
    const double gamma = std::atan2(0.3, 1.0), d = std::hypot(0.3, 1.0);
    const double expected = 0.16 * airlight(gamma, 0.4 * d, 0.4 * 3);
    const double found =
        renderer.airlight_of_lights(glm::dvec3(0), {0, 0, 1}, kInfinite, counts_).x;
    EXPECT_NEAR(found, expected, 1e-7 * expected);
}

TEST_F(ReferenceTest, SurfacesInFogAreThoseOfTheClosedForms) {
    // A small triangle: the fog is all around, as the closed form has it.
    Scene scene;
    scene.media = {uniform_medium(0.25, 0.05)};
    scene.lights = {{{1, 0.5, 2}, glm::dvec3(3)}};
    PhongMaterial phong;
    phong.diffuse = glm::dvec3(0.5);
    phong.specular = glm::dvec3(0.3);
    phong.exponent = 10;
    add_triangle(scene, 1e-3, phong);
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    const glm::dvec3 eye(-0.3, 0.2, 1), to_viewer = glm::normalize(eye);
    const SurfaceFog fog = {0.3, 0.25};
    const SurfaceLight light = {{1, 0.5, 2}, 3};
    const SurfacePoint point = {glm::dvec3(0), {0, 0, 1}};
    SurfaceOptions exponent;
    exponent.exponent = 10;
    const double lambert = lambert_surface(point, light, fog, 0.5 / kPi).total();
    const double lobe = phong_surface(point, to_viewer, light, fog, 0.3 * 11 / (2 * kPi),
                                      SurfaceEvaluator(exponent))
                            .total();
    const double d = glm::length(eye), gamma = [&] {
        const glm::dvec3 v = light.position - eye;
        return std::acos(glm::dot(v, -to_viewer) / glm::length(v));
    }();
    const double in_front =
        0.25 * 0.3 * 3 * airlight(gamma, 0.3 * glm::length(light.position - eye), 0.3 * d);
    const double expected = std::exp(-0.3 * d) * (lambert + lobe) + in_front;
    double sum = 0, squares = 0;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i) {
        SampleStream stream(7, static_cast<std::uint64_t>(i));
        const double sample = renderer.radiance(eye, -to_viewer, stream, counts_).x;
        sum += sample;
        squares += sample * sample;
    }
    const double mean = sum / kSamples;
    const double error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    EXPECT_LT(error, 3e-3 * expected);
    // The lobe's hemisphere is the surface's here and the lobe's own in the paper, which takes in
    // a little of what is behind the surface.
    EXPECT_NEAR(mean, expected, 1e-3 * expected + 2 * error);
}

TEST_F(ReferenceTest, AWhiteSkyLightsAFlatSurfaceWithItsAlbedo) {
    Scene scene;
    add_sky(scene, 2, 10);
    add_triangle(scene, 1, LambertMaterial{glm::dvec3(0.25, 0.5, 1)});
    const World world(scene);
    const ReferenceRenderer renderer(world, {});
    glm::dvec3 sum(0);
    constexpr int kSamples = 4096;
    for (int i = 0; i < kSamples; ++i) {
        SampleStream stream(3, static_cast<std::uint64_t>(i));
        sum += renderer.radiance({0, 0, 2}, {0, 0, -1}, stream, counts_);
    }
    for (int c = 0; c < 3; ++c) {
        const double albedo = c == 0 ? 0.25 : c == 1 ? 0.5 : 1;
        EXPECT_NEAR(sum[c] / kSamples, 2 * albedo, 2e-3 * 2 * albedo);
    }
}

TEST_F(ReferenceTest, ObjectsShadeTheMediumBehindThem) {
    Scene scene;
    scene.media = {uniform_medium(0.1, 0)};
    scene.lights = {{{0, 0, 1}, glm::dvec3(1)}};
    add_triangle(scene, 100, LambertMaterial{});
    const World world(scene);
    ReferenceOptions options;
    // The light is before the wall, the ray behind it.
    EXPECT_EQ(
        ReferenceRenderer(world, options).airlight_of_lights({-1, 0, -1}, {1, 0, 0}, 2, counts_).x,
        0);
    options.shadows_in_media = false;
    EXPECT_GT(
        ReferenceRenderer(world, options).airlight_of_lights({-1, 0, -1}, {1, 0, 0}, 2, counts_).x,
        0);
}

// Spheres of few and many triangles and a lone triangle around the origin, lamps among them.
Scene ReferenceTest::shady_scene(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    const auto between = [&](double a, double b) {
        return a + (b - a) * std::ldexp(double(random() >> 11), -53);
    };
    Scene scene;
    add_triangle(scene, 1, LambertMaterial{});
    // One that reaches from behind rays to beyond lamps.
    write_wall("wall.obj");
    SceneObject wall;
    wall.mesh = file("wall.obj");
    wall.transform[3] = {0, between(-2, 2), 0, 1};
    scene.objects.push_back(wall);
    for (int i = 0; i < 4; ++i) {
        const std::string name = "ball" + std::to_string(i) + ".obj";
        write_ball(directory_ / name, 3 << i);
        SceneObject ball;
        ball.mesh = file(name);
        ball.transform = glm::dmat4(between(0.1, 1));
        for (int c = 0; c < 3; ++c) ball.transform[3][c] = between(-2, 2);
        ball.transform[3][3] = 1;
        scene.objects.push_back(ball);
    }
    for (int i = 0; i < 2; ++i) {
        scene.lights.push_back({{between(-3, 3), between(-3, 3), between(-3, 3)},
                                {between(0, 9), between(0, 9), between(0, 9)}});
    }
    return scene;
}

TEST_F(ReferenceTest, PartsOfARayThatALampReachesAreThoseOfShadowRays) {
    int probed = 0, shaded = 0, wrong = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        Scene scene = shady_scene(seed);
        scene.media = {uniform_medium(0.1, 0)};
        const World world(scene);
        ASSERT_NE(world.shadows(), nullptr);
        for (int i = 0; i < 40; ++i) {
            SampleStream stream(seed, static_cast<std::uint64_t>(i));
            const auto coordinate = [&] { return 6 * stream.next() - 3; };
            const glm::dvec3 origin(coordinate(), coordinate(), coordinate());
            const glm::dvec3 direction =
                glm::normalize(glm::dvec3(coordinate(), coordinate(), coordinate()));
            const double distance = i % 3 == 0 ? kInfinite : 8 * stream.next();
            const glm::dvec3 light = scene.lights[0].position;
            std::vector<RayInterval> lit;
            world.shadows()->lit(light, origin, direction, distance, lit);
            for (int k = 0; k < 50; ++k) {
                const double t = std::min(distance, 12.0) * stream.next();
                bool in = false, near = false;
                for (const RayInterval& part : lit) {
                    in = in || (t >= part.begin && t <= part.end);
                    // Embree's own single precision.
                    near = near || std::abs(t - part.begin) < 1e-4 || std::abs(t - part.end) < 1e-4;
                }
                if (near) continue;
                ++probed;
                shaded += in ? 0 : 1;
                wrong += in == world.is_blocked(origin + t * direction, light) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(shaded, probed / 20);
    // Rays along edges, which Embree's rounding puts on either side.
    EXPECT_LE(wrong, probed / 5000) << shaded << " of " << probed;
}

// Seen from far above, they are a ten-thousandth of the ray, and what lies behind is dark.
TEST_F(ReferenceTest, MediaFarAlongARayAreNotMissed) {
    struct Case {
        const char* name;
        SceneMedium medium;
        double reach;  // all that is seen of it is that near to the origin
    };
    std::vector<Case> cases;
    for (const double scale : {1.0, 1e-2}) {
        const glm::dvec3 density(0.3 / scale);
        const double radius = 1e5;
        SceneMedium layer, air, linear, plate = uniform_medium(density, glm::dvec3(0));
        layer.kind = SceneExponentialHeight{density, 2 * scale, glm::dvec3(1)};
        air.kind = SceneAtmosphere{{0, -radius, 0}, radius, density, 2 * scale, glm::dvec3(1)};
        linear.kind = SceneLinearHeight{density, -0.1 * density / scale, glm::dvec3(1)};
        plate.bounds = SceneBox{{-1e4, -scale, -1e4}, {1e4, scale, 1e4}};
        SceneMedium block = uniform_medium(density, glm::dvec3(0));
        block.bounds = SceneBox{glm::dvec3(-20 * scale), glm::dvec3(20 * scale)};
        cases.push_back({"layer", layer, 60 * scale});
        cases.push_back({"air", air, 60 * scale});
        cases.push_back({"linear", linear, 60 * scale});
        cases.push_back({"plate", plate, 3 * scale});
        cases.push_back({"block", block, 40 * scale});
        cases.push_back({"blob", gaussian_medium({{{0, 0, 0}, 1 / scale, density.x}}), 7 * scale});
        cases.push_back({"dense blob", gaussian_medium({{{0, 0, 0}, 0.2 / scale, 1e5 * density.x}}),
                         30 * scale});
        cases.push_back({"blobs",
                         gaussian_medium({{{0, 0, 0}, 1 / scale, density.x},
                                          {{0, 0.4 * scale, 0}, 1.2 / scale, 2 * density.x},
                                          {{0, -1.1 * scale, 0}, 0.9 / scale, density.x}}),
                         8 * scale});
    }
    for (const Case& each : cases) {
        for (const glm::dvec3& lamp :
             {glm::dvec3(1, 4, 0) * each.reach, glm::dvec3(1e7, 2e7, 1e6)}) {
            Scene scene;
            scene.media = {each.medium};
            scene.lights = {{lamp, glm::dvec3(glm::dot(lamp, lamp))}};
            const World world(scene);
            const ReferenceRenderer renderer(world, {});
            for (const double far : {30.0, 3e3, 2e4}) {
                const glm::dvec3 eye(-0.3 * far, far, 0.1 * far);
                const glm::dvec3 direction =
                    glm::normalize(glm::dvec3(0, each.reach / 60, 0) - eye);
                double sum = 0;
                constexpr int kSteps = 40000;
                const double step = 2 * each.reach / kSteps;
                for (int i = 0; i < kSteps; ++i) {
                    const double t = glm::length(eye) - each.reach + (i + 0.5) * step;
                    if (!(t > 0)) continue;
                    const glm::dvec3 x = eye + t * direction, way = lamp - x;
                    const double r = glm::length(way);
                    const double depth = world.media().depth(eye, direction, t).x +
                                         world.media().depth(x, way / r, r).x;
                    if (!(depth < 700)) break;
                    sum += step * world.media().density(x).x * std::exp(-depth) *
                           glm::dot(lamp, lamp) / (4 * kPi * r * r);
                }
                ReferenceCounts counts;
                const double found =
                    renderer.airlight_of_lights(eye, direction, kInfinite, counts).x;
                EXPECT_NEAR(found, sum, 1e-3 * sum)
                    << each.name << " " << each.reach << " " << far << " " << lamp.y;
            }
        }
    }
}

TEST_F(ReferenceTest, LineIntegralsAreWithinTheirTolerance) {
    // Against 1e-8, over media in which each way of summing is taken, shadows among them.
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        Scene scene = shady_scene(seed);
        scene.media = {uniform_medium(0.1, 0.02)};
        if (seed % 3 == 1) {
            scene.media.push_back(gaussian_medium({{{0, 1, 0}, 1.5, 0.8}, {{1, 0, -1}, 4, 2}}));
        }
        if (seed % 3 == 2) {
            scene.media[0].phase.type = PhaseType::henyey_greenstein;
            scene.media[0].phase.g = 0.6;
            scene.media[0].bounds = SceneBox{{-2, -1, -2}, {2, 1, 1}};
        }
        const World world(scene);
        ReferenceOptions exact;
        exact.quadrature = 1e-8;
        for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
            ReferenceOptions options;
            options.quadrature = tolerance;
            for (int i = 0; i < 60; ++i) {
                SampleStream stream(seed, static_cast<std::uint64_t>(i));
                const auto coordinate = [&] { return 6 * stream.next() - 3; };
                const glm::dvec3 origin(coordinate(), coordinate(), coordinate());
                const glm::dvec3 direction =
                    glm::normalize(glm::dvec3(coordinate(), coordinate(), coordinate()));
                const double distance = i % 4 == 0 ? kInfinite : 10 * stream.next();
                const glm::dvec3 expected =
                    ReferenceRenderer(world, exact)
                        .airlight_of_lights(origin, direction, distance, counts_);
                const glm::dvec3 found =
                    ReferenceRenderer(world, options)
                        .airlight_of_lights(origin, direction, distance, counts_);
                const double most = std::max({expected.x, expected.y, expected.z});
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(found[c], expected[c], tolerance * most) << seed << " " << i;
                }
            }
        }
    }
}

TEST_F(ReferenceTest, ClosedFormsAndQuadratureSumTheSameShadows) {
    double by_points = 0, by_parts = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        Scene scene = shady_scene(seed);
        scene.media = {uniform_medium(0.1, 0.02), uniform_medium(0.03, 0)};
        scene.media[1].phase.type = PhaseType::henyey_greenstein;
        scene.media[1].phase.g = -0.4;
        if (seed % 2 == 1) {
            scene.media[0].kind = SceneUniform{{0.1, 0.2, 0.3}, {0.05, 0, 0.01}};
        }
        const World closed(scene);
        // A box around everything is nothing that a closed form has.
        scene.media[0].bounds = SceneBox{glm::dvec3(-1e4), glm::dvec3(1e4)};
        const World summed(scene);
        ReferenceOptions options;
        options.quadrature = 1e-8;
        for (int i = 0; i < 40; ++i) {
            SampleStream stream(seed, static_cast<std::uint64_t>(i));
            const auto coordinate = [&] { return 6 * stream.next() - 3; };
            const glm::dvec3 origin(coordinate(), coordinate(), coordinate());
            const glm::dvec3 direction =
                glm::normalize(glm::dvec3(coordinate(), coordinate(), coordinate()));
            const double distance = 10 * stream.next();
            const glm::dvec3 a = ReferenceRenderer(closed, options)
                                     .airlight_of_lights(origin, direction, distance, counts_);
            const glm::dvec3 b = ReferenceRenderer(summed, options)
                                     .airlight_of_lights(origin, direction, distance, counts_);
            const double most = std::max({b.x, b.y, b.z});
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 3e-8 * most) << seed << " " << i;
            // Shadow rays from points miss some of the shadows, now and then.
            ReferenceOptions points;
            points.airlight = RayAirlight::points;
            points.quadrature = 1e-4;
            const glm::dvec3 p = ReferenceRenderer(summed, points)
                                     .airlight_of_lights(origin, direction, distance, counts_);
            by_points += p.x;
            by_parts += b.x;
        }
    }
    EXPECT_NEAR(by_points, by_parts, 0.01 * by_parts);
}

TEST_F(ReferenceTest, ParticlesSendTheLightThatTheMarchOfShaftsTendsTo) {
    Scene scene;
    scene.media = {uniform_medium(0.05, 0.01)};
    scene.lights = {{{1.3, 2.2, 4.1}, glm::dvec3(3)}};
    scene.shafts = SceneShafts{};
    ReferenceOptions options;
    options.quadrature = 1e-6;
    ShaftOptions march;
    march.steps = 40000;
    march.least_transmittance = 1e-7;
    for (const bool walled : {false, true}) {
        if (walled) add_triangle(scene, 2, LambertMaterial{});
        const World world(scene);
        const ReferenceRenderer renderer(world, options);
        const auto visible = [&](const glm::dvec3& x) {
            return !world.is_blocked(x, scene.lights[0].position);
        };
        double expected = 0, found = 0;
        for (int i = 0; i < 6; ++i) {
            const glm::dvec3 origin(0.3 * i, 0.5, 9 - 2.5 * i);
            const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2 - 0.1 * i, 0.1, -1));
            const ShaftMedium medium = {0.05, 0.01, 1 / (4 * kPi)};
            const ShaftLight light = {scene.lights[0].position, 3};
            const ShaftRay ray = {origin, direction, 12};
            march.particles = true;
            const double both =
                shaft_radiance(medium, light, ray, march, visible, ParticleIrradianceTable());
            march.particles = false;
            const double fog = shaft_radiance(medium, light, ray, march, visible);
            const double ours = renderer.light_of_particles(origin, direction, 12, counts_).x;
            // The march's own steps at the borders of cells and shadows.
            EXPECT_NEAR(ours, both - fog, 2e-3 * (both - fog)) << i;
            expected += both - fog;
            found += ours;
            EXPECT_NEAR(renderer.airlight_of_lights(origin, direction, 12, counts_).x, fog,
                        2e-3 * fog);
            SampleStream stream(0, 0);
            if (!walled) {
                EXPECT_GT(renderer.radiance(origin, direction, stream, counts_).x, both - fog);
            }
        }
        EXPECT_GT(expected, 0);
        EXPECT_NEAR(found, expected, 5e-4 * expected);
    }
}

TEST_F(ReferenceTest, PicturesAreTheSameForAnyNumberOfThreads) {
    Scene scene;
    scene.media = {uniform_medium(0.1, 0)};
    scene.lights = {{{0.5, 1, 2}, glm::dvec3(1)}};
    scene.camera.position = {0, 0, 3};
    scene.camera.look_at = {0, 0, 0};
    add_sky(scene, 1, 10);
    add_triangle(scene, 0.5, PhongMaterial{});
    const World world(scene);
    ReferencePictureOptions options;
    options.width = 24;
    options.height = 16;
    options.samples = 24;
    options.tolerance = 0.04;
    std::vector<float> one;
    {
        const ThreadLimit limit(1);
        one = render_reference(world, options).image.pixels;
    }
    const ThreadLimit limit(3);
    const ReferencePicture picture = render_reference(world, options);
    ASSERT_EQ(picture.image.pixels.size(), one.size());
    EXPECT_EQ(std::memcmp(picture.image.pixels.data(), one.data(), one.size() * sizeof(float)), 0);
    EXPECT_GT(picture.samples, 24u * 16 * kFirstSamples);
    EXPECT_LT(picture.samples, 24u * 16 * 24);
}

TEST(CameraDirection, ThePictureIsNotTurnedOver) {
    Camera camera;
    camera.position = {0, 0, 4};
    camera.look_at = {0, 0, 0};
    camera.vertical_fov = kPi / 2;
    const glm::dmat3 axes = camera_axes(camera);
    const glm::dvec3 middle = camera_direction(camera, axes, 40, 20, 20, 10);
    EXPECT_NEAR(middle.z, -1, 1e-15);
    const glm::dvec3 top = camera_direction(camera, axes, 40, 20, 20, 0);
    EXPECT_NEAR(top.y, std::sqrt(0.5), 1e-15);
    // Looking along -Z with +Y up, +X is to the right.
    const glm::dvec3 right = camera_direction(camera, axes, 40, 20, 30, 10);
    EXPECT_NEAR(right.x, std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace airlight
