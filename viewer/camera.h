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

/// camera_direction() for many points of a picture.
class PictureRays {
  public:
    PictureRays(const Camera& camera, int width, int height);
    PictureRays(const Camera& camera, const glm::dmat3& axes, int width, int height);
    glm::dvec3 operator()(double x, double y) const;

  private:
    glm::dvec3 corner_, right_, down_;  ///< before the eye at a distance of 1; by pixel
};

}  // namespace airlight
