// SPDX-License-Identifier: Apache-2.0
// The scenes on which the methods for the airlight of Gaussian media are compared: tests, bench/.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <random>
#include <string_view>
#include <vector>

#include "medium/gaussian_airlight_method.h"

namespace airlight {

struct GaussianScene {
    GaussianMedium medium;
    AirlightRay ray;
    double exact;
};

/// Random scenes of `blobs` blobs: "thin" (amplitudes .02 to .2), "medium" (.1 to .8) or "dense"
/// (.5 to 3). Rays of 4 to 12; scales .5 to 2, centers up to 2 beside the ray; beta0 0, .02 or .05;
/// the light .2 to 5 beside the ray.
inline std::vector<GaussianScene> gaussian_scenes(std::string_view set, int blobs, int count) {
    std::mt19937_64 bits(static_cast<std::uint64_t>(blobs) * 1000 + set.size());
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
    };
    const auto vector = [&] {
        const double x = uniform(-1, 1), y = uniform(-1, 1);
        return glm::dvec3(x, y, uniform(-1, 1));
    };
    const double thinnest = set == "thin" ? .02 : set == "medium" ? .1 : .5;
    const double densest = set == "thin" ? .2 : set == "medium" ? .8 : 3;
    std::vector<GaussianScene> scenes;
    for (int i = 0; i < count; ++i) {
        GaussianScene scene;
        scene.ray.direction = glm::normalize(vector());
        scene.ray.dist = uniform(4, 12);
        const auto beside = [&](double along, double off) {
            const glm::dvec3 side = glm::cross(scene.ray.direction, vector());
            return scene.ray.direction * along + side * (off / glm::length(side));
        };
        scene.ray.light = beside(uniform(-.1, 1.1) * scene.ray.dist, uniform(.2, 5));
        scene.medium.beta0 = i % 3 == 0 ? 0 : i % 3 == 1 ? .02 : .05;
        for (int k = 0; k < blobs; ++k) {
            GaussianBlob blob;
            blob.center = beside(uniform(0, scene.ray.dist), uniform(0, 2));
            blob.scale = uniform(.5, 2);
            blob.amplitude = uniform(thinnest, densest);
            scene.medium.blobs.push_back(blob);
        }
        scene.exact = gaussian_airlight(scene.medium, scene.ray);
        scenes.push_back(scene);
    }
    return scenes;
}

struct ErrorQuantiles {
    double median = 0, p90 = 0, max = 0;
};

/// Errors of `method(scene)` relative to the exact values; a NaN counts as infinite.
template <class Method>
ErrorQuantiles gaussian_scene_errors(const std::vector<GaussianScene>& scenes,
                                     const Method& method) {
    std::vector<double> errors;
    for (const GaussianScene& scene : scenes) {
        const double error = std::abs(method(scene) / scene.exact - 1);
        errors.push_back(std::isnan(error) ? HUGE_VAL : error);
    }
    std::sort(errors.begin(), errors.end());
    return {errors[errors.size() / 2], errors[errors.size() * 9 / 10], errors.back()};
}

/// One rung on one scene.
inline double gaussian_scene_airlight(GaussianAirlightMethod method, const GaussianScene& scene) {
    const GaussianAirlightEvaluator evaluator(method, scene.medium, scene.ray.viewer,
                                              scene.ray.light);
    return evaluator(scene.ray.direction, scene.ray.dist);
}

}  // namespace airlight
