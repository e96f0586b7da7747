// SPDX-License-Identifier: Apache-2.0
// Where the rays of a picture go.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "viewer/scene.h"

namespace airlight {

/// Unit columns: right, up, and against the view. Throws Error(usage) for a camera that looks at
/// its own position or along its up direction.
glm::dmat3 camera_axes(const Camera& camera);

/// The unit direction of a ray through a point of a picture of width x height pixels, x to the
/// right and y downwards from the upper left corner, in pixels; `axes` as above.
glm::dvec3 camera_direction(const Camera& camera, const glm::dmat3& axes, int width, int height,
                            double x, double y);

}  // namespace airlight
