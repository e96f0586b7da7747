// SPDX-License-Identifier: Apache-2.0
// How the triangles of a mesh hang together.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/checked.h"
#include "prt/mesh.h"

namespace airlight {

struct MeshTopology {
    std::uint64_t edges = 0;              ///< different pairs of vertices that a triangle joins
    std::uint64_t boundary_edges = 0;     ///< of one triangle
    std::uint64_t nonmanifold_edges = 0;  ///< of more than two triangles
    std::uint64_t flipped_edges = 0;      ///< of two triangles whose windings disagree
    /// Vertices on an edge of more than two triangles, or whose triangles form more than one fan,
    /// whatever their windings.
    std::uint64_t nonmanifold_vertices = 0;
    /// Copies of vertices in the half-edge mesh, one for every further fan of triangles once edges
    /// of the last two kinds are cut; the arrays of Mesh never have any.
    std::uint64_t duplicated_vertices = 0;
    std::uint64_t boundary_loops = 0;  ///< closed chains of border half-edges, cuts included
    std::uint64_t components = 0;      ///< sets of triangles joined by vertices
};

/// The half-edges (OpenMesh) are built for this and let go. A mesh without triangles has none of
/// anything. Time O(n log n) in the number of triangles, whatever they are like; 0.28 s for 1.6
/// million (bench/mesh_bench.cpp). Throws Error(memory) when the work would take more than
/// max_memory, Error(data) beyond 2^31 half-edges.
MeshTopology mesh_topology(const Mesh& mesh, std::size_t max_memory = kDefaultMaxMemory);

}  // namespace airlight
