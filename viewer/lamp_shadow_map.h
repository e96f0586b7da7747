// SPDX-License-Identifier: Apache-2.0
// How far a lamp's light goes, in a cube of directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "prt/ray_scene.h"

namespace airlight {

/// Rays from one point, in columns of whole vectors: those from `count` on have the distance 0.
struct RayColumns {
    static constexpr std::size_t kSize = 256;

    std::size_t count = 0;
    /// Of unit directions, and to where the rays end, in [0, inf]; nothing is asked of those that
    /// end at 0.
    alignas(64) float x[kSize] = {}, y[kSize] = {}, z[kSize] = {}, distance[kSize] = {};
};

/// A part of a ray that a lamp reaches.
struct LitPart {
    std::uint32_t ray = 0;
    double begin = 0, end = 0;
};

/// A map of [Shafts] sec. 3, six sides of it. A texel holds the distance to the nearest triangle
/// along the ray through its middle.
class LampShadowMap {
  public:
    /// Points on a ray: a power of two.
    static constexpr int kMostPoints = 64;

    LampShadowMap() = default;
    /// `size` texels on a side of the cube: 24 size^2 bytes, 20 to 50 ns a texel.
    LampShadowMap(const RayScene& scene, const glm::dvec3& lamp, int size);

    /// Whether nothing is known to lie between a point and the lamp. Right but within a texel of
    /// the border of a shadow, and for points as close behind a triangle as it is wide.
    bool sees(const glm::dvec3& point) const;

    /// Appends the parts of rays from `origin` that the lamp sees, ray by ray and ascending: of
    /// `points` points, even in the angle at which the lamp sees the ray, those are joined that it
    /// sees; borders between them come from halving, to 1/64 of the angle between two. What lies
    /// between two points unseen is missed. In floats, a vector of rays at a time.
    ///
    /// Cost per ray with 256 texels a side and AVX-512: 5 to 60 ns with 16 points, 55 to 130 with
    /// 64, where a point at a time took 250 to 1000. Look-ups take most of it: no order of the
    /// texels was faster, by lines or by tiles of 4 x 4, nor was a reciprocal in place of the
    /// division.
    void lit(const glm::dvec3& origin, const RayColumns& rays, int points,
             std::vector<LitPart>& parts) const;

  private:
    glm::dvec3 lamp_{0};
    int size_ = 0;
    std::vector<float> depths_;  ///< (side, row, column)
};

}  // namespace airlight
