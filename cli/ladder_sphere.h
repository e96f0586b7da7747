// SPDX-License-Identifier: Apache-2.0
// A mesh of which a part of the rays is blocked, for the ladder and the benchmark of bakes.
#pragma once

#include <cmath>

#include "core/constants.h"
#include "prt/mesh.h"
#include "prt/mesh_normals.h"

namespace airlight {

/// A unit sphere of `rings` rings and twice as many columns, with bumps and hollows of `depth`. At
/// 0.09 rays are blocked as they are on scanned statues.
inline Mesh bumpy_sphere(unsigned rings, double depth) {
    Mesh mesh;
    const unsigned columns = 2 * rings;
    for (unsigned i = 0; i <= rings; ++i) {
        for (unsigned j = 0; j < columns; ++j) {
            const double theta = kPi * i / rings, phi = 2 * kPi * j / columns;
            const double sine = std::sin(theta);
            const double r = 1 + depth * std::sin(9 * theta) * std::sin(11 * phi) * sine;
            mesh.positions.emplace_back(r * sine * std::sin(phi), r * std::cos(theta),
                                        r * sine * std::cos(phi));
        }
    }
    const auto at = [&](unsigned i, unsigned j) { return i * columns + j % columns; };
    for (unsigned i = 0; i < rings; ++i) {
        for (unsigned j = 0; j < columns; ++j) {
            if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
            if (i + 1 < rings) {
                mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
            }
        }
    }
    MeshReport report;
    compute_normals(mesh, {}, report);
    return mesh;
}

}  // namespace airlight
