// SPDX-License-Identifier: Apache-2.0
#include "viewer/slabs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>

#include "envmap/io.h"
#include "medium/slab_radiance.h"
#include "tests/core/scratch_directory.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

SceneMedium slab(const SceneBox& box, double ior, double scattering, double absorption) {
    SceneMedium medium;
    medium.kind = SceneSlab{box, ior, glm::dvec3(scattering), glm::dvec3(absorption)};
    return medium;
}

SceneMedium boxed(const SceneBox& box, double scattering, double absorption) {
    SceneMedium medium;
    medium.kind = SceneUniform{glm::dvec3(scattering), glm::dvec3(absorption)};
    medium.bounds = box;
    return medium;
}

class SlabTest : public testing::Test {
  protected:
    void add_sky(Scene& scene, double radiance) {
        Image map(8, 4, 3);
        std::fill(map.pixels.begin(), map.pixels.end(), static_cast<float>(radiance));
        WriteOptions write;
        write.force = true;
        write_image(directory_ / "sky.exr", map, write);
        scene.environment = EnvironmentLight{};
        scene.environment->file = {directory_ / "sky.exr", "sky.exr", "scene.json:1"};
    }
    /// A rectangle at z that looks at +Z, black or of a Lambert albedo.
    void add_wall(Scene& scene, double left, double right, double z, double albedo) {
        const std::string name = "wall" + std::to_string(scene.objects.size()) + ".obj";
        std::ofstream(directory_ / name)
            << "v " << left << " -9 " << z << "\nv " << right << " -9 " << z << "\nv " << right
            << " 9 " << z << "\nv " << left << " 9 " << z << "\nf 1 2 3\nf 1 3 4\n";
        SceneObject object;
        object.mesh = {directory_ / name, name, "scene.json:1"};
        object.material = LambertMaterial{glm::dvec3(albedo)};
        scene.objects.push_back(object);
    }
    glm::dvec3 mean(const World& world, const glm::dvec3& origin, const glm::dvec3& direction,
                    int samples, double quadrature = 1e-4) {
        ReferenceOptions options;
        options.quadrature = quadrature;
        const ReferenceRenderer renderer(world, options);
        glm::dvec3 sum(0);
        for (int i = 0; i < samples; ++i) {
            SampleStream stream(9, static_cast<std::uint64_t>(i));
            sum += renderer.radiance(origin, glm::normalize(direction), stream, counts_);
        }
        return sum / double(samples);
    }

    ScratchDirectory directory_;
    ReferenceCounts counts_;
};

const SceneBox kBox = {{-1, -1, -1}, {1, 1, 1}};
const glm::dvec3 kOrigins[] = {{0.2, 0.3, 4}, {3, 2, 2}, {-0.5, 0.1, 0.4}, {0, 5, 0.3}};
const glm::dvec3 kTargets[] = {{0.1, 0.2, 0}, {0.9, -0.6, 0.2}, {0.3, 0.8, -3}, {-0.4, 0, 1}};

TEST_F(SlabTest, OfIndexOneIsAMediumInABox) {
    Scene scene;
    scene.lights = {{{0.5, 2, 1.5}, {3, 2, 1}}, {{0.4, 0.3, 0.2}, glm::dvec3(1)}};
    add_wall(scene, -0.3, 0.4, -0.5, 0.7);
    add_wall(scene, -3, 3, -3, 0.5);
    Scene other = scene;
    scene.media = {slab(kBox, 1, 0.6, 0.2)};
    other.media = {boxed(kBox, 0.6, 0.2)};
    const World a(scene), b(other);
    for (const glm::dvec3& origin : kOrigins) {
        for (const glm::dvec3& target : kTargets) {
            const glm::dvec3 found = mean(a, origin, target - origin, 64, 1e-9);
            const glm::dvec3 expected = mean(b, origin, target - origin, 64, 1e-9);
            // Shadows in the box are met by rays, which miss their borders by a panel's end.
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(found[c], expected[c], 1e-3 * expected[c] + 1e-12);
            }
        }
    }
    scene.objects.clear();
    other.objects.clear();
    const World clear(scene), clear_other(other);
    for (const glm::dvec3& origin : kOrigins) {
        for (const glm::dvec3& target : kTargets) {
            const glm::dvec3 found = mean(clear, origin, target - origin, 1, 1e-12);
            const glm::dvec3 expected = mean(clear_other, origin, target - origin, 1, 1e-12);
            // Integrands have a kink where the light's way changes from face to face of the box.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 3e-8 * expected[c]);
        }
    }
}

TEST_F(SlabTest, OfIndexOneIsLitByTheMapAsAMediumInABox) {
    Scene scene;
    add_sky(scene, 2);
    Scene other = scene;
    scene.media = {slab(kBox, 1, 0.6, 0.2)};
    other.media = {boxed(kBox, 0.6, 0.2)};
    const World a(scene), b(other);
    for (const glm::dvec3& target : kTargets) {
        const glm::dvec3 found = mean(a, kOrigins[0], target - kOrigins[0], 8192);
        const glm::dvec3 expected = mean(b, kOrigins[0], target - kOrigins[0], 8192);
        EXPECT_NEAR(found.x, expected.x, 5e-3 * expected.x);
    }
}

