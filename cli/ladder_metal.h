// SPDX-License-Identifier: Apache-2.0
// What the effective BRDF of a rough metal is measured against, in the ladder and in the benchmark.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "medium/psf.h"
#include "sh/brdf.h"
#include "sh/brdf_models.h"

namespace airlight {

/// E of sh/brdf_fog.h, red, for the metal itself and not its table, by `rows` and `columns`
/// midpoints of the angle from the source, where PSF sin(gamma) is bounded, and about it.
inline double metal_airlight(const RoughMetal& metal, double thickness, const BrdfDirections& at,
                             int rows, int columns) {
    const glm::dvec3 side = glm::normalize(
        glm::cross(at.in, std::abs(at.in.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 other = glm::cross(at.in, side);
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double gamma = kPi * (i + 0.5) / rows;
        const double weight =
            psf(thickness, gamma) * std::sin(gamma) * kPi / rows * 2 * kPi / columns;
        for (int k = 0; k < columns; ++k) {
            const double phi = 2 * kPi * (k + 0.5) / columns;
            const glm::dvec3 in = std::cos(gamma) * at.in +
                                  std::sin(gamma) * (std::cos(phi) * side + std::sin(phi) * other);
            if (in.z > 0) sum += weight * in.z * evaluate_metal(metal, in, at.out).x;
        }
    }
    return sum;
}

}  // namespace airlight
