// SPDX-License-Identifier: Apache-2.0
// An environment map as light: its radiance in a direction, and directions where it is bright.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "envmap/image.h"

namespace airlight {

struct EnvironmentSample {
    glm::dvec3 direction{0};
    glm::dvec3 radiance{0};
    double pdf = 0;  ///< per steradian
};

/// A lat-long map, constant within each pixel (docs/CONVENTIONS.md), turned about +Y and scaled.
/// Draws directions with a density in proportion to the mean of the channels, exactly.
class EnvironmentSampler {
  public:
    /// A map of three channels without negative or non-finite values.
    EnvironmentSampler(Image map, double rotation, double scale);

    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// x, y in [0, 1) uniform. A black map gives a pdf of 0.
    EnvironmentSample sample(double x, double y) const;
    double pdf(const glm::dvec3& direction) const;
    /// Both in one look.
    EnvironmentSample at(const glm::dvec3& direction) const;
    /// The largest radiance of a pixel and channel.
    double brightest() const;
    /// At least the integral of the radiance over all directions, in any channel.
    double power() const { return 3 * scale_ * rows_.back(); }
    /// As it was given, neither turned nor scaled.
    const Image& map() const { return map_; }
    /// A direction of the world as the map has it.
    glm::dvec3 to_map(const glm::dvec3& direction) const;

  private:
    glm::dvec3 to_world(const glm::dvec3& direction) const;
    glm::dvec3 pixel(int row, int column) const;    ///< unscaled
    double pixel_power(int row, int column) const;  ///< mean radiance times solid angle, unscaled

    Image map_;
    double cosine_, sine_, scale_;
    std::vector<double> rows_;     ///< power of the rows before each, and of all
    std::vector<double> columns_;  ///< within each row likewise, width + 1 a row
};

}  // namespace airlight
