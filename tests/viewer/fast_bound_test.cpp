// SPDX-License-Identifier: Apache-2.0
// What plans of the fast engine say of their errors, beside the reference, on example scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/picture_compare.h"
#include "viewer/plan.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

constexpr int kWidth = 24, kHeight = 14, kSamples = 16;
constexpr double kTolerances[] = {1e-1, 1e-2, 1e-3};

// Means of the first half of the samples and of all.
struct Halves {
    Image half, all;
};

Halves reference_of(const World& world) {
    PlanOptions whole;
    whole.bounds = false;
    ReferencePictureOptions options;
    options.width = kWidth;
    options.height = kHeight;
    const Plan plan = make_plan(world, whole);
    Halves halves;
    for (Image* const image : {&halves.half, &halves.all}) {
        options.samples = image == &halves.half ? kSamples : 2 * kSamples;
        *image = render_reference(world, plan, options).image;
    }
    return halves;
}

Halves fast_of(const World& world, const Plan& plan) {
    FastPictureOptions options;
    options.width = kWidth;
    options.height = kHeight;
    Halves halves;
    for (Image* const image : {&halves.half, &halves.all}) {
        options.samples = image == &halves.half ? kSamples : 2 * kSamples;
        *image = render_fast(world, plan, fast_methods(plan), options).image;
    }
    return halves;
}

// Root of the mean square over the brightest, of the worst channel. The halves' samples are
// independent, so the mean of the product of their differences is free of noise, but for 0.1 of the
// mean square's with 336 pixels.
double error_without_noise(const Halves& fast, const Halves& truth) {
    double sums[3] = {};
    for (std::size_t i = 0; i < truth.all.pixels.size(); ++i) {
        const double first = double(fast.half.pixels[i]) - double(truth.half.pixels[i]);
        const double both = double(fast.all.pixels[i]) - double(truth.all.pixels[i]);
        sums[i % 3] += first * (2 * both - first);
    }
    const double most = std::max({sums[0], sums[1], sums[2], 0.0});
    return std::sqrt(most / (kWidth * kHeight)) / brightest_of(truth.all);
}

template <class Method, std::size_t count>
int number_of(const NamedMethod<Method> (&rungs)[count], Method method) {
    for (std::size_t i = 0; i < count; ++i) {
        if (rungs[i].method == method) return static_cast<int>(i);
    }
    return -1;
}

std::vector<int> rungs_of(const Plan& plan) {
    const FastMethods methods = fast_methods(plan);
    return {number_of(kFastAirlights, methods.airlight),
            number_of(kFastShafts, methods.shafts),
            number_of(kFastGaussians, methods.gaussians),
            number_of(kFastMapAirlights, methods.map_airlight),
            number_of(kFastSurfaceMaps, methods.surface_map),
            number_of(kFastParticles, methods.particles),
            number_of(kFastSlabs, methods.slab)};
}

class FastBound : public testing::TestWithParam<const char*> {};

TEST_P(FastBound, CoversTheErrorAndShrinksWithTheTolerance) {
    const Scene scene = read_scene(std::string(AIRLIGHT_SCENES) + "/" + GetParam() + ".json");
    const Halves truth = reference_of(World(scene));
    double bound_before = 1e300;
    std::vector<int> rungs_before;
    for (const double tolerance : kTolerances) {
        SCOPED_TRACE(tolerance);
        World world(scene);
        PlanOptions options;
        options.engine = Engine::fast;
        options.tolerance = tolerance;
        options.width = kWidth;
        options.height = kHeight;
        const Plan plan = make_plan(world, options);
        world.set_media(plan.media);
        EXPECT_LE(error_without_noise(fast_of(world, plan), truth), plan.bound());
        // Integrals of the sketches' references are to a tenth of the tolerance, 1e-3 at least.
        EXPECT_LE(plan.bound(), 1.01 * bound_before);
        const std::vector<int> rungs = rungs_of(plan);
        for (std::size_t i = 0; i < rungs_before.size(); ++i) {
            EXPECT_GE(rungs[i], rungs_before[i]) << "rung " << i;
        }
        rungs_before = rungs;
        bound_before = plan.bound();
    }
}
INSTANTIATE_TEST_SUITE_P(Scenes, FastBound,
                         testing::Values("air-ground", "clear-day", "failure-halo", "spheres-fog",
                                         "street-clear", "street-mist"),
                         [](const testing::TestParamInfo<const char*>& scene) {
                             std::string name = scene.param;
                             name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                             return name;
                         });

// Where nothing is sampled, as it is on surfaces, there is a rung for each tolerance and the bound says so.
TEST(FastBounds, MeetsTheToleranceWhereARungCan) {
    for (const char* const name : {"air-ground", "failure-halo"}) {
        Scene scene = read_scene(std::string(AIRLIGHT_SCENES) + "/" + name + ".json");
        scene.objects.clear();
        const World world(scene);
        for (const double tolerance : kTolerances) {
            PlanOptions options;
            options.engine = Engine::fast;
            options.tolerance = tolerance;
            EXPECT_LE(make_plan(world, options).bound(), tolerance) << name;
        }
    }
}

}  // namespace
}  // namespace airlight
