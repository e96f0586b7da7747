// SPDX-License-Identifier: Apache-2.0
// Rays that go almost the same way, as those of neighbouring pixels do, sixteen at a time.
//
// Answers are Embree's, whose packets may take a ray that grazes a triangle otherwise than
// RayScene's single rays do. The answer for a ray may depend in that on those of its packet, never
// on threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "prt/ray_scene.h"

namespace airlight {

inline constexpr std::uint32_t kNoMesh = 0xffffffff;

/// Where a ray meets a triangle, as in RayHit; `mesh` is kNoMesh where it meets none.
struct PacketHit {
    std::uint32_t mesh = kNoMesh, triangle = 0;
    float u = 0, v = 0;
    float distance = 0;  ///< in world units over the length of the direction; inf without a hit
};

/// The nearest triangle on each of `count` rays from one point in world coordinates; directions
/// are finite and not 0.
void find_nearest_packets(const RayScene& scene, const glm::dvec3& origin, std::size_t count,
                          const float* x, const float* y, const float* z, PacketHit* hits);

/// blocked[i] = 1 where a triangle lies between from[i] and `to`, the ends not counted, else 0.
void find_blocked_packets(const RayScene& scene, std::size_t count, const glm::dvec3* from,
                          const glm::dvec3& to, std::uint8_t* blocked);

}  // namespace airlight
