// SPDX-License-Identifier: Apache-2.0
#include "viewer/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "bench/ball.h"
#include "tests/core/scratch_directory.h"
#include "viewer/plan_level.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

SceneMedium uniform(double scattering) {
    SceneMedium medium;
    medium.kind = SceneUniform{glm::dvec3(scattering), glm::dvec3(0)};
    return medium;
}

SceneMedium gaussians(std::vector<GaussianBlob> blobs) {
    SceneMedium medium;
    medium.kind = SceneGaussians{std::move(blobs), {}, glm::dvec3(1)};
    return medium;
}

struct Pictures {
    ReferencePicture planned, whole;
    Plan plan;

    double brightest() const {
        double most = 0;
        for (const float v : whole.image.pixels) most = std::max(most, double(v));
        return most;
    }
    double largest_difference() const {
        double most = 0;
        for (std::size_t i = 0; i < whole.image.pixels.size(); ++i) {
            most = std::max(
                most, std::abs(double(whole.image.pixels[i]) - double(planned.image.pixels[i])));
        }
        return most;
    }
};

Pictures draw(const Scene& scene, int width, int height, int samples, double tolerance = 0) {
    Pictures pictures;
    for (const bool all : {true, false}) {
        World world(scene);
        PlanOptions options;
        options.all = all;
        options.width = width;
        options.height = height;
        options.tolerance = tolerance;
        const Plan plan = make_plan(world, options);
        world.set_media(plan.media);
        ReferencePictureOptions drawing;
        drawing.width = width;
        drawing.height = height;
        drawing.samples = samples;
        drawing.reference.quadrature = plan.quadrature;
        (all ? pictures.whole : pictures.planned) = render_reference(world, plan, drawing);
        if (!all) pictures.plan = plan;
    }
    return pictures;
}

class PlanTest : public testing::Test {
  protected:
    void add_ball(Scene& scene, const glm::dvec3& at) const {
        if (!std::filesystem::exists(directory_ / "ball.obj")) {
            write_ball(directory_ / "ball.obj", 8);
        }
        SceneObject ball;
        ball.mesh = {directory_ / "ball.obj", "ball.obj", "scene.json:1"};
        ball.transform[3] = glm::dvec4(at, 1);
        ball.material = PhongMaterial{glm::dvec3(0.5), glm::dvec3(0.2), 10};
        scene.objects.push_back(ball);
    }
    /// A lamp beside a ball.
    Scene small_scene() const {
        Scene scene;
        scene.camera.position = {0, 0, 6};
        scene.camera.look_at = {0, 0, 0};
        scene.lights = {{{2, 2, 2}, glm::dvec3(10)}};
        add_ball(scene, glm::dvec3(0));
        return scene;
    }
    ScratchDirectory directory_;
};

TEST_F(PlanTest, ClearAirRunsNothingOfTheFog) {
    const Scene scene = read_scene(std::string(AIRLIGHT_SCENES) + "/clear-day.json");
    const World world(scene);
    const Plan plan = make_plan(world);
    for (const Effect effect :
         {Effect::attenuation, Effect::airlight_point, Effect::airlight_gaussians,
          Effect::airlight_environment, Effect::surface_point, Effect::density_height,
          Effect::density_atmosphere, Effect::slab, Effect::shafts, Effect::particles}) {
        EXPECT_FALSE(plan.runs(effect)) << method_name(kEffects, effect);
    }
    EXPECT_TRUE(plan.runs(Effect::surface_environment));
    EXPECT_EQ(plan.level, 0) << "no sketch was needed";
    ReferencePictureOptions options;
    options.width = 32;
    options.height = 18;
    options.samples = 2;
    const ReferencePicture picture = render_reference(world, plan, options);
    EXPECT_GT(picture.counts.rays, 0u);
    EXPECT_EQ(picture.counts.in_media(), 0u);
    EXPECT_EQ(picture.counts.attenuations, 0u);
}

