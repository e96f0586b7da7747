// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "core/error.h"
#include "core/threads.h"
#include "envmap/latlong.h"
#include "tests/prt/shapes.h"
#include "viewer/map_lookup.h"

namespace airlight {
namespace {

constexpr double kFov = 0.6;

Image grey_map(float value) {
    Image map(8, 4, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), value);
    return map;
}

// A value of its own for each pixel and channel.
Image numbered_map() {
    Image map(8, 4, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) map.pixels[i] = static_cast<float>(i);
    return map;
}

std::vector<float> constant_radiance(const Mesh& mesh, const glm::vec3& value) {
    std::vector<float> radiance;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        radiance.insert(radiance.end(), {value.x, value.y, value.z});
    }
    return radiance;
}

Image picture(const Mesh& mesh, const std::vector<float>& radiance, const Image& map,
              const Camera& camera, int samples = 2) {
    return mesh_picture(mesh, RayScene(mesh), radiance.data(), map, camera, samples);
}

TEST(MapLookup, IsTheMapAtPixelCentresAndLinearInBetween) {
    const Image map = numbered_map();
    for (int row = 0; row < map.height; ++row) {
        for (int column = 0; column < map.width; ++column) {
            const auto [x, y, z] = pixel_direction(row, column, map.width, map.height);
            const glm::vec3 value = look_up(map, 3.0 * glm::dvec3(x, y, z));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], map.at(row, column, c), 1e-4);
        }
    }
    const auto [x, y, z] = direction_of(3.25 / 8, 2.0 / 4);
    const double between =
        0.125 * (map.at(1, 2, 1) + map.at(2, 2, 1)) + 0.375 * (map.at(1, 3, 1) + map.at(2, 3, 1));
    EXPECT_NEAR(look_up(map, {x, y, z}).y, between, 1e-4);
}

TEST(MapLookup, GoesOnAcrossTheSeamAndThePoles) {
    const Image map = numbered_map();
    const auto [x, y, z] = direction_of(0, 1.5 / 4);
    EXPECT_NEAR(look_up(map, {x, y, z}).x, 0.5 * (map.at(1, 7, 0) + map.at(1, 0, 0)), 1e-4);
    // At a pole the columns on both sides meet; the pole's own column is 4, seen along +Z.
    const double up =
        0.25 * (map.at(0, 3, 0) + map.at(0, 4, 0) + map.at(0, 7, 0) + map.at(0, 0, 0));
    EXPECT_NEAR(look_up(map, {0, 1, 0}).x, up, 1e-4);
    const double down =
        0.25 * (map.at(3, 3, 2) + map.at(3, 4, 2) + map.at(3, 7, 2) + map.at(3, 0, 2));
    EXPECT_NEAR(look_up(map, {0, -2, 0}).z, down, 1e-4);
}

TEST(FramingCamera, LooksAtTheSphereAroundTheMeshFromTheGivenSide) {
    Mesh ball = make_sphere(12, 2, {5, -1, 3});
    ball.positions.emplace_back(100, 0, 0);  // of no triangle
    for (const auto& [azimuth, elevation, side] :
         {std::tuple{0.0, 0.0, glm::dvec3(0, 0, 1)},
          {kPi / 2, 0.0, glm::dvec3(1, 0, 0)},
          {0.0, kPi / 6, glm::dvec3(0, 0.5, std::sqrt(0.75))}}) {
        const Camera camera = framing_camera(ball, azimuth, elevation, kFov, 300, 200);
        const glm::dvec3 way = camera.position - glm::dvec3(5, -1, 3);
        EXPECT_LT(glm::length(camera.look_at - glm::dvec3(5, -1, 3)), 1e-12);
        EXPECT_LT(glm::length(glm::normalize(way) - side), 1e-12);
        // The nearer borders, here upper and lower, touch the sphere.
        EXPECT_NEAR(glm::length(way) * std::sin(kFov / 2), 2, 1e-12);
        const Camera high = framing_camera(ball, azimuth, elevation, kFov, 200, 400);
        const double across = std::atan(0.5 * std::tan(kFov / 2));
        EXPECT_NEAR(glm::length(high.position - high.look_at) * std::sin(across), 2, 1e-12);
    }
    EXPECT_GT(glm::length(framing_camera(Mesh(), 0, 0, kFov, 4, 4).position), 1);
}

// A plane at z = 0 whose radiance grows with x, with y and not at all.
TEST(MeshPicture, ShowsRadianceInterpolatedWithinTriangles) {
    const Mesh quad = make_quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
    std::vector<float> radiance;
    for (const glm::dvec3& p : quad.positions) {
        radiance.insert(radiance.end(), {float(10 + p.x), float(20 + p.y), 5.0f});
    }
    Camera camera;
    camera.position = {0, 0, 4};
    camera.look_at = {0, 0, 0};
    camera.vertical_fov = kFov;
    camera.width = 30;
    camera.height = 20;
    const Image image = picture(quad, radiance, grey_map(0), camera, 1);
    const double step = 4 * 2 * std::tan(kFov / 2) / 20;
    for (int row = 0; row < 20; ++row) {
        for (int column = 0; column < 30; ++column) {
            // Seen from +Z, +X is to the right and +Y at the top.
            EXPECT_NEAR(image.at(row, column, 0), 10 + (column + 0.5 - 15) * step, 1e-5);
            EXPECT_NEAR(image.at(row, column, 1), 20 + (10 - row - 0.5) * step, 1e-5);
            EXPECT_NEAR(image.at(row, column, 2), 5, 1e-5);
        }
    }
}

