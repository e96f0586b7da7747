// SPDX-License-Identifier: Apache-2.0
// Materials as a diffuse part and one lobe, which is what closed forms and products take.
#pragma once

#include <glm/vec3.hpp>

#include "viewer/material.h"

namespace airlight {

/// diffuse / pi cos + specular (exponent + 1) / (2 pi) cos^exponent about the mirrored view.
struct SurfaceLobes {
    glm::dvec3 diffuse{0}, specular{0};
    double exponent = 1;

    bool glossy() const { return specular != glm::dvec3(0); }
};

/// Lambert's and Phong's exactly. A tabulated one counts as diffuse, with the part of the light
/// from a view at 45 degrees that it sends on.
SurfaceLobes lobes_of(const SurfaceMaterial& material);

}  // namespace airlight
