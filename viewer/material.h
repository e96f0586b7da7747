// SPDX-License-Identifier: Apache-2.0
// How surfaces send light on.
#pragma once

#include <glm/vec3.hpp>

#include "viewer/sample_stream.h"
#include "viewer/scene.h"

namespace airlight {

/// Radiance that leaves towards `to_viewer` per irradiance across a beam from `to_light`, the
/// foreshortening in it [1/sr]. All three are unit vectors, the normal on the side of the viewer;
/// 0 for light from behind it.
glm::dvec3 reflect(const Material& material, const glm::dvec3& normal, const glm::dvec3& to_viewer,
                   const glm::dvec3& to_light);

struct LobeSample {
    glm::dvec3 direction{0};
    double pdf = 0;  ///< per steradian
};

/// A direction that reflect() is large for, and the density of drawing one.
LobeSample sample_lobe(const Material& material, const glm::dvec3& normal,
                       const glm::dvec3& to_viewer, SampleStream& stream);
double lobe_pdf(const Material& material, const glm::dvec3& normal, const glm::dvec3& to_viewer,
                const glm::dvec3& direction);

/// Unit axes with z along a unit vector: columns x, y of a right-handed frame.
void make_axes(const glm::dvec3& z, glm::dvec3& x, glm::dvec3& y);

}  // namespace airlight
