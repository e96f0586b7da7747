// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace airlight {

/// Unit axes x, y that make a right-handed frame with a unit vector z.
inline void make_axes(const glm::dvec3& z, glm::dvec3& x, glm::dvec3& y) {
    const glm::dvec3 other = std::abs(z.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    x = glm::normalize(glm::cross(other, z));
    y = glm::cross(z, x);
}

}  // namespace airlight
