// SPDX-License-Identifier: Apache-2.0
// From cell to cell of space along a ray.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace airlight {

/// The cells of particles along a ray (medium/particles.h), in their order.
class CellWalk {
  public:
    CellWalk(const glm::dvec3& origin, const glm::dvec3& direction, double cell_size) {
        for (int axis = 0; axis < 3; ++axis) {
            const double at = std::floor(origin[axis] / cell_size);
            cell[axis] = static_cast<std::int64_t>(at);
            step_[axis] = direction[axis] < 0 ? -1 : 1;
            delta_[axis] = cell_size / std::abs(direction[axis]);
            next_[axis] =
                ((at + (direction[axis] > 0 ? 1 : 0)) * cell_size - origin[axis]) / direction[axis];
            if (direction[axis] == 0) next_[axis] = std::numeric_limits<double>::infinity();
        }
    }
    /// The distance at which the ray leaves the cell.
    double end() const { return std::min({next_.x, next_.y, next_.z}); }
    void advance() {
        const int axis = next_.x <= next_.y && next_.x <= next_.z ? 0 : next_.y <= next_.z ? 1 : 2;
        cell[axis] += step_[axis];
        next_[axis] += delta_[axis];
    }

    std::int64_t cell[3];

  private:
    std::int64_t step_[3];
    glm::dvec3 delta_, next_;
};

}  // namespace airlight
