// SPDX-License-Identifier: Apache-2.0
// A mesh as half-edges of OpenMesh, whatever its triangles are like; for sources only.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstdint>
#include <vector>

#include "prt/connectivity.h"
#include "prt/mesh.h"

namespace airlight::detail {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    VertexAttributes(0);
    FaceAttributes(0);
    EdgeAttributes(0);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
};

/// Vertices 0 … of the file keep their numbers; copies of non-manifold ones come behind them, and
/// file_vertex leads back. Face t is triangle t.
struct HalfEdges {
    OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits> mesh;
    std::vector<std::uint32_t> file_vertex;
};

/// OpenMesh's own add_face refuses what is not manifold and takes time in the square of a vertex's
/// faces; here the finished connectivity is written into its arrays.
HalfEdges make_half_edges(const Mesh& mesh, const Connectivity& connectivity);

}  // namespace airlight::detail
