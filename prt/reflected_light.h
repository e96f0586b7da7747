// SPDX-License-Identifier: Apache-2.0
// What the blocked directions of vertices give back; for sources only.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "prt/bake.h"
#include "prt/blocked_sums.h"
#include "prt/ray_scene.h"

namespace airlight::detail {

/// Sums of (1/pi) w (n omega) rho t(q) over blocked directions, q the nearest point on their ray.
/// For one thread.
class ReflectedLight {
  public:
    ReflectedLight(const RayScene& scene, const std::vector<Reflector>& reflectors, int order);

    /// False where every reflector is black: add() then adds nothing.
    bool any() const { return any_; }

    /// Adds to sum[order^2] what comes back to a vertex whose rays have this origin and frame.
    void add(const glm::vec3& origin, const glm::mat3& frame, const Samples& blocked, double* sum);

  private:
    const RayScene& scene_;
    const std::vector<Reflector>& reflectors_;
    std::size_t size_;
    bool any_;
    std::vector<RayHit> hits_;
};

}  // namespace airlight::detail
