// SPDX-License-Identifier: Apache-2.0
// What a direction sees of an environment map.
#pragma once

#include <glm/vec3.hpp>

#include "envmap/image.h"

namespace airlight {

/// Radiance of a lat-long map of three channels in a direction of any finite length but 0,
/// bilinear between pixel centres, for backgrounds: the map's own pixels are constant
/// (docs/CONVENTIONS.md), which is what coefficients and fog are computed of. The seam is no seam,
/// and beyond the first and last rows' centres the picture goes on across the pole.
glm::vec3 look_up(const Image& map, const glm::dvec3& direction);

}  // namespace airlight
