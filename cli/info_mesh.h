// SPDX-License-Identifier: Apache-2.0
// What airlight info says about a mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "prt/mesh.h"
#include "prt/mesh_io.h"
#include "prt/mesh_topology.h"

namespace airlight {

struct MeshFigures {
    MeshReport report;
    MeshTopology topology;
    MeshBounds bounds;
    std::size_t vertices = 0, triangles = 0;
};

/// Reads a mesh, non-finite coordinates as 0, and looks at it.
MeshFigures look_into_mesh(const std::string& path, std::size_t max_memory);

std::string to_lines(const std::string& path, const MeshFigures& mesh);
nlohmann::ordered_json to_json(const std::string& path, const MeshFigures& mesh);

}  // namespace airlight
