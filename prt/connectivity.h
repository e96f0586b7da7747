// SPDX-License-Identifier: Apache-2.0
// Which triangles are neighbours, for any soup of triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "prt/mesh.h"

namespace airlight::detail {

inline constexpr std::uint32_t kNoTwin = 0xffffffff;

/// Half-edge 3t + c runs from corner c of triangle t to corner c + 1 (mod 3).
struct Connectivity {
    /// The half-edge of the neighbour, or kNoTwin at the border. Two half-edges are twins when they
    /// are the only ones between their vertices and run against each other; every other edge is
    /// cut.
    std::vector<std::uint32_t> twin;
    /// The vertex at which each half-edge begins after the triangles around a vertex were parted
    /// into fans. The first fan keeps the vertex of the file; others get numbers behind the last.
    std::vector<std::uint32_t> vertex;
    /// For every vertex, those behind the last included, the vertex of the file.
    std::vector<std::uint32_t> file_vertex;

    std::size_t edges = 0, boundary_edges = 0, nonmanifold_edges = 0, flipped_edges = 0;
    /// Vertices on an edge of more than two triangles, and those whose triangles form more than
    /// one fan even when neighbours of opposite winding are taken together.
    std::size_t nonmanifold_vertices = 0;
};

inline std::uint32_t next_in_triangle(std::uint32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}
inline std::uint32_t previous_in_triangle(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}

/// Time O(n log n) for n triangles, fewer than 2^31 / 6 of them; memory about 48 bytes for each
/// and 12 for each vertex.
Connectivity connect(const Mesh& mesh);

}  // namespace airlight::detail
