// SPDX-License-Identifier: Apache-2.0
#include "medium/spherical_rungs.h"

#include <cmath>

#include "medium/chapman_fp32.h"
#include "medium/height_density.h"

namespace airlight {
namespace {

struct Place {
    float radius;
    float cosine;
};

Place at_distance(float r, float cosine, float distance) {
    const float s = distance / r;
    const float square = 1 + s * (s + 2 * cosine);
    return {r * std::sqrt(square), (s + cosine) / std::sqrt(square)};
}

}  // namespace

float spherical_depth_article(float radius, float scale_height, float center_distance,
                              float cos_zenith, float distance) {
    const float n = 1 / scale_height;
    const float z = center_distance * n, big_z = radius * n;
    if (std::isinf(distance)) {
        return detail::rescaled_chapman_fp32(z, big_z, cos_zenith) * scale_height;
    }
    const Place end = at_distance(center_distance, cos_zenith, distance);
    const float start =
        detail::rescaled_chapman_fp32(z, big_z, end.cosine >= 0 ? cos_zenith : -cos_zenith);
    const float end_z = end.radius * n;
    const float beyond =
        detail::chapman_upper_fp32(end_z, std::abs(end.cosine)) * std::exp(big_z - end_z);
    return std::abs(start - beyond) * scale_height;
}

float spherical_distance_article(float radius, float scale_height, float center_distance,
                                 float cos_zenith, float max_distance, float depth) {
    constexpr float kEnough = 1e-4f;
    constexpr int kMostSteps = 4;
    const float n = 1 / scale_height;
    const auto depth_at = [&](float t) {
        return spherical_depth_article(radius, scale_height, center_distance, cos_zenith, t);
    };
    const float whole = depth_at(max_distance);
    float t = max_distance * (depth / whole);
    float bounds[2] = {0, max_distance}, values[2] = {-depth, whole - depth};
    for (int i = 0; i < kMostSteps; ++i) {
        const Place place = at_distance(center_distance, cos_zenith, t);
        const float reached = depth_at(t);
        const float density = std::exp(radius * n - place.radius * n);
        const float f = reached - depth;
        float slope = 1 / (density + 0.5f * f * n * place.cosine);
        float step = -f * slope;
        const int side = f < 0 ? 1 : 0;
        if (!(t + step > bounds[0] && t + step < bounds[1])) {
            slope = (bounds[side] - t) / (values[side] - f);
            step = -f * slope;
            i = kMostSteps;
        }
        bounds[1 - side] = t;
        values[1 - side] = f;
        t += step;
        if (std::abs(f) <= kEnough || std::abs(reached / depth - 1) <= kEnough) break;
    }
    return t;
}

double spherical_depth_flat(const SphericalProfile& profile, const SphericalRay& ray,
                            double distance) {
    return exponential_height_depth(ray.center_distance - profile.radius, ray.cos_zenith, distance,
                                    1 / profile.scale_height);
}

}  // namespace airlight
