// SPDX-License-Identifier: Apache-2.0
// Files of Gaussian blobs: PLY, points with the properties x, y, z [m], scale and amplitude [1/m].
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/checked.h"
#include "medium/gaussian_density.h"

namespace airlight {

/// Reads one; other properties are passed over. Throws as read_ply_table, and Error(data) for a
/// coordinate beyond 1e12 or a scale or amplitude outside [0, 1e30].
std::vector<GaussianBlob> read_blobs(const std::string& path,
                                     std::size_t max_memory = kDefaultMaxMemory);

}  // namespace airlight
