// SPDX-License-Identifier: Apache-2.0
// How surfaces send light on.
#pragma once

#include <glm/vec3.hpp>

#include <memory>

#include "viewer/axes.h"
#include "viewer/brdf_lobe.h"
#include "viewer/sample_stream.h"
#include "viewer/scene.h"

namespace airlight {

/// A material with its file read.
struct SurfaceMaterial {
    Material kind;
    std::shared_ptr<const BrdfLobe> table;  ///< of a tabulated one
};

/// Radiance that leaves towards `to_viewer` per irradiance across a beam from `to_light`, the
/// foreshortening in it [1/sr]. All three are unit vectors, the normal on the side of the viewer;
/// 0 for light from behind it.
glm::dvec3 reflect(const SurfaceMaterial& material, const glm::dvec3& normal,
                   const glm::dvec3& to_viewer, const glm::dvec3& to_light);

/// Whether reflect() changes with the viewer.
bool is_glossy(const SurfaceMaterial& material);

/// The largest value that reflect() can have [1/sr].
double most_reflected(const SurfaceMaterial& material);

struct LobeSample {
    glm::dvec3 direction{0};
    double pdf = 0;  ///< per steradian
};

/// A direction that reflect() is large for, and the density of drawing one.
LobeSample sample_lobe(const SurfaceMaterial& material, const glm::dvec3& normal,
                       const glm::dvec3& to_viewer, SampleStream& stream);
double lobe_pdf(const SurfaceMaterial& material, const glm::dvec3& normal,
                const glm::dvec3& to_viewer, const glm::dvec3& direction);

}  // namespace airlight
