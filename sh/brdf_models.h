// SPDX-License-Identifier: Apache-2.0
// BRDFs of ours to tabulate: measured ones cannot be shipped.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "sh/brdf.h"

namespace airlight {

/// A rough metal: microfacets with the distribution of Trowbridge and Reitz ("GGX"), Smith's
/// masking and shadowing as a product, and Schlick's reflectance,
///     f = D F / ((c_i + sqrt(a^2 + (1 - a^2) c_i^2)) (c_o + sqrt(a^2 + (1 - a^2) c_o^2))),
///     D = a^2 / (pi (sin^2 theta_h + a^2 cos^2 theta_h)^2),  F = r + (1 - r) (1 - cos theta_d)^5,
/// c_i and c_o the cosines of the directions with the normal. It is reciprocal and reflects no
/// more than it receives: the light that facets send on to other facets is lost. [Walter07]
struct RoughMetal {
    double roughness = 0.2;                                  ///< a, in [1e-3, 1]
    std::array<double, 3> reflectance = {0.95, 0.64, 0.54};  ///< r at normal incidence, in [0, 1]
};

/// f [1/sr] of unit directions in the frame of the surface; 0 unless both are above the horizon.
glm::dvec3 evaluate_metal(const RoughMetal& metal, const glm::dvec3& in, const glm::dvec3& out);

/// The metal at the centres of all cells; cells that look below the horizon carry no value. Throws
/// Error(data) for parameters outside their ranges.
BrdfTable tabulate(const RoughMetal& metal, const BrdfSize& size = {});

/// A Lambertian surface, reflectance / pi in all channels; reflectance in [0, 1].
BrdfTable tabulate_lambertian(double reflectance, const BrdfSize& size = {});

}  // namespace airlight