// Both pictures draw the same random numbers for what both evaluate.
TEST_F(PlanTest, EveryExampleAgreesWithEverythingOn) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_SCENES)) {
        if (entry.path().extension() != ".json") continue;
        ++scenes;
        // Dear scenes have fewer pixels.
        const std::string name = entry.path().stem().string();
        const bool dear = name == "failure-shaft" || name == "steam" || name == "slab";
        const int height = name == "failure-shaft" ? 3 : dear ? 5 : 9;
        const Scene scene = read_scene(entry.path().string());
        const Pictures pictures = draw(scene, height * 16 / 9, height, 2);
        EXPECT_LE(pictures.largest_difference(), scene.tolerance * pictures.brightest()) << name;
        EXPECT_LE(pictures.plan.bound(), scene.tolerance) << name;
    }
    EXPECT_GE(scenes, 19);
}

// The bound is on the means of pixels; of many samples, since a few may all lie next to a lamp.
TEST_F(PlanTest, NoDifferenceIsLargerThanTheBound) {
    std::mt19937 random(5);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<>(low, high)(random);
    };
    const auto magnitude = [&](double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    };
    int left_out = 0;
    for (int i = 0; i < 32; ++i) {
        Scene scene;
        scene.camera.position = {0, 0, 6};
        scene.camera.look_at = {0, 0, 0};
        const int lamps = 1 + i % 3;
        for (int k = 0; k < lamps; ++k) {
            const double away = magnitude(1, 300);
            scene.lights.push_back({away * glm::dvec3(between(-1, 1), between(-1, 1), 0.4),
                                    glm::dvec3(magnitude(1e-3, 100))});
        }
        if (i % 4 != 3) scene.media.push_back(uniform(magnitude(1e-9, 0.3)));
        if (i % 2 == 1) {
            std::vector<GaussianBlob> blobs;
            for (int k = 0; k < 6; ++k) {
                blobs.push_back({{between(-40, 40), between(-40, 40), between(-20, 4)},
                                 magnitude(0.2, 3),
                                 magnitude(1e-8, 0.5)});
            }
            scene.media.push_back(gaussians(blobs));
        }
        add_ball(scene, {between(-1, 1), between(-1, 1), 0});
        for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
            const Pictures pictures = draw(scene, 9, 6, 16, tolerance);
            const Plan& plan = pictures.plan;
            left_out += plan.bound() > 1e-9 ? 1 : 0;
            EXPECT_LE(pictures.largest_difference(), (plan.bound() + 2e-6) * pictures.brightest())
                << "scene " << i << " at " << tolerance;
            EXPECT_LE(plan.bound(), tolerance) << "scene " << i;
        }
    }
    EXPECT_GT(left_out, 30) << "the scenes put the bounds to no test";
}

TEST_F(PlanTest, ALampFarAwayIsNotFollowedThroughTheFog) {
    Scene scene = small_scene();
    scene.media = {uniform(1e-3)};
    scene.lights.push_back({{1e5, 1e5, -3e5}, glm::dvec3(10)});
    const Plan plan = make_plan(World(scene));
    ASSERT_EQ(plan.lights.size(), 2u);
    EXPECT_TRUE(plan.lights[0].airlight_point);
    EXPECT_FALSE(plan.lights[1].airlight_point);
    EXPECT_FALSE(plan.lights[1].surface);
    EXPECT_NE(plan[Effect::airlight_point].reason.find("1 of 2 lamps"), std::string::npos);
}

TEST_F(PlanTest, ABlobThatNoRaySeesIsLeftOut) {
    Scene scene = small_scene();
    // The second stands beside the picture, the third behind the camera.
    scene.media = {gaussians({{{0, 0, 0}, 1, 0.3}, {{500, 0, 0}, 1, 0.3}, {{0, 0, 900}, 1, 0.3}})};
    const Plan plan = make_plan(World(scene));
    EXPECT_EQ(plan.blobs_left_out, 2u);
    ASSERT_EQ(plan.media.size(), 1u);
    EXPECT_EQ(std::get<SceneGaussians>(plan.media[0].kind).blobs[0].center, glm::dvec3(0));
}

