// SPDX-License-Identifier: Apache-2.0
// PLY files of points that carry numbers of their own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/checked.h"

namespace airlight {

/// The named properties of the element "vertex", one vector for each in the order of the names, a
/// number per point; `expected` says in messages what the file holds: "a file of blobs".
///
/// Throws Error naming the file: data when it is no PLY file, cut off, or lacks a property, or a
/// number is not finite; memory when more than max_memory is needed; io when it cannot be read.
std::vector<std::vector<double>> read_ply_table(const std::string& path,
                                                const std::vector<std::string>& properties,
                                                const std::string& expected,
                                                std::size_t max_memory = kDefaultMaxMemory);

}  // namespace airlight
