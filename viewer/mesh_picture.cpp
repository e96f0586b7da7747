// SPDX-License-Identifier: Apache-2.0
#include "viewer/mesh_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <vector>

#include "core/checked.h"
#include "core/error.h"
#include "core/parallel.h"
#include "viewer/camera.h"
#include "viewer/map_lookup.h"

namespace airlight {
namespace {

constexpr int kMostSamples = 64;
// Pixels of a row whose rays are traced together.
constexpr int kRun = 64;

struct Sphere {
    glm::dvec3 centre{0};
    double radius = 0;
};

Sphere bounding_sphere(const Mesh& mesh) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    const auto for_vertices = [&mesh](const auto& take) {
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner) take(mesh.positions[triangle[corner]]);
        }
        if (mesh.triangles.empty()) {
            for (const glm::dvec3& p : mesh.positions) take(p);
        }
    };
    for_vertices([&](const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    });
    if (!(low.x <= high.x)) return {};
    Sphere sphere{0.5 * low + 0.5 * high, 0};
    for_vertices([&](const glm::dvec3& p) {
        sphere.radius = std::max(sphere.radius, glm::length(p - sphere.centre));
    });
    return sphere;
}

struct Rays {
    std::vector<float> x, y, z;
    std::vector<RayHit> hits;
    std::vector<glm::vec3> radiance;

    explicit Rays(std::size_t count) : x(count), y(count), z(count), hits(count), radiance(count) {}
};

glm::vec3 at_corner(const float* radiance, std::uint32_t vertex) {
    const float* const rgb = radiance + std::size_t{3} * vertex;
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

Camera framing_camera(const Mesh& mesh, double azimuth, double elevation, double vertical_fov,
                      int width, int height) {
    assert(width > 0 && height > 0 && vertical_fov > 0 && vertical_fov < kPi);
    Sphere sphere = bounding_sphere(mesh);
    if (sphere.radius == 0) sphere.radius = 1;
    const double half = std::tan(0.5 * vertical_fov);
    const double narrow = std::atan(half * std::min(1.0, static_cast<double>(width) / height));
    const glm::dvec3 side(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                          std::cos(azimuth) * std::cos(elevation));
    Camera camera;
    camera.look_at = sphere.centre;
    camera.position = sphere.centre + sphere.radius / std::sin(narrow) * side;
    camera.vertical_fov = vertical_fov;
    camera.width = width;
    camera.height = height;
    return camera;
}

Image mesh_picture(const Mesh& mesh, const RayScene& scene, const float* radiance, const Image& map,
                   const Camera& camera, int samples, std::size_t max_memory) {
    if (camera.width < 1 || camera.height < 1 || camera.width > kLargestPicture ||
        camera.height > kLargestPicture) {
        throw Error(ErrorCode::usage, fmt::format("a picture of {} x {} pixels: each must be from "
                                                  "1 to {}",
                                                  camera.width, camera.height, kLargestPicture));
    }
    if (samples < 1 || samples > kMostSamples) {
        throw Error(ErrorCode::usage, fmt::format("{} samples along a pixel: 1 to {} are possible",
                                                  samples, kMostSamples));
    }
    const auto width = static_cast<std::size_t>(camera.width);
    const auto height = static_cast<std::size_t>(camera.height);
    require_memory(checked_product({width, height, 3, sizeof(float)}, "the picture"), max_memory,
                   "the picture");
    const glm::dmat3 axes = camera_axes(camera);
    const glm::vec3 origin = scene.point(camera.position);
    const double step = 2 * std::tan(0.5 * camera.vertical_fov) / (camera.height * samples);
    const int per_pixel = samples * samples;
    const std::size_t runs = (width + kRun - 1) / kRun;
    Image picture(camera.width, camera.height, 3);
    parallel_blocks(runs * height, 1, [&](std::size_t block, std::size_t) {
        const int row = static_cast<int>(block / runs);
        const int first = static_cast<int>(block % runs) * kRun;
        const int count = std::min(kRun, camera.width - first);
        Rays rays(static_cast<std::size_t>(count * per_pixel));
        for (std::size_t i = 0; i < rays.x.size(); ++i) {
            const int ray = static_cast<int>(i), inside = ray % per_pixel;
            const int across = (first + ray / per_pixel) * samples + inside % samples;
            const int down = row * samples + inside / samples;
            rays.x[i] = static_cast<float>((across + 0.5 - 0.5 * camera.width * samples) * step);
            rays.y[i] = static_cast<float>((0.5 * camera.height * samples - down - 0.5) * step);
            rays.z[i] = -1;
        }
        const std::size_t found =
            scene.find_hits(origin, glm::mat3(axes), rays.x.size(), rays.x.data(), rays.y.data(),
                            rays.z.data(), rays.hits.data());
        std::size_t next = 0;
        for (std::size_t i = 0; i < rays.x.size(); ++i) {
            if (next < found && rays.hits[next].ray == i) {
                const RayHit& hit = rays.hits[next++];
                const glm::uvec3& corners = mesh.triangles[hit.triangle];
                rays.radiance[i] = (1 - hit.u - hit.v) * at_corner(radiance, corners.x) +
                                   hit.u * at_corner(radiance, corners.y) +
                                   hit.v * at_corner(radiance, corners.z);
            } else {
                rays.radiance[i] = look_up(map, axes * glm::dvec3(rays.x[i], rays.y[i], rays.z[i]));
            }
        }
        for (int pixel = 0; pixel < count; ++pixel) {
            glm::dvec3 sum(0);
            for (int i = pixel * per_pixel; i < (pixel + 1) * per_pixel; ++i) {
                const glm::vec3& value = rays.radiance[static_cast<std::size_t>(i)];
                for (int c = 0; c < 3; ++c) sum[c] += value[c] < 0 ? 0.0 : double{value[c]};
            }
            for (int c = 0; c < 3; ++c) {
                picture.at(row, first + pixel, c) = static_cast<float>(sum[c] / per_pixel);
            }
        }
    });
    return picture;
}

}  // namespace airlight