TEST_F(PlanTest, ThinFogIsClearAirWhereTheToleranceAllowsIt) {
    Scene scene = small_scene();
    scene.media = {uniform(1e-7)};
    const Plan loose = make_plan(World(scene));
    EXPECT_FALSE(loose.runs(Effect::attenuation));
    EXPECT_FALSE(loose.runs(Effect::airlight_point));
    EXPECT_TRUE(loose.media.empty());
    EXPECT_GT(loose.bound(), 0);
    PlanOptions options;
    options.tolerance = 1e-9;
    EXPECT_TRUE(make_plan(World(scene), options).runs(Effect::airlight_point));
}

TEST_F(PlanTest, WhatTheUserLeavesOutIsGone) {
    Scene scene = small_scene();
    scene.media = {uniform(0.05)};
    PlanOptions options;
    options.only.remove(Effect::airlight_point);
    const World world(scene);
    const Plan plan = make_plan(world, options);
    EXPECT_FALSE(plan.runs(Effect::airlight_point));
    EXPECT_EQ(plan[Effect::airlight_point].reason, "left out as asked");
    const ReferenceRenderer with(world, {}), without(world, plan, {});
    SampleStream a(1, 2), b(1, 2);
    ReferenceCounts counts;
    const glm::dvec3 direction(0, 0, -1);
    LayeredRadiance whole = with.layers(scene.camera.position, direction, a, counts);
    const LayeredRadiance part = without.layers(scene.camera.position, direction, b, counts);
    EXPECT_GT(whole[RadianceLayer::airlight_point].x, 0);
    whole[RadianceLayer::airlight_point] = glm::dvec3(0);
    for (std::size_t i = 0; i < kRadianceLayerCount; ++i) {
        EXPECT_EQ(whole.layers[i], part.layers[i]) << kRadianceLayers[i].name;
    }
}

TEST_F(PlanTest, EverythingRunsWhenAsked) {
    const Scene scene = small_scene();
    const World world(scene);
    PlanOptions options;
    options.all = true;
    const Plan plan = make_plan(world, options);
    for (const auto& [effect, name] : kEffects) EXPECT_TRUE(plan.runs(effect)) << name;
    ReferencePictureOptions drawing;
    drawing.width = 8;
    drawing.height = 6;
    drawing.samples = 1;
    const ReferencePicture whole = render_reference(world, plan, drawing);
    EXPECT_GT(whole.counts.in_media(), 0u) << "fog was looked for in clear air";
    const ReferencePicture planned = render_reference(world, make_plan(world), drawing);
    EXPECT_EQ(planned.counts.in_media(), 0u);
    EXPECT_EQ(planned.image.pixels, whole.image.pixels);
}

TEST_F(PlanTest, ObjectsAreDecidedOneByOne) {
    Scene scene = small_scene();
    add_ball(scene, {3, 0, 0});
    scene.objects[1].material = LambertMaterial{};
    add_ball(scene, {-3, 0, 0});
    scene.objects[2].material = PhongMaterial{glm::dvec3(0.5), glm::dvec3(0), 10};
    const Plan plan = make_plan(World(scene));
    EXPECT_TRUE(plan.objects[0].glossy);
    EXPECT_FALSE(plan.objects[1].glossy);
    EXPECT_FALSE(plan.objects[2].glossy) << "its specular part is black";
}

TEST_F(PlanTest, TheLevelIsThatOfThePicture) {
    Scene scene = small_scene();
    scene.media = {uniform(0.05)};
    const World world(scene);
    ReferencePictureOptions drawing;
    drawing.width = 64;
    drawing.height = 48;
    const ReferencePicture picture = render_reference(world, drawing);
    double most = 0;
    for (const float v : picture.image.pixels) most = std::max(most, double(v));
    const double level = picture_level(world, 64, 48);
    EXPECT_LE(level, most);
    EXPECT_GE(level, 0.05 * most);
}

}  // namespace
}  // namespace airlight
