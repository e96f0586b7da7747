// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_match.h"

#include <fmt/format.h>

#include "core/error.h"
#include "prt/prt_key.h"

namespace airlight {

void require_whole(const PrtReader& reader, const std::string& what) {
    const PrtHeader& header = reader.header();
    if (header.shards > 1) {
        throw Error(ErrorCode::usage,
                    fmt::format("is part {} of {}, and {} takes a whole file", header.shard + 1,
                                header.shards, what),
                    reader.path());
    }
    if (reader.find(PrtKind::vertex_index)) {
        throw Error(ErrorCode::usage,
                    fmt::format("has rows in an order of its own, and {} takes them in that of "
                                "the mesh",
                                what),
                    reader.path());
    }
}

void require_mesh(const PrtReader& reader, const Mesh& mesh, const std::string& name) {
    const PrtHeader& header = reader.header();
    if (mesh.positions.size() != header.mesh_vertices) {
        throw Error(ErrorCode::data,
                    fmt::format("has {} vertices, and {} is of a mesh of {}", mesh.positions.size(),
                                reader.path(), header.mesh_vertices),
                    name);
    }
    if (mesh_key(mesh) != header.mesh) {
        throw Error(ErrorCode::data,
                    fmt::format("is not the mesh that {} is of: its key is {}, not {}",
                                reader.path(), to_text(mesh_key(mesh)), to_text(header.mesh)),
                    name);
    }
}

}  // namespace airlight
