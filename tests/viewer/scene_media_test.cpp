// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_media.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "viewer/medium_depths.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

SceneMedium medium_of(decltype(SceneMedium::kind) kind, std::optional<SceneBox> bounds = {}) {
    SceneMedium medium;
    medium.kind = std::move(kind);
    medium.bounds = bounds;
    return medium;
}

std::vector<SceneMedium> all_kinds() {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> number(-1, 1);
    SceneGaussians few, many;
    for (std::size_t i = 0; i < MediumPart::kFewBlobs + 40; ++i) {
        const GaussianBlob blob = {{number(random), number(random), number(random)},
                                   2 + number(random),
                                   0.5 + 0.5 * number(random)};
        if (i < 5) few.blobs.push_back(blob);
        many.blobs.push_back(blob);
    }
    const SceneBox box = {{-0.5, -1, -0.5}, {1, 1, 2}};
    return {medium_of(SceneUniform{{0.1, 0.2, 0.3}, {0.3, 0.2, 0}}),
            medium_of(SceneUniform{{0.1, 0.2, 0.3}, {0, 0, 0}}, box),
            medium_of(few),
            medium_of(many, box),
            medium_of(SceneExponentialHeight{{0.1, 0.2, 0.3}, 0.7}),
            medium_of(SceneLinearHeight{{0.1, 0.2, 0.3}, {-0.3, -0.2, 0.1}}),
            medium_of(SceneLinearHeight{{0.1, 0.2, 0.3}, {-0.3, -0.2, 0.1}}, box),
            medium_of(SceneAtmosphere{{0, -3, 0}, 2, {1, 2, 3}, 0.5})};
}

TEST(SceneMedia, DepthsAreIntegralsOfDensities) {
    std::vector<SceneMedium> media = all_kinds();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int ray = 0; ray < 20; ++ray) {
        const glm::dvec3 origin(number(random), number(random), number(random));
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(number(random), number(random), number(random)));
        const double distance = std::abs(number(random)) * 2;
        glm::dvec3 sum_of_all(0);
        for (const SceneMedium& medium : media) {
            const MediumPart part(medium);
            glm::dvec3 sum(0);
            constexpr int kSteps = 20000;
            for (int i = 0; i < kSteps; ++i) {
                sum += part.density(origin + (i + 0.5) / kSteps * distance * direction);
            }
            sum *= distance / kSteps;
            const glm::dvec3 depth = part.depth(origin, direction, distance);
            // The midpoint rule errs by half a step where a medium begins.
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(depth[c], sum[c], 5 * distance / kSteps) << medium_type(medium);
            }
            sum_of_all += depth;
        }
        const SceneMedia together(media);
        const glm::dvec3 depth = together.depth(origin, direction, distance);
        const glm::dvec3 left = together.transmittance(origin, direction, distance);
        for (int c = 0; c < 3; ++c) {
            EXPECT_DOUBLE_EQ(depth[c], sum_of_all[c]);
            EXPECT_DOUBLE_EQ(left[c], std::exp(-depth[c]));
        }
    }
}

TEST(SceneMedia, EndlessWaysHaveEndlessDepthsAndNoNan) {
    const SceneMedium fog = medium_of(SceneUniform{{0.1, 0, 0.3}, {0, 0, 0}});
    const glm::dvec3 depth = MediumPart(fog).depth({0, 0, 0}, {0, 1, 0}, kInfinite);
    EXPECT_EQ(depth, glm::dvec3(kInfinite, 0, kInfinite));
    EXPECT_EQ(SceneMedia({fog}).transmittance({0, 0, 0}, {0, 1, 0}, kInfinite),
              glm::dvec3(0, 1, 0));
    for (const SceneMedium& medium : all_kinds()) {
        for (const glm::dvec3& direction : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
                                            glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1)}) {
            for (const double distance : {0.0, 1e-300, 1e300, kInfinite}) {
                const glm::dvec3 all = MediumPart(medium).depth({0, 0, 0}, direction, distance);
                for (int c = 0; c < 3; ++c) EXPECT_GE(all[c], 0) << medium_type(medium);
            }
        }
    }
    EXPECT_EQ(SceneMedia().depth({0, 0, 0}, {0, 1, 0}, kInfinite), glm::dvec3(0));
}

TEST(SceneMedia, DensitiesDeepUnderTheGroundAreNumbers) {
    const glm::dvec3 grey(0.1);
    for (const SceneMedium& medium : {medium_of(SceneAtmosphere{{0, 0, 0}, 1e9, grey, 10}),
                                      medium_of(SceneExponentialHeight{grey, 1e-6}),
                                      medium_of(SceneExponentialHeight{grey, -1e-6})}) {
        for (const double height : {-1.0, 0.0, 1.0}) {
            const double density = MediumPart(medium).density({0, height, 0}).x;
            EXPECT_GE(density, 0) << medium_type(medium);
            EXPECT_EQ(density * 0.0, 0) << medium_type(medium);
        }
    }
}

TEST(SceneMedia, AlbedosArePartsOfTheExtinction) {
    const MediumPart part(medium_of(SceneUniform{{0.1, 0.2, 0}, {0.3, 0, 0}}));
    EXPECT_DOUBLE_EQ(part.albedo().x, 0.25);
    EXPECT_EQ(part.albedo().y, 1);
    EXPECT_EQ(part.albedo().z, 0);
}

