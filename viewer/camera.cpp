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

glm::dvec3 camera_direction(const Camera& camera, const glm::dmat3& axes, int width, int height,
                            double x, double y) {
    const double half = std::tan(0.5 * camera.vertical_fov) / height;
    return glm::normalize(axes * glm::dvec3((2 * x - width) * half, (height - 2 * y) * half, -1));
}

}  // namespace airlight
