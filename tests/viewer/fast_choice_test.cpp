// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_choice.h"

#include <gtest/gtest.h>

#include "bench/ball.h"
#include "tests/core/scratch_directory.h"
#include "viewer/fast_picture.h"
#include "viewer/fast_plan.h"

namespace airlight {
namespace {

Scene ball_in_fog(const ScratchDirectory& directory) {
    Scene scene;
    scene.camera.position = {0.5, 1.5, 6};
    scene.lights = {{{1, 2, -0.5}, {10, 8, 6}}};
    SceneMedium medium;
    medium.kind = SceneUniform{glm::dvec3(0.08), glm::dvec3(0.02)};
    scene.media = {medium};
    write_ball(directory / "ball.obj", 16);
    SceneObject object;
    object.mesh = {directory / "ball.obj", "ball.obj", "scene.json:1"};
    object.transform[3] = {0.4, 1, 0, 1};
    scene.objects = {object};
    return scene;
}

TEST(FastChoice, ATighterToleranceTakesFinerShadows) {
    const ScratchDirectory directory;
    const World world(ball_in_fog(directory));
    std::vector<FastShafts> chosen;
    for (const double tolerance : {4.0, 1e-3, 1e-6}) {
        Plan plan = plan_of_everything(world);
        plan.tolerance = tolerance;
        choose_fast_methods(world, plan);
        chosen.push_back(fast_methods(plan).shafts);
        EXPECT_EQ(plan[Effect::airlight_point].rung, "closed form");
        EXPECT_GT(plan[Effect::shafts].bound, 0);
    }
    EXPECT_EQ(chosen[0], FastShafts::unshadowed);
    EXPECT_LT(chosen[0], chosen[1]);
    EXPECT_LE(chosen[1], chosen[2]);
    EXPECT_EQ(chosen[2], FastShafts::intervals);
}

TEST(FastChoice, IsTheSameEveryTime) {
    const ScratchDirectory directory;
    const World world(ball_in_fog(directory));
    Plan plans[2] = {plan_of_everything(world), plan_of_everything(world)};
    for (Plan& plan : plans) choose_fast_methods(world, plan);
    for (const auto& [effect, name] : kEffects) {
        EXPECT_EQ(plans[0][effect].rung, plans[1][effect].rung) << name;
        EXPECT_EQ(plans[0][effect].bound, plans[1][effect].bound) << name;
    }
}

// What the plan says of the chosen shadows holds on other rays than the sketch's, against the
// finest rung.
TEST(FastChoice, TheBoundHoldsForThePicture) {
    const ScratchDirectory directory;
    const World world(ball_in_fog(directory));
    Plan plan = plan_of_everything(world);
    plan.tolerance = 0.05;
    choose_fast_methods(world, plan);
    FastPictureOptions options;
    options.width = 40;
    options.height = 30;
    const FastPicture chosen = render_fast(world, plan, fast_methods(plan), options);
    FastMethods finest = fast_methods(plan);
    finest.shafts = FastShafts::intervals;
    const FastPicture exact = render_fast(world, plan, finest, options);
    double most = 0, brightest = 0;
    for (std::size_t i = 0; i < exact.image.pixels.size(); ++i) {
        brightest = std::max(brightest, double(exact.image.pixels[i]));
        most = std::max(most,
                        std::abs(double(exact.image.pixels[i]) - double(chosen.image.pixels[i])));
    }
    EXPECT_LE(most, plan[Effect::shafts].bound * brightest);
}

TEST(FastChoice, WhatAPlanDoesNotNameIsTheMostExact) {
    const FastMethods methods = fast_methods(Plan());
    EXPECT_EQ(methods.shafts, FastShafts::intervals);
    EXPECT_EQ(methods.gaussians, FastGaussians::mixed_gl32);
    EXPECT_EQ(methods.slab, FastSlab::refracted);
}

}  // namespace
}  // namespace airlight
