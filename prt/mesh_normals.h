// SPDX-License-Identifier: Apache-2.0
// A unit normal for every vertex, whatever the faces around it are like.
//
// The first of these that exists is the vertex's normal:
//   1. the file's, normalised: its own one, or the mean of those of its corners (OBJ);
//   2. the sum over its triangles of the unit normal times the angle at the vertex. It does not
//      depend on how a surface is cut into triangles, unlike sums by area or by number;
//   3. where that sum cancels (shorter than 1e-9 of the sum of angles: two windings that disagree,
//      a triangle and its back), the normal of its triangle with the largest area, of equals the
//      first;
//   4. +Y, for isolated vertices and those of triangles without area alone.
//
// A triangle is without area when the cross product of two of its edges is within the rounding of
// its coordinates, 8ε · (largest |coordinate|) · (longest edge); its normal would be noise. Nothing
// overflows or vanishes on the way, from 1e-100 to kLargestCoordinate.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "prt/mesh.h"
#include "prt/mesh_io.h"

namespace airlight {

/// Fills mesh.normals. `from_file` is empty or holds a vector per vertex, of any length; zero and
/// non-finite ones count as none. Fills the report's normals_…, against_winding and zero_area.
/// Time O(vertices + triangles).
void compute_normals(Mesh& mesh, const std::vector<glm::dvec3>& from_file, MeshReport& report);

}  // namespace airlight
