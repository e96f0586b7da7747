// SPDX-License-Identifier: Apache-2.0
#include "prt/half_edges.h"

#include <algorithm>
#include <utility>

namespace airlight::detail {

HalfEdges make_half_edges(const Mesh& mesh, const Connectivity& connectivity) {
    using OpenMesh::FaceHandle;
    using OpenMesh::HalfedgeHandle;
    using OpenMesh::VertexHandle;
    HalfEdges result;
    auto& out = result.mesh;
    const auto handle = [](std::uint32_t index) { return static_cast<int>(index); };
    const auto borders = static_cast<std::size_t>(
        std::count(connectivity.twin.begin(), connectivity.twin.end(), kNoTwin));
    out.reserve(connectivity.file_vertex.size(), borders + (connectivity.twin.size() - borders) / 2,
                mesh.triangles.size());
    for (const std::uint32_t v : connectivity.file_vertex) {
        const glm::dvec3& p = mesh.positions[v];
        out.add_vertex({p.x, p.y, p.z});
    }
    const auto count = static_cast<std::uint32_t>(connectivity.twin.size());
    std::vector<HalfedgeHandle> half_edges(count);
    // The border half-edges into each vertex; of a fan there is one at most.
    std::vector<HalfedgeHandle> border_into(connectivity.file_vertex.size());
    for (std::uint32_t h = 0; h < count; ++h) {
        const std::uint32_t twin = connectivity.twin[h];
        if (twin != kNoTwin && twin < h) {
            half_edges[h] = out.opposite_halfedge_handle(half_edges[twin]);
            continue;
        }
        const std::uint32_t from = connectivity.vertex[h];
        const std::uint32_t to = connectivity.vertex[next_in_triangle(h)];
        half_edges[h] = out.new_edge(VertexHandle(handle(from)), VertexHandle(handle(to)));
        if (twin == kNoTwin) border_into[from] = out.opposite_halfedge_handle(half_edges[h]);
    }
    for (std::uint32_t h = 0; h < count; ++h) {
        if (h % 3 == 0) {
            // The half-edge into the first corner, where OpenMesh's walks around a face begin.
            const FaceHandle face = out.new_face();
            out.set_halfedge_handle(face, half_edges[previous_in_triangle(h)]);
        }
        out.set_face_handle(half_edges[h], FaceHandle(handle(h / 3)));
        out.set_next_halfedge_handle(half_edges[h], half_edges[next_in_triangle(h)]);
        const VertexHandle from(handle(connectivity.vertex[h]));
        if (!out.halfedge_handle(from).is_valid()) out.set_halfedge_handle(from, half_edges[h]);
        if (connectivity.twin[h] != kNoTwin) continue;
        // A border half-edge leaves `to`; the one into `to` comes before it. OpenMesh wants border
        // vertices to point at it.
        const std::uint32_t to = connectivity.vertex[next_in_triangle(h)];
        const HalfedgeHandle border = out.opposite_halfedge_handle(half_edges[h]);
        out.set_next_halfedge_handle(border_into[to], border);
        out.set_halfedge_handle(VertexHandle(handle(to)), border);
    }
    result.file_vertex = connectivity.file_vertex;
    return result;
}

}  // namespace airlight::detail
