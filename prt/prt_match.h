// SPDX-License-Identifier: Apache-2.0
// Whether a .prt file has a row for every vertex of a mesh, in its order.
#pragma once

#include <string>

#include "prt/mesh.h"
#include "prt/prt_reader.h"

namespace airlight {

/// Throws Error(usage) for a part of a bake, or rows in an order of their own; `what` is what needs
/// more, such as "a PLY".
void require_whole(const PrtReader& reader, const std::string& what);

/// Throws Error(data) unless the file is of that mesh (PrtHeader::mesh); `name` is what messages
/// call the mesh.
void require_mesh(const PrtReader& reader, const Mesh& mesh, const std::string& name);

}  // namespace airlight
