// SPDX-License-Identifier: Apache-2.0
// Light that reaches a vertex from other parts of its mesh.
//
// With t^0 the transfer of prt/bake.h and rho the albedo, what b bounces add is
//     t^b_lm (p) = (rho / pi) int (1 - V) max(0, n omega) t^{b-1}_lm (q) d omega,
// q the nearest point of the mesh in the direction omega, t there interpolated between the corners
// of its triangle ([Sloan02] section 4). The sum over b is the transfer of interreflected light.
// Backs of triangles, occluders and the ground are black.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/progress.h"
#include "prt/bake.h"
#include "prt/mesh.h"
#include "prt/ray_scene.h"

namespace airlight {

/// One bounce for the vertices numbered vertices[0] … vertices[count - 1]: `before` holds t^{b-1}
/// of all vertices in the order of the file, (vertices, order^2), and `rows` takes their t^b in the
/// order of the list. Rays are those of bake_vertices. A row depends on `before`, the scene, the
/// options and its vertex alone, to the bit, for any number of threads.
///
/// Throws as bake_vertices, and Error(usage) for an albedo outside [0, 1]. Cost: that of
/// RayScene::find_hits, and 60 ns for each hit at order 6.
void bake_bounce(const Mesh& mesh, const RayScene& scene, const BakeOptions& options, double albedo,
                 const float* before, const std::uint32_t* vertices, std::size_t count, float* rows,
                 Progress* progress = nullptr);

/// Adds t^1 … t^bounces to a bake's transfer; 0 bounces add nothing. Holds two more tables of the
/// same size meanwhile. Throws as bake_bounce, and Error(usage) for a bake without transfer or
/// another order.
void add_bounces(const Mesh& mesh, const RayScene& scene, const BakeOptions& options, double albedo,
                 int bounces, Bake& bake, Progress* progress = nullptr);

}  // namespace airlight
