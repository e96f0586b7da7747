// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_topology.h"

#include <fmt/format.h>

#include <numeric>
#include <vector>

#include "core/error.h"
#include "prt/half_edges.h"

namespace airlight {
namespace {

// Neighbours, OpenMesh's arrays and the handles in between, of triangles that are all cut apart.
constexpr std::size_t kBytesPerTriangle = 300;
constexpr std::size_t kBytesPerVertex = 64;
// OpenMesh numbers half-edges with an int.
constexpr std::size_t kMostTriangles = 0x7fffffff / 6;

std::uint64_t count_boundary_loops(const detail::HalfEdges& half_edges) {
    const auto& mesh = half_edges.mesh;
    std::vector<bool> seen(mesh.n_halfedges());
    std::uint64_t loops = 0;
    for (const auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || seen[static_cast<std::size_t>(start.idx())]) continue;
        ++loops;
        for (OpenMesh::HalfedgeHandle at = start; !seen[static_cast<std::size_t>(at.idx())];
             at = mesh.next_halfedge_handle(at)) {
            seen[static_cast<std::size_t>(at.idx())] = true;
        }
    }
    return loops;
}

std::uint64_t count_components(const Mesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::vector<bool> used(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) {
        const std::uint32_t to = root(t.x);
        parent[root(t.y)] = to;
        parent[root(t.z)] = to;
        used[t.x] = used[t.y] = used[t.z] = true;
    }
    std::uint64_t components = 0;
    for (std::uint32_t v = 0; v < parent.size(); ++v) components += used[v] && parent[v] == v;
    return components;
}

}  // namespace

MeshTopology mesh_topology(const Mesh& mesh, std::size_t max_memory) {
    const std::string what = "the neighbours of its triangles";
    require_memory(
        checked_add(checked_multiply(mesh.triangles.size(), kBytesPerTriangle, what),
                    checked_multiply(mesh.positions.size(), kBytesPerVertex, what), what),
        max_memory, what);
    if (mesh.triangles.size() > kMostTriangles || mesh.positions.size() > 0x7fffffff / 2) {
        throw Error(ErrorCode::data, fmt::format("has {} triangles, and half-edges go to {}",
                                                 mesh.triangles.size(), kMostTriangles));
    }
    const detail::Connectivity connectivity = detail::connect(mesh);
    MeshTopology topology;
    topology.edges = connectivity.edges;
    topology.boundary_edges = connectivity.boundary_edges;
    topology.nonmanifold_edges = connectivity.nonmanifold_edges;
    topology.flipped_edges = connectivity.flipped_edges;
    topology.nonmanifold_vertices = connectivity.nonmanifold_vertices;
    topology.duplicated_vertices = connectivity.file_vertex.size() - mesh.positions.size();
    topology.components = count_components(mesh);
    topology.boundary_loops = count_boundary_loops(detail::make_half_edges(mesh, connectivity));
    return topology;
}

}  // namespace airlight
