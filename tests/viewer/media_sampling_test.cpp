// SPDX-License-Identifier: Apache-2.0
#include "viewer/media_sampling.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/sample_stream.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Every kind of medium, one in a box, one that thickens downwards without end.
SceneMedia mixed_media() {
    SceneMedium fog, steam, layer, air, box;
    fog.kind = SceneUniform{{0.01, 0.02, 0.04}, glm::dvec3(0.001)};
    steam.kind = SceneGaussians{{{{0, 1, 0}, 2, 1.5}, {{3, 0, 1}, 30, 40}}, {}, glm::dvec3(0.9)};
    steam.phase = {PhaseType::henyey_greenstein, 0.6, {}};
    layer.kind = SceneExponentialHeight{glm::dvec3(0.05, 0.06, 0.1), 2, glm::dvec3(1)};
    layer.phase.type = PhaseType::rayleigh;
    air.kind = SceneAtmosphere{{0, -6e6, 0}, 6e6, glm::dvec3(1e-5), 8000, glm::dvec3(1)};
    box.kind = SceneUniform{glm::dvec3(2), glm::dvec3(1)};
    box.bounds = SceneBox{{-1, -1, -1}, {1, 0.5, 1}};
    return SceneMedia({fog, steam, layer, air, box});
}

TEST(MediaSampling, DistancesHaveTheirDepths) {
    const SceneMedia media = mixed_media();
    int found = 0, left = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        SampleStream stream(1, i);
        const auto coordinate = [&] { return 8 * stream.next() - 4; };
        const glm::dvec3 origin(coordinate(), coordinate(), coordinate());
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(coordinate(), coordinate(), coordinate()));
        const double end = i % 3 == 0 ? kInfinite : std::pow(10.0, 5 * stream.next() - 2);
        const int channel = static_cast<int>(i % 3);
        const double depth = -std::log(1 - stream.next());
        const double t = distance_at_depth(media, origin, direction, end, channel, depth);
        if (!(t < end)) {
            EXPECT_LE(media.depth(origin, direction, end)[channel], depth);
            ++left;
            continue;
        }
        ++found;
        EXPECT_NEAR(media.depth(origin, direction, t)[channel], depth, 1e-8 * depth) << i;
    }
    EXPECT_GT(found, 1000);
    EXPECT_GT(left, 500);
}

// Beyond the border of a layer of 1e-12 m depths are endless; where it lies between the distances
// that are tried first matters not.
TEST(MediaSampling, CollisionsAreAtTheBordersOfThinLayers) {
    SceneMedium layer;
    layer.kind = SceneExponentialHeight{glm::dvec3(0.1), 1e-12, glm::dvec3(1)};
    const SceneMedia media({layer});
    const glm::dvec3 direction = glm::normalize(glm::dvec3(1, -1, 0.3));
    for (const double height : {1e-6, 0.3, 1.1, 7.0, 5e3}) {
        const double border = height / -direction.y;
        for (const double end : {1.3 * border, 1.9 * border, 40 * border, kInfinite}) {
            const double t = distance_at_depth(media, {0, height, 0}, direction, end, 1, 1.5);
            EXPECT_NEAR(t, border, 1e-9 + 1e-14 * border) << height << " " << end;
        }
    }
}

TEST(MediaSampling, AnglesFollowTheirDensity) {
    const SceneMedia media = mixed_media();
    MediaPoint point;
    point.move_to(media, {0.2, 0.4, 0.1});
    point.weigh({1, 0.5, 0.2});
    ASSERT_TRUE(point.scatters());
    const auto cosine_below = [&](double cosine) {
        return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
            [&](double x) { return 2 * kPi * point.pdf_at_cosine(x); }, -1.0, cosine, 8, 1e-10);
    };
    EXPECT_NEAR(cosine_below(1), 1, 1e-9);
    constexpr int kSamples = 40000;
    int below[3] = {};
    const double cosines[3] = {-0.5, 0.2, 0.9};
    for (std::uint64_t i = 0; i < kSamples; ++i) {
        SampleStream stream(2, i);
        const double choice = stream.next(), xi = stream.next();
        const double angle = point.sample_angle(choice, xi);
        EXPECT_NEAR(point.pdf_at_angle(angle), point.pdf_at_cosine(std::cos(angle)), 1e-9);
        for (int k = 0; k < 3; ++k) below[k] += std::cos(angle) < cosines[k] ? 1 : 0;
    }
    // Four standard errors of a share of random samples; these are spread evenly.
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(double(below[k]) / kSamples, cosine_below(cosines[k]), 0.01);
    }
}

TEST(MediaSampling, EquiangularPointsFollowTheirDensity) {
    for (const double end : {0.5, 4.0, kInfinite}) {
        const EquiangularPaths paths({0.1, 0, 2}, {0, 0, 0}, {0, 0, 1}, end);
        double before = 0, share = 0;
        for (int i = 1; i < 64; ++i) {
            const double t = paths.distance(i / 64.0);
            share += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
                [&](double x) { return paths.pdf(x); }, before, t, 5, 1e-12);
            EXPECT_NEAR(share, i / 64.0, 1e-9) << end;
            before = t;
        }
    }
}

}  // namespace
}  // namespace airlight
