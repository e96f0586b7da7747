// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace airlight {

glm::dmat3 camera_axes(const Camera& camera) {
    const glm::dvec3 view = glm::normalize(camera.look_at - camera.position);
    const glm::dvec3 right = glm::normalize(glm::cross(view, camera.up));
    if (!std::isfinite(right.x + right.y + right.z)) {
        throw Error(ErrorCode::usage,
                    "the camera looks at its own position or along its up direction");
    }
    return {right, glm::cross(right, view), -view};
}

PictureRays::PictureRays(const Camera& camera, int width, int height)
    : PictureRays(camera, camera_axes(camera), width, height) {}

PictureRays::PictureRays(const Camera& camera, const glm::dmat3& axes, int width, int height) {
    const double half = std::tan(0.5 * camera.vertical_fov) / height;
    right_ = 2 * half * axes[0];
    down_ = -2 * half * axes[1];
    corner_ = -axes[2] - 0.5 * (double(width) * right_ + double(height) * down_);
}

glm::dvec3 PictureRays::operator()(double x, double y) const {
    return glm::normalize(corner_ + x * right_ + y * down_);
}

glm::dvec3 camera_direction(const Camera& camera, const glm::dmat3& axes, int width, int height,
                            double x, double y) {
    return PictureRays(camera, axes, width, height)(x, y);
}

}  // namespace airlight
