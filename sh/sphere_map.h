// SPDX-License-Identifier: Apache-2.0
// Functions of three channels on the sphere, from their coefficients, to be looked up anywhere.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "sh/transform.h"

namespace airlight {

/// A lat-long map of three channels about the z axis, filled from SH coefficients and looked up by
/// four-point Lagrange interpolation in both angles, across the poles and around the seam.
///
/// A band of degree l errs by up to 0.023 (pi l / rows)^4 of itself per axis. Measured on random
/// bands with rows = 4 order, over the largest value: 0.4 % for the highest, 0.05 % half as high.
class SphereMap {
  public:
    /// order >= 1, rows >= order and at least 4.
    SphereMap(int order, int rows);

    /// Bytes of the map and of making it.
    static std::size_t memory(int rows);

    /// coefficients: (3, order^2), slots as in sh/index.h, basis (x, y, z) as lookups have it.
    void fill(const double* coefficients);

    /// The channels at a direction, which need not be unit.
    glm::dvec3 operator()(const glm::dvec3& direction) const;

  private:
    int rows_;
    SphericalTransform transform_;
    std::vector<double> map_;  // (rows, 2 rows, 3)
};

}  // namespace airlight
