// SPDX-License-Identifier: Apache-2.0
// A picture of one mesh whose vertices carry radiance, before an environment map.
#pragma once

#include "envmap/image.h"
#include "prt/mesh.h"
#include "prt/ray_scene.h"
#include "viewer/scene.h"

namespace airlight {

/// A camera whose picture holds the sphere around the vertices that triangles use (all, if there
/// are none), from the given side of it: the sphere touches the nearer borders. azimuth [rad] is
/// counted from +Z towards +X, elevation [rad] in (-pi/2, pi/2) upwards, so 0, 0 looks along -Z.
Camera framing_camera(const Mesh& mesh, double azimuth, double elevation, double vertical_fov,
                      int width, int height);

/// Linear radiance, three channels. Each pixel is the mean over samples^2 rays on a grid within it.
/// A ray sees the nearest triangle of the mesh, from either side, with the radiance (vertices, 3)
/// of its corners interpolated, or else the map (viewer/map_lookup.h). Values below 0, which light
/// of few degrees makes, count as 0 along a ray.
///
/// `scene` is that of the mesh alone. In parallel; the same bytes for any number of threads. Cost:
/// 0.1 us of CPU per ray (data/knot.ply, which about a third of the rays meet).
///
/// Throws Error: usage for a camera without size or direction, samples outside 1 … 64; memory
/// beyond max_memory.
Image mesh_picture(const Mesh& mesh, const RayScene& scene, const float* radiance, const Image& map,
                   const Camera& camera, int samples = 4,
                   std::size_t max_memory = kDefaultMaxMemory);

}  // namespace airlight
