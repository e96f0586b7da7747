// SPDX-License-Identifier: Apache-2.0
// Optical depths of many rays through the media of a scene, in float where these are Gaussians.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "viewer/scene_media.h"

namespace airlight {

/// SceneMedia::depth() with Gaussians in vectors (medium/gaussian_line_batch.h): relative 1e-6. For
/// one thread.
class MediumDepths {
  public:
    explicit MediumDepths(const SceneMedia& media, MediumExtent extent = MediumExtent::any);

    glm::dvec3 operator()(const glm::dvec3& origin, const glm::dvec3& direction, double distance);

  private:
    /// Of more Gaussians than these only those beside the ray count, by their tree.
    static constexpr std::size_t kMostBlobs = 512;

    std::vector<const MediumPart*> parts_;  ///< others
    std::vector<GaussianBlob> blobs_;
    std::vector<float> scale_, amplitude_, rho_, place_, end_;
};

}  // namespace airlight