TEST_F(SlabTest, AWideOneIsThatOfTheClosedForms) {
    for (const double ior : {1.0, 1.33, 2.5}) {
        Scene scene;
        scene.media = {slab({{-500, -2, -500}, {500, 0, 500}}, ior, 0.7, 0.3)};
        scene.lights = {{{0.5, 1.2, -0.4}, glm::dvec3(3)}};
        const World world(scene);
        for (const glm::dvec3& eye : {glm::dvec3(0, 3, 0), glm::dvec3(2, 1, 1),
                                      glm::dvec3(-4, 0.5, 2), glm::dvec3(0.3, 0.1, 0)}) {
            SlabSegment segment;
            segment.exit = {0.1, 0, 0.2};
            segment.to_viewer = glm::normalize(eye - segment.exit);
            const double sine = std::sqrt(1 - segment.to_viewer.y * segment.to_viewer.y) / ior;
            segment.length = 2 / std::sqrt(1 - sine * sine);
            SlabMedium medium;
            medium.scattering = 0.7;
            medium.absorption = 0.3;
            medium.ior_inside = ior;
            const double expected =
                slab_radiance_of_point(medium, segment, scene.lights[0].position, 3);
            const double found = mean(world, eye, -segment.to_viewer, 1, 1e-10).x;
            EXPECT_NEAR(found, expected, 1e-8 * expected) << ior;
        }
    }
}

TEST_F(SlabTest, WaysOfLightObeySnellsLaw) {
    const Slab glass = {kBox, 1.5, glm::dvec3(1), glm::dvec3(1), PhaseFunction::isotropic()};
    const glm::dvec3 light(0.4, 3, 2.5);
    int ways = 0;
    for (int i = 0; i < 200; ++i) {
        SampleStream stream(4, static_cast<std::uint64_t>(i));
        const glm::dvec3 x(2 * stream.next() - 1, 2 * stream.next() - 1, 2 * stream.next() - 1);
        for (const SlabArrival& way : arrivals_of_point(glass, x, light)) {
            ++ways;
            const glm::dvec3 outside = glm::normalize(light - way.entry);
            const int axis = std::abs(std::abs(way.entry.y) - 1) < 1e-12 ? 1 : 2;
            EXPECT_EQ(way.entry[axis], 1);
            for (int other = 0; other < 3; ++other) {
                if (other == axis) continue;
                EXPECT_NEAR(way.to_light[other] * 1.5, outside[other], 1e-12);
                EXPECT_LE(std::abs(way.entry[other]), 1);
            }
            EXPECT_NEAR(glm::length(way.to_light), 1, 1e-12);
            EXPECT_NEAR(glm::length(way.entry - x), way.inside, 1e-12);
            // A direction from so far away is the same light.
            const glm::dvec3 far = 1e7 * glm::normalize(light);
            const SlabArrivals point = arrivals_of_point(glass, x, far);
            const SlabArrivals distant = arrivals_of_direction(glass, x, glm::normalize(light));
            ASSERT_EQ(point.count, distant.count);
            for (int k = 0; k < point.count; ++k) {
                const auto n = static_cast<std::size_t>(k);
                EXPECT_NEAR(point.ways[n].irradiance * 1e14, distant.ways[n].irradiance, 1e-5);
            }
        }
    }
    EXPECT_GT(ways, 150);
}

TEST_F(SlabTest, WhatIsBehindIsSeenShifted) {
    // A plate of thickness 2: a ray at 45 degrees is shifted along the wall behind by
    // 2 (tan 45 - tan(asin(sin 45 / 1.5))).
    const double inside = std::tan(std::asin(std::sqrt(0.5) / 1.5));
    const double hit_x = 1 + 2 * inside + 1;
    Scene scene;
    scene.media = {slab({{-50, -50, -1}, {50, 50, 1}}, 1.5, 0, 0)};
    scene.lights = {{{hit_x, 0, -1.5}, glm::dvec3(1)}};
    add_wall(scene, hit_x - 1e-3, hit_x + 1e-3, -2, 1);
    const World world(scene);
    // From (0, 0, 2) to the plate's face at x = 1, through it and one further to the wall.
    EXPECT_GT(mean(world, {0, 0, 2}, {1, 0, -1}, 1).x, 0.1);
    EXPECT_EQ(mean(world, {0.01, 0, 2}, {1, 0, -1}, 1).x, 0);
    scene.media.clear();
    EXPECT_EQ(mean(World(scene), {0, 0, 2}, {1, 0, -1}, 1).x, 0);
}

TEST_F(SlabTest, ItSendsNoMoreThanAWhiteSky) {
    for (const double ior : {1.0, 1.5, 3.0}) {
        Scene scene;
        add_sky(scene, 1);
        scene.media = {slab(kBox, ior, 2, 0)};
        const World world(scene);
        Scene clear = scene;
        clear.media = {slab(kBox, ior, 0, 0)};
        const World window(clear);
        for (const glm::dvec3& origin : kOrigins) {
            for (const glm::dvec3& target : kTargets) {
                const double found = mean(world, origin, target - origin, 2048).x;
                EXPECT_GT(found, 0);
                // Inside, radiance is up to the square of the index times that outside.
                const bool within = glm::length(origin) < 1;
                EXPECT_LT(found, (within ? ior * ior : 1) * 1.01);
                EXPECT_LE(mean(window, origin, target - origin, 1).x,
                          (within ? ior * ior : 1) * (1 + 1e-9));
            }
        }
    }
}

TEST_F(SlabTest, ObjectsShadeWhatIsBehindThemWithin) {
    Scene scene;
    scene.media = {slab(kBox, 1.3, 1, 0)};
    scene.lights = {{{0, 0, 3}, glm::dvec3(1)}};
    const glm::dvec3 eye(3, 0, -0.5);
    const double lit = mean(World(scene), eye, {-1, 0, 0}, 1).x;
    add_wall(scene, -0.9, 0.9, 0, 0.5);
    const double shaded = mean(World(scene), eye, {-1, 0, 0}, 1).x;
    EXPECT_GT(lit, 0);
    EXPECT_LT(shaded, 0.5 * lit);
}

}  // namespace
}  // namespace airlight
