// SPDX-License-Identifier: Apache-2.0
// A tabulated BRDF as a material: its value and directions that it is large for.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "sh/brdf.h"

namespace airlight {

/// Directions are drawn by a half vector, which mirrors the view: for narrow lobes that is about
/// the mirror direction, for wide ones about the normal. The angle theta_h of the half vector to
/// the normal has in each cell of the table the density of its mean value there times cos(theta_h).
/// Unit directions of the world; the table is that of sh/brdf.h, looked up linearly.
class BrdfLobe {
  public:
    explicit BrdfLobe(BrdfTable table);

    const BrdfTable& table() const { return table_; }
    /// The largest value in it [1/sr].
    double most() const { return most_; }

    /// f [1/sr]; 0 where a direction is not above the horizon.
    glm::dvec3 evaluate(const glm::dvec3& normal, const glm::dvec3& to_viewer,
                        const glm::dvec3& to_light) const;

    /// u, v in [0, 1) uniform; may lie below the horizon.
    glm::dvec3 sample(const glm::dvec3& normal, const glm::dvec3& to_viewer, double u,
                      double v) const;
    /// Of drawing a direction that way [1/sr].
    double pdf(const glm::dvec3& normal, const glm::dvec3& to_viewer,
               const glm::dvec3& to_light) const;

  private:
    double edge(std::size_t cell) const;  ///< cos(theta_h) at which a cell begins

    BrdfTable table_;
    double most_ = 0;
    std::vector<double> sums_;  ///< share of the cells of theta_h before each, and of all
};

}  // namespace airlight
