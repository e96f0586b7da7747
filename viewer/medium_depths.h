// SPDX-License-Identifier: Apache-2.0
// Optical depths of many rays through the media of a scene, in vectors of floats.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "viewer/scene_media.h"

namespace airlight {

/// SceneMedia::depth() for many rays: Gaussians, layers and atmospheres without borders by
/// medium/gaussian_line_batch.h, height_density_batch.h and spherical_density_batch.h, relative
/// 2e-6, other media by their own closed forms. Of a layer or atmosphere that the ray comes into
/// from far above it is what lies below 60 scale heights. Transmittances are right to 2e-5. Any
/// thread may ask.
class MediumDepths {
  public:
    explicit MediumDepths(const SceneMedia& media, MediumExtent extent = MediumExtent::any);

    /// out[i] of `count` rays of unit directions.
    void operator()(std::size_t count, const glm::dvec3* origins, const glm::dvec3* directions,
                    const double* distances, glm::dvec3* out) const;
    /// Of one.
    glm::dvec3 operator()(const glm::dvec3& origin, const glm::dvec3& direction,
                          double distance) const {
        glm::dvec3 depth(0);
        (*this)(1, &origin, &direction, &distance, &depth);
        return depth;
    }

  private:
    /// Of media with more Gaussians than these only those beside the ray count, by their trees.
    static constexpr std::size_t kMostBlobs = 512;

    void add_blobs(std::size_t count, const glm::dvec3* origins, const glm::dvec3* directions,
                   const double* distances, glm::dvec3* out) const;

    struct Layer {
        ExponentialHeightDensity shape;
        glm::dvec3 colour;
    };
    struct Atmosphere {
        SphericalExponentialDensity shape;
        glm::dvec3 colour;
    };
    static void add_layer(const Layer& layer, std::size_t count, const glm::dvec3* origins,
                          const glm::dvec3* directions, const double* distances, glm::dvec3* out);
    static void add_atmosphere(const Atmosphere& atmosphere, std::size_t count,
                               const glm::dvec3* origins, const glm::dvec3* directions,
                               const double* distances, glm::dvec3* out);
    glm::dvec3 uniform_{0};
    std::vector<Layer> layers_;
    std::vector<Atmosphere> atmospheres_;
    std::vector<const MediumPart*> parts_;  ///< others
    std::vector<GaussianBlob> blobs_;
};

}  // namespace airlight
