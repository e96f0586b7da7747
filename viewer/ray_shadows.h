// SPDX-License-Identifier: Apache-2.0
// Which parts of a ray a point light does not reach, exactly.
//
// The ray and the light span a plane. A triangle cuts it in a segment, which shades an interval of
// the ray; the union of these is the shadow, whatever the size of its pieces: nothing is probed.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/checked.h"
#include "prt/mesh.h"
#include "viewer/shadow_lanes.h"

namespace airlight {

/// An interval of a ray, in distance from its origin.
struct RayInterval {
    double begin = 0, end = 0;
};

/// The triangles of some meshes, ordered by a tree of boxes. Immutable; any thread may ask.
class RayShadows {
  public:
    /// Copies the corners. 80 bytes a triangle, 180 while it is built; throws Error(memory) beyond
    /// max_memory.
    explicit RayShadows(const std::vector<Mesh>& meshes,
                        std::size_t max_memory = kDefaultMaxMemory);

    /// The parts of a ray between 0 and `distance`, in (0, inf], from which a segment to `light`
    /// meets no triangle: ascending and apart. `direction` is unit. Ends of parts are right to
    /// rounding, 1e-15 of the coordinates over the sine of the angle between triangle and light;
    /// gaps of under 1e-12 of the place are closed. Triangles in the plane of ray and light shade
    /// nothing. Cost: a visit to all boxes that the triangle of ray and light touches and that lie
    /// outside the largest shadow found so far.
    void lit(const glm::dvec3& light, const glm::dvec3& origin, const glm::dvec3& direction,
             double distance, std::vector<RayInterval>& parts) const;

  private:
    using Corners = std::array<glm::dvec3, 3>;
    std::uint32_t build(Corners* first, Corners* last);

    std::vector<detail::ShadowBoxes> boxes_;
    std::vector<detail::ShadowTriangles> triangles_;
    std::uint32_t root_ = 0;
};

}  // namespace airlight
