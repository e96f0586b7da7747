// SPDX-License-Identifier: Apache-2.0
// What every baker asks of its input; for sources only.
#pragma once

#include <cstddef>
#include <cstdint>

#include "prt/bake.h"
#include "prt/mesh.h"

namespace airlight::detail {

/// Throws Error(usage) for options outside their domain.
void check_bake_options(const BakeOptions& options);

/// Throws Error(data) for vertices that the mesh lacks and normals that are not unit.
void check_bake_vertices(const Mesh& mesh, const std::uint32_t* vertices, std::size_t count);

}  // namespace airlight::detail
