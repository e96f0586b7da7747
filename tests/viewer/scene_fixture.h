// SPDX-License-Identifier: Apache-2.0
// Small scenes with files of their own, for tests of renderers.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/ball.h"
#include "envmap/io.h"
#include "tests/core/scratch_directory.h"
#include "viewer/reference.h"
#include "viewer/scene.h"

namespace airlight {

inline SceneMedium uniform_medium(const glm::dvec3& scattering, const glm::dvec3& absorption) {
    SceneMedium medium;
    medium.kind = SceneUniform{scattering, absorption};
    return medium;
}

inline SceneMedium uniform_medium(double scattering, double absorption) {
    return uniform_medium(glm::dvec3(scattering), glm::dvec3(absorption));
}

inline SceneMedium gaussian_medium(std::vector<GaussianBlob> blobs, double albedo = 1) {
    SceneMedium medium;
    medium.kind = SceneGaussians{std::move(blobs), {}, glm::dvec3(albedo)};
    return medium;
}

class SceneFixture : public testing::Test {
  protected:
    SceneFile file(const std::string& name) const {
        return {directory_ / name, name, "scene.json:1"};
    }

    void add_map(Scene& scene, const Image& map, double distance) const {
        WriteOptions again;
        again.force = true;
        write_image(directory_ / "map.exr", map, again);
        scene.environment = EnvironmentLight{};
        scene.environment->file = file("map.exr");
        scene.environment->distance = distance;
    }

    /// A map of one radiance everywhere.
    void add_sky(Scene& scene, double radiance, double distance) const {
        Image map(8, 4, 3);
        map.pixels.assign(map.pixels.size(), static_cast<float>(radiance));
        add_map(scene, map, distance);
    }

    /// A triangle of that size around the origin that looks at +Z.
    void add_triangle(Scene& scene, double size, const Material& material) const {
        std::ofstream(directory_ / "triangle.obj")
            << "v " << -size << " " << -size << " 0\nv " << 2 * size << " " << -size << " 0\nv 0 "
            << 2 * size << " 0\nf 1 2 3\n";
        SceneObject object;
        object.mesh = file("triangle.obj");
        object.material = material;
        scene.objects.push_back(object);
    }

    /// Of `rings` rings of triangles (bench/ball.h).
    void add_ball(Scene& scene, const glm::dvec3& center, double radius, int rings,
                  const Material& material) const {
        const std::string name = "ball" + std::to_string(rings) + ".obj";
        write_ball(directory_ / name, rings);
        SceneObject ball;
        ball.mesh = file(name);
        ball.material = material;
        ball.transform = glm::dmat4(radius);
        ball.transform[3] = glm::dvec4(center, 1);
        scene.objects.push_back(ball);
    }

    /// The mean of samples of a ray, and its standard error as they show it (smaller, since the
    /// samples are evenly spread).
    struct Mean {
        glm::dvec3 value{0};
        double error = 0;
    };
    Mean mean_radiance(const ReferenceRenderer& renderer, const glm::dvec3& origin,
                       const glm::dvec3& direction, int samples, std::uint64_t pixel = 1) {
        glm::dvec3 sum(0);
        double squares = 0;
        for (int i = 0; i < samples; ++i) {
            SampleStream stream(pixel, static_cast<std::uint64_t>(i));
            const glm::dvec3 sample = renderer.radiance(origin, direction, stream, counts_);
            sum += sample;
            squares += sample.x * sample.x;
        }
        const glm::dvec3 mean = sum / double(samples);
        const double variance = squares / samples - mean.x * mean.x;
        return {mean, std::sqrt(std::max(0.0, variance) / samples)};
    }

    ScratchDirectory directory_;
    ReferenceCounts counts_;
};

}  // namespace airlight