TEST(SceneMedia, MarksLieWhereBoxesBeginAndEndAndBlobsAreDense) {
    const SceneMedia media({medium_of(SceneUniform{}, SceneBox{{1, -1, -1}, {2, 1, 1}}),
                            medium_of(SceneUniform{}, SceneBox{{-1, -1, -1}, {1.5, 1, 1}}),
                            medium_of(SceneUniform{}, SceneBox{{1, 2, -1}, {2, 3, 1}})});
    EXPECT_EQ(media.marks({0, 0, 0}, {1, 0, 0}, 10), (std::vector<double>{0, 1, 1.5, 2, 10}));
    EXPECT_EQ(media.marks({0, 0, 0}, {1, 0, 0}, 1.75), (std::vector<double>{0, 1, 1.5, 1.75}));
    EXPECT_EQ(media.marks({0, 0, 0}, {-1, 0, 0}, 10), (std::vector<double>{0, 1, 10}));
    EXPECT_EQ(media.marks({0, 5, 0}, {1, 0, 0}, 10), (std::vector<double>{0, 10}));
    SceneGaussians blobs;
    blobs.blobs = {{{4, 1, 0}, 2, 1}, {{4, 5, 0}, 2, 1}};
    const SceneMedia two({medium_of(blobs)});
    EXPECT_EQ(two.marks({0, 0, 0}, {1, 0, 0}, kInfinite),
              (std::vector<double>{0, 2.5, 3.5, 4.5, 5.5, kInfinite}));
}

TEST(ClipToBox, RaysAlongFacesAreInside) {
    const SceneBox box = {{0, 0, 0}, {1, 1, 1}};
    const auto span = clip_to_box(box, {-1, 0, 0.5}, {1, 0, 0}, kInfinite);
    ASSERT_TRUE(span);
    EXPECT_EQ(span->near, 1);
    EXPECT_EQ(span->far, 2);
    EXPECT_FALSE(clip_to_box(box, {-1, -1e-9, 0.5}, {1, 0, 0}, kInfinite));
    EXPECT_FALSE(clip_to_box(box, {-1, 0.5, 0.5}, {1, 0, 0}, 1));
    EXPECT_FALSE(clip_to_box(box, {-1, 0.5, 0.5}, {-1, -0.0, 0}, kInfinite));
    EXPECT_TRUE(clip_to_box(box, {0.5, 0.5, 0.5}, {1e-300, 1, 0}, kInfinite));
}

TEST(MediumDepths, AnyNumberOfGaussiansInAnyNumberOfMedia) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    for (const std::size_t count : {0, 1, 31, 300, 512, 513}) {
        SceneGaussians blobs;
        for (std::size_t i = 0; i < count; ++i) {
            blobs.blobs.push_back({{number(random), number(random), number(random)}, 2, 0.01});
        }
        const SceneMedia three({medium_of(blobs), medium_of(blobs), medium_of(blobs)});
        const glm::dvec3 origin(0, 0.1, 4), direction(0, 0, -1);
        const double exact = three.depth(origin, direction, 8).x;
        EXPECT_NEAR(MediumDepths(three)(origin, direction, 8).x, exact, 3e-6 * exact + 1e-6);
    }
}

TEST(MediumDepths, SinglePrecisionMissesAHundredThousandthOfTheLight) {
    const double earth = 6.371e6;
    std::vector<SceneMedium> media = all_kinds();
    media.push_back(medium_of(SceneAtmosphere{{0, -earth, 0}, earth, {6e-6, 1.3e-5, 3e-5}, 8000}));
    media.push_back(medium_of(SceneAtmosphere{{0, -2, 0}, 2, glm::dvec3(1), 0.001}));
    media.push_back(medium_of(SceneAtmosphere{{0, -2, 0}, 2, glm::dvec3(1e4), 1e-6}));
    media.push_back(medium_of(SceneExponentialHeight{{10, 20, 30}, -0.001}));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    for (const SceneMedium& medium : media) {
        const SceneMedia one({medium});
        const MediumDepths depths(one);
        const auto* const air = std::get_if<SceneAtmosphere>(&medium.kind);
        // From inside and from up to a thousand times as far.
        for (int i = 0; i < 4000; ++i) {
            const double size = (air ? 1.5 * air->radius : 3) *
                                std::pow(10, i % 2 == 0 ? 0 : 1.5 * (1 + number(random)));
            const auto point = [&](double scale) {
                return scale * glm::dvec3(number(random), number(random), number(random));
            };
            const glm::dvec3 center = air ? air->center : glm::dvec3(0);
            const glm::dvec3 from = center + point(size);
            // Half of the rays aim at the rim of the planet.
            const double rim = air ? air->radius + 5 * air->scale_height * number(random) : 1;
            const glm::dvec3 target =
                i % 4 < 2 ? center + rim * glm::normalize(point(1)) : center + point(size);
            const glm::dvec3 direction = glm::normalize(target - from);
            const double distance =
                i % 5 == 0 ? kInfinite : 2 * glm::length(target - from) * std::abs(number(random));
            const glm::dvec3 left = transmittance_of(one.depth(from, direction, distance));
            const glm::dvec3 found = transmittance_of(depths(from, direction, distance));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(found[c], left[c], 2e-5)
                    << medium_type(medium) << " " << i << " from " << size;
            }
        }
    }
}

}  // namespace
}  // namespace airlight
