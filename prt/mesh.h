// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as plain arrays.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace airlight {

/// What a mesh file holds after reading (prt/mesh_io.h). World units of the file; positions stay in
/// double until a consumer has moved them near the origin.
struct Mesh {
    std::vector<glm::dvec3> positions;  ///< one per vertex of the file, in its order; finite
    std::vector<glm::dvec3> normals;    ///< one per vertex, unit (prt/mesh_normals.h)
    std::vector<glm::uvec3>
        triangles;  ///< three different vertices, counter-clockwise from outside

    std::size_t bytes() const {
        return (positions.size() + normals.size()) * sizeof(glm::dvec3) +
               triangles.size() * sizeof(glm::uvec3);
    }
};

/// The corners of the smallest box around all vertices, isolated ones included; zero for none.
struct MeshBounds {
    glm::dvec3 minimum{0.0}, maximum{0.0};
};

MeshBounds mesh_bounds(const Mesh& mesh);

}  // namespace airlight
