// SPDX-License-Identifier: Apache-2.0
// Shapes whose visibility is known.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "prt/mesh.h"
#include "prt/mesh_io.h"
#include "prt/mesh_normals.h"

namespace airlight {

inline void add_normals(Mesh& mesh) {
    MeshReport report;
    compute_normals(mesh, {}, report);
}

inline Mesh moved(Mesh mesh, const std::function<glm::dvec3(const glm::dvec3&)>& move) {
    for (glm::dvec3& p : mesh.positions) p = move(p);
    return mesh;
}

/// A cube of edge 2 whose faces are grids of `steps`^2 squares, with its vertices shared, and with
/// normals. Each vertex is moved by `shape`.
inline Mesh make_cube(unsigned steps, const std::function<glm::dvec3(const glm::dvec3&)>& shape) {
    Mesh mesh;
    std::vector<unsigned> index((steps + 1) * (steps + 1) * (steps + 1), ~0u);
    const auto at = [&](const glm::uvec3& cell) {
        unsigned& i = index[(cell.x * (steps + 1) + cell.y) * (steps + 1) + cell.z];
        if (i == ~0u) {
            i = static_cast<unsigned>(mesh.positions.size());
            mesh.positions.push_back(shape(2.0 / steps * glm::dvec3(cell) - 1.0));
        }
        return i;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (unsigned side = 0; side < 2; ++side) {
            for (unsigned i = 0; i < steps; ++i) {
                for (unsigned j = 0; j < steps; ++j) {
                    const auto corner = [&](unsigned di, unsigned dj) {
                        glm::uvec3 cell(0);
                        cell[axis] = side * steps;
                        cell[(axis + 1) % 3] = i + di;
                        cell[(axis + 2) % 3] = j + dj;
                        return at(cell);
                    };
                    const unsigned a = corner(0, 0), b = corner(1, 0), c = corner(1, 1),
                                   d = corner(0, 1);
                    mesh.triangles.push_back(side == 1 ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
                    mesh.triangles.push_back(side == 1 ? glm::uvec3(a, c, d) : glm::uvec3(a, d, c));
                }
            }
        }
    }
    add_normals(mesh);
    return mesh;
}

inline Mesh make_box(unsigned steps) {
    return make_cube(steps, [](const glm::dvec3& p) { return p; });
}

/// Vertices on the sphere; tan() spreads them evenly.
inline Mesh make_sphere(unsigned steps, double radius = 1,
                        const glm::dvec3& centre = glm::dvec3(0.0)) {
    return make_cube(steps, [&](const glm::dvec3& p) {
        const glm::dvec3 spread(std::tan(0.78539816339744831 * p.x),
                                std::tan(0.78539816339744831 * p.y),
                                std::tan(0.78539816339744831 * p.z));
        return centre + radius * glm::normalize(spread);
    });
}

/// Two triangles over a parallelogram with its corner at `corner`; normal u x v.
inline Mesh make_quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
    Mesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    add_normals(mesh);
    return mesh;
}

/// A quad of edge 2 about the origin and a vertex in its middle, number 0; normal +Z.
inline Mesh make_floor() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
    add_normals(mesh);
    return mesh;
}

}  // namespace airlight
