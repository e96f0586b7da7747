// SPDX-License-Identifier: Apache-2.0
// How far a lamp's light goes, in a cube of directions.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "prt/ray_scene.h"
#include "viewer/ray_shadows.h"

namespace airlight {

/// A map of [Shafts] sec. 3, six sides of it. A texel holds the distance to the nearest triangle
/// along the ray through its middle.
class LampShadowMap {
  public:
    LampShadowMap() = default;
    /// `size` texels on a side of the cube: 24 size^2 bytes, 20 to 50 ns a texel.
    LampShadowMap(const RayScene& scene, const glm::dvec3& lamp, int size);

    /// Whether nothing is known to lie between a point and the lamp. Right but within a texel of
    /// the border of a shadow, and for points as close behind a triangle as it is wide.
    bool sees(const glm::dvec3& point) const;

    /// The parts of a ray that the lamp sees, as RayShadows::lit() has them: of `points` points,
    /// even in the angle at which the lamp sees the ray, those are joined that it sees; borders
    /// between them come from halving. What lies between two points unseen is missed.
    void lit(const glm::dvec3& origin, const glm::dvec3& direction, double distance, int points,
             std::vector<RayInterval>& parts) const;

  private:
    bool sees(const glm::vec3& from_lamp, float scale) const;

    glm::dvec3 lamp_{0};
    int size_ = 0;
    std::vector<float> depths_;  ///< (side, row, column)
};

}  // namespace airlight
