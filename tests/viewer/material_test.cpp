// SPDX-License-Identifier: Apache-2.0
#include "viewer/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "envmap/io.h"
#include "sh/brdf_file.h"
#include "sh/brdf_models.h"
#include "sh/brdf_reflectance.h"
#include "tests/core/scratch_directory.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

constexpr int kSamples = 1 << 16;

SurfaceMaterial tabulated(const BrdfTable& table) {
    return {TabulatedMaterial{}, std::make_shared<BrdfLobe>(table)};
}

glm::dvec3 viewer_at(double theta) {
    return {std::sin(theta) * 0.6, std::cos(theta), -std::sin(theta) * 0.8};
}

// A white sky's share, by drawn directions.
glm::dvec3 reflectance(const SurfaceMaterial& material, double theta) {
    glm::dvec3 sum(0);
    for (int i = 0; i < kSamples; ++i) {
        SampleStream stream(11, static_cast<std::uint64_t>(i));
        const LobeSample lobe = sample_lobe(material, {0, 1, 0}, viewer_at(theta), stream);
        if (!(lobe.pdf > 0)) continue;
        sum += reflect(material, {0, 1, 0}, viewer_at(theta), lobe.direction) / lobe.pdf;
    }
    return sum / double(kSamples);
}

TEST(TabulatedMaterial, AWhiteSkyIsReflectedByTheTablesOwnShare) {
    const BrdfSize size{90, 45, 90};
    for (const double roughness : {0.05, 0.2, 0.6}) {
        RoughMetal metal;
        metal.roughness = roughness;
        const BrdfTable table = tabulate(metal, size);
        const SurfaceMaterial material = tabulated(table);
        for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
            const double theta = degrees * kPi / 180;
            const glm::dvec3 expected = directional_reflectance(table, theta);
            const glm::dvec3 found = reflectance(material, theta);
            for (int c = 0; c < 3; ++c) {
                // The noise of that many samples, spread evenly.
                EXPECT_NEAR(found[c], expected[c], 4e-3 * expected[c]) << roughness << degrees;
                EXPECT_LE(found[c], 1 + 1e-9);
            }
        }
    }
}

TEST(TabulatedMaterial, ALambertianTableIsALambertSurface) {
    const SurfaceMaterial table = tabulated(tabulate_lambertian(0.4, {30, 30, 60}));
    const SurfaceMaterial lambert = {LambertMaterial{glm::dvec3(0.4)}, nullptr};
    for (int i = 0; i < 200; ++i) {
        SampleStream stream(3, static_cast<std::uint64_t>(i));
        const LobeSample viewer = sample_lobe(lambert, {0, 0, 1}, {0, 0, 1}, stream);
        const LobeSample light = sample_lobe(lambert, {0, 0, 1}, {0, 0, 1}, stream);
        const glm::dvec3 a = reflect(table, {0, 0, 1}, viewer.direction, light.direction);
        const glm::dvec3 b = reflect(lambert, {0, 0, 1}, viewer.direction, light.direction);
        EXPECT_NEAR(a.x, b.x, 1e-9);
    }
}

TEST(TabulatedMaterial, DensitiesOfDrawnDirectionsIntegrateToOne) {
    RoughMetal metal;
    metal.roughness = 0.3;
    const SurfaceMaterial material = tabulated(tabulate(metal, {60, 30, 60}));
    const glm::dvec3 viewer = viewer_at(0.7);
    double sum = 0;
    constexpr int kRows = 1200, kColumns = 1200;
    for (int i = 0; i < kRows; ++i) {
        const double y = -1 + 2 * (i + 0.5) / kRows, across = std::sqrt(1 - y * y);
        for (int j = 0; j < kColumns; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / kColumns;
            sum += lobe_pdf(material, {0, 1, 0}, viewer,
                            {across * std::cos(phi), y, across * std::sin(phi)});
        }
    }
    // Half vectors across the view give densities without bound but an integral.
    EXPECT_NEAR(sum * 4 * kPi / (double(kRows) * kColumns), 1, 5e-3);
}

TEST(TabulatedMaterial, AWorldReadsTheFileOfAnObject) {
    const ScratchDirectory directory;
    write_brdf(directory / "metal.binary", tabulate(RoughMetal{}, {90, 45, 90}), false);
    std::ofstream(directory / "triangle.obj") << "v -1 -1 0\nv 2 -1 0\nv 0 2 0\nf 1 2 3\n";
    Image map(8, 4, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 2.0f);
    write_image(directory / "sky.exr", map);
    Scene scene;
    scene.environment = EnvironmentLight{};
    scene.environment->file = {directory / "sky.exr", "sky.exr", "scene.json:1"};
    SceneObject object;
    object.mesh = {directory / "triangle.obj", "triangle.obj", "scene.json:1"};
    object.material =
        TabulatedMaterial{{directory / "metal.binary", "metal.binary", "scene.json:1"}};
    scene.objects = {object, object};
    scene.objects[1].transform[3][2] = -1;
    const World world(scene);
    EXPECT_EQ(world.material(0).table, world.material(1).table);
    const ReferenceRenderer renderer(world, {});
    const glm::dvec3 to_viewer = glm::normalize(glm::dvec3(0.5, 0, 1));
    glm::dvec3 sum(0);
    ReferenceCounts counts;
    constexpr int kFew = 1 << 13;
    for (int i = 0; i < kFew; ++i) {
        SampleStream stream(5, static_cast<std::uint64_t>(i));
        sum += renderer.radiance(2.0 * to_viewer, -to_viewer, stream, counts);
    }
    const glm::dvec3 expected =
        2.0 * directional_reflectance(world.material(0).table->table(), std::acos(to_viewer.z));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kFew, expected[c], 0.01 * expected[c]);
}

}  // namespace
}  // namespace airlight
