// SPDX-License-Identifier: Apache-2.0
#include "prt/shading.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"
#include "prt/shading_lanes.h"
#include "sh/index.h"

namespace airlight {

ShLight sh_light(int order, const double* coefficients) {
    assert(order >= 0);
    ShLight light{order, std::vector<float>(3 * sh_count(order))};
    std::transform(coefficients, coefficients + light.coefficients.size(),
                   light.coefficients.begin(), [](double c) { return static_cast<float>(c); });
    return light;
}

void shade_transfer(const VertexRows& transfer, const ShLight& light, const glm::vec3& albedo,
                    float* radiance) {
    assert(light.coefficients.size() == 3 * sh_count(light.order));
    const std::size_t stride = sh_count(transfer.order);
    detail::VertexLights lights;
    lights.order = std::min(transfer.order, light.order);
    lights.lights = light.coefficients.data();
    lights.light_stride = sh_count(light.order);
    lights.albedo = albedo;
    parallel_blocks(transfer.count, detail::kShadingBlock, [&](std::size_t begin, std::size_t end) {
        detail::shade_rows(lights, stride, end - begin, transfer.values + begin * stride,
                           radiance + 3 * begin);
    });
}

}  // namespace airlight