TEST(MeshPicture, BehindTheMeshIsTheMap) {
    const Mesh ball = make_sphere(40);
    const Image map = numbered_map();
    Camera camera = framing_camera(ball, 0.3, 0.4, 1.0, 60, 40);
    camera.position *= 1.5;
    const Image image = picture(ball, constant_radiance(ball, {500, 600, 700}), map, camera, 1);
    const double distance = glm::length(camera.position);
    const glm::dvec3 view = -camera.position / distance;
    const glm::dvec3 right = glm::normalize(glm::cross(view, camera.up));
    const glm::dvec3 up = glm::cross(right, view);
    int seen = 0, missed = 0;
    for (int row = 0; row < 40; ++row) {
        for (int column = 0; column < 60; ++column) {
            const double step = 2 * std::tan(0.5) / 40;
            const glm::dvec3 ray = glm::normalize(view + (column + 0.5 - 30) * step * right +
                                                  (20 - row - 0.5) * step * up);
            const double nearest = glm::length(glm::cross(camera.position, ray));
            if (nearest < 0.98) {
                ++seen;
                EXPECT_NEAR(image.at(row, column, 0), 500, 1e-3);
                EXPECT_NEAR(image.at(row, column, 2), 700, 1e-3);
            } else if (nearest > 1.001) {
                ++missed;
                const glm::vec3 behind = look_up(map, ray);
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(image.at(row, column, c), behind[c], 2e-3);
                }
            }
        }
    }
    EXPECT_GT(seen, 300);
    EXPECT_GT(missed, 1000);
}

TEST(MeshPicture, PixelsAreTheMeanOfTheirRays) {
    const Mesh ball = make_sphere(60);
    const Camera camera = framing_camera(ball, 0, 0, kFov, 40, 40);
    const Image image =
        picture(ball, constant_radiance(ball, glm::vec3(1)), grey_map(0), camera, 8);
    double area = 0;
    int partial = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        area += double{image.pixels[i]};
        partial += image.pixels[i] > 0 && image.pixels[i] < 1 ? 1 : 0;
    }
    // The circle touches the border.
    EXPECT_NEAR(area, kPi * 400, 0.005 * kPi * 400);
    EXPECT_GT(partial, 80);
}

// Light of few degrees makes single vertices negative, and lossy files pixels.
TEST(MeshPicture, IsNeverNegative) {
    const Mesh ball = make_sphere(10);
    const Camera camera = framing_camera(ball, 0, 0, kFov, 20, 20);
    std::vector<float> radiance = constant_radiance(ball, glm::vec3(1));
    for (std::size_t i = 0; i < radiance.size() / 2; ++i) radiance[i] = -3;
    const Image image = picture(ball, radiance, grey_map(-1), camera);
    EXPECT_EQ(*std::min_element(image.pixels.begin(), image.pixels.end()), 0.0f);
    EXPECT_NEAR(*std::max_element(image.pixels.begin(), image.pixels.end()), 1, 1e-6);
}

TEST(MeshPicture, PlaceAndUnitsOfTheMeshDoNotMatter) {
    const Mesh ball = make_sphere(10);
    const std::vector<float> radiance = constant_radiance(ball, {1, 2, 3});
    const Image map = numbered_map();
    const Image here = picture(ball, radiance, map, framing_camera(ball, 1, 0.5, kFov, 40, 30));
    const Mesh there =
        moved(ball, [](const glm::dvec3& p) { return 1e-3 * p + glm::dvec3(1e5, -2e5, 7e4); });
    const Image far = picture(there, radiance, map, framing_camera(there, 1, 0.5, kFov, 40, 30));
    int different = 0;
    for (std::size_t i = 0; i < here.pixels.size(); ++i) {
        different += std::abs(here.pixels[i] - far.pixels[i]) > 1e-2f ? 1 : 0;
    }
    EXPECT_LT(different, 30) << "of 3600, at the silhouette alone";
}

TEST(MeshPicture, BytesDoNotDependOnThreads) {
    const Mesh ball = make_sphere(10);
    const std::vector<float> radiance = constant_radiance(ball, {1, 2, 3});
    const Camera camera = framing_camera(ball, 1, 0.5, kFov, 150, 100);
    const Image image = picture(ball, radiance, numbered_map(), camera);
    const ThreadLimit one(1);
    EXPECT_EQ(picture(ball, radiance, numbered_map(), camera).pixels, image.pixels);
}

TEST(MeshPicture, CamerasThatSeeNothingAreRefused) {
    const Mesh ball = make_sphere(4);
    const std::vector<float> radiance = constant_radiance(ball, {1, 2, 3});
    const Camera good = framing_camera(ball, 0, 0, kFov, 20, 20);
    Camera bad = good;
    bad.up = good.position;
    EXPECT_THROW(picture(ball, radiance, grey_map(0), bad), Error);
    bad = good;
    bad.look_at = good.position;
    EXPECT_THROW(picture(ball, radiance, grey_map(0), bad), Error);
    bad = good;
    bad.width = 0;
    EXPECT_THROW(picture(ball, radiance, grey_map(0), bad), Error);
    EXPECT_THROW(picture(ball, radiance, grey_map(0), good, 65), Error);
    EXPECT_THROW(mesh_picture(ball, RayScene(ball), radiance.data(), grey_map(0), good, 1, 1000),
                 Error);
}

}  // namespace
}  // namespace airlight
