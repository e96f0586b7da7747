// SPDX-License-Identifier: Apache-2.0
// Pictures are made of numbers whatever a scene holds.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/viewer/scene_fixture.h"
#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/fast_plan.h"
#include "viewer/medium_depths.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

constexpr int kWidth = 16, kHeight = 9;

FastPicture draw(const World& world, const FastMethods& methods, int width = kWidth) {
    FastPictureOptions options;
    options.samples = 1;
    options.width = width;
    options.height = kHeight;
    return render_fast(world, plan_of_everything(world), methods, options);
}

Image draw_reference(const World& world, Scattering scattering = Scattering::single,
                     int samples = 1) {
    ReferencePictureOptions options;
    options.scattering = scattering;
    options.samples = samples;
    options.width = kWidth;
    options.height = kHeight;
    return render_reference(world, options).image;
}

bool all_finite(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(),
                       [](float value) { return std::isfinite(value); });
}

double largest_of(const Image& image) {
    return double(*std::max_element(image.pixels.begin(), image.pixels.end()));
}

SceneMedium atmosphere(const glm::dvec3& density, double scale_height) {
    SceneMedium medium;
    SceneAtmosphere air;
    air.radius = 6371000;
    air.center = {0, -6371000, 0};
    air.density = density;
    air.scale_height = scale_height;
    medium.kind = air;
    return medium;
}

class CornersTest : public SceneFixture {
  protected:
    Scene lamp_before_the_eye() const {
        Scene scene;
        scene.camera.position = {0, 1, 4};
        scene.camera.look_at = {0, 1, 0};
        scene.lights = {{{1, 2, 0}, glm::dvec3(10)}};
        return scene;
    }
    static FastMethods by(FastGaussians method) {
        FastMethods methods;
        methods.gaussians = method;
        return methods;
    }
};

TEST(EveryExample, IsNumbersByBothEngines) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_SCENES)) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path().stem().string());
        ++scenes;
        const World world(read_scene(entry.path().string()));
        for (const Image& image : {draw(world, {}).image, draw_reference(world)}) {
            EXPECT_TRUE(all_finite(image));
            EXPECT_GT(largest_of(image), 0);
        }
    }
    EXPECT_GE(scenes, 19);
}

// Nothing of a micrometre is told from 10000 km away, but that it is there.
TEST_F(CornersTest, BlobsTooNarrowForTheirDistance) {
    Scene scene = lamp_before_the_eye();
    scene.media = {uniform_medium(glm::dvec3(0.1), glm::dvec3(0)),
                   gaussian_medium({{{0, 1, -1e7}, 1e6, 1e6}, {{0, 1, 0}, 1, 0.5}})};
    const Image truth = draw_reference(World(scene));
    for (const FastGaussians method : {FastGaussians::fogshop, FastGaussians::centroid}) {
        const Image image = draw(World(scene), by(method)).image;
        ASSERT_TRUE(all_finite(image));
        EXPECT_NEAR(largest_of(image), largest_of(truth), 1e-3 * largest_of(truth));
    }
}

// Airlight along a ray through a lamp is endless, and that of a lamp at the eye. The middle pixel
// of an odd number looks at it.
TEST_F(CornersTest, EyesThatLookAtALampOrHoldIt) {
    for (const glm::dvec3& lamp : {glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 4)}) {
        Scene scene = lamp_before_the_eye();
        scene.lights[0].position = lamp;
        for (const auto& blob :
             {GaussianBlob{{0, 1, 0}, 1, 0.5}, GaussianBlob{{0, 1, 0}, 1e6, 1e6}}) {
            scene.media = {uniform_medium(glm::dvec3(0.1), glm::dvec3(0)), gaussian_medium({blob})};
            const World world(scene);
            for (const auto& [method, name] : kFastGaussians) {
                EXPECT_TRUE(all_finite(draw(world, by(method), 15).image)) << name;
            }
        }
    }
}

TEST_F(CornersTest, EyesAtAPlanetsCentreAreInTheDark) {
    for (const double scale_height : {1e-12, 8000.0}) {
        SCOPED_TRACE(scale_height);
        Scene scene = lamp_before_the_eye();
        scene.media = {atmosphere({1e-5, 2e-5, 0}, scale_height)};
        scene.camera.position = {0, -6371000, 0};
        scene.camera.look_at = {1, -6371000, 1};
        add_sky(scene, 1, 100);
        const World world(scene);
        const Image image = draw(world, {}).image;
        EXPECT_TRUE(all_finite(image));
        EXPECT_EQ(image.pixels[0], 0);
        EXPECT_GT(image.pixels[2], 0) << "no blue is absorbed";
        EXPECT_TRUE(all_finite(draw_reference(world, Scattering::multiple)));
    }
}

TEST_F(CornersTest, LayersAndAtmospheresOfAPicometre) {
    SceneMedium layer;
    layer.kind = SceneExponentialHeight{glm::dvec3(0.1), 1e-12, glm::dvec3(1)};
    for (const SceneMedium& thin : {layer, atmosphere(glm::dvec3(0.1), 1e-12)}) {
        Scene scene = lamp_before_the_eye();
        scene.media = {thin, uniform_medium(glm::dvec3(0.2, 0.2, 0.5), glm::dvec3(0, 0.1, 1e19))};
        add_sky(scene, 1, 1.7);
        add_triangle(scene, 1, LambertMaterial{});
        const World world(scene);
        EXPECT_TRUE(all_finite(draw(world, {}).image));
        EXPECT_TRUE(all_finite(draw_reference(world)));
        const Image paths = draw_reference(world, Scattering::multiple, 64);
        EXPECT_TRUE(all_finite(paths));
        EXPECT_GT(largest_of(paths), 0);
    }
}

// One over the square of a distance that rounds to nothing, in each direction from there.
TEST_F(CornersTest, PathsFromALampAreNumbers) {
    Scene scene = lamp_before_the_eye();
    scene.lights[0].position = scene.camera.position;
    scene.media = {uniform_medium(glm::dvec3(1), glm::dvec3(0))};
    const Image image = draw_reference(World(scene), Scattering::multiple, 64);
    ASSERT_TRUE(all_finite(image));
    // A lamp 1e-9 of the ray's unit beside it, 10 / (4 pi) pi / 2 / 1e-9, by the mean of samples
    // within a factor of two of it each.
    EXPECT_LT(largest_of(image), 2.5 * 1.25e9);
}

TEST_F(CornersTest, DepthsFromAPlanetsCentreAreTheClosedForms) {
    Scene scene;
    scene.media = {atmosphere(glm::dvec3(1e-5, 0, 1), 1e6)};
    const SceneMedia media(scene.media);
    const glm::dvec3 center(0, -6371000, 0), direction(0.6, 0, 0.8);
    for (const double distance : {1.0, 1e6, 1e9}) {
        const glm::dvec3 expected = media.depth(center, direction, distance);
        const glm::dvec3 found = MediumDepths(media)(center, direction, distance);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5 * expected[c]);
    }
}

}  // namespace
}  // namespace airlight
