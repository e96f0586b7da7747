// SPDX-License-Identifier: Apache-2.0
// Light and weights of fog as the loops of shading take them.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "prt/fog_shading.h"
#include "prt/shading_lanes.h"
#include "sh/index.h"

namespace airlight::detail {

/// For rows of `order`, of the vertices from number `first` on.
inline VertexLights fog_lights(int order, const FogLight& light, const FogWeights& weights,
                               const glm::vec3& albedo, std::size_t first) {
    assert(light.terms == weights.terms);
    VertexLights out;
    out.order = std::min(order, light.order);
    out.lights = light.coefficients.data();
    out.light_stride = sh_count(light.order);
    out.terms = light.terms;
    out.by_degree = light.by_degree;
    out.weights = weights.values.data() + first;
    out.weight_channels = static_cast<std::size_t>(weights.channels);
    out.weight_stride = weights.vertices;
    out.albedo = albedo;
    return out;
}

}  // namespace airlight::detail
