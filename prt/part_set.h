// SPDX-License-Identifier: Apache-2.0
// The parts of one bake: whether they belong together and are all there; for sources only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prt/merge.h"
#include "prt/prt_file.h"

namespace airlight::detail {

/// What is known of a part while it is not open: there may be more of them than a process can open.
struct Part {
    std::string path;
    PrtHeader header;
    std::string report;
    std::uint64_t fingerprint = 0;
};

struct PartSet {
    std::vector<Part> parts;  ///< in the order of their rows
    PartReport report;
};

/// Where a range of the rows of a bake begins: part i of n (i counted from 0, or n for the end).
std::uint64_t part_begin(std::uint64_t rows, std::uint64_t part, std::uint64_t parts);

/// Whether the rows of a file are named by a table, as those of every part are.
bool is_part(const PrtHeader& header);

/// Opens each file once and checks that together they are all parts of one bake; throws as
/// merge_parts does.
PartSet gather_parts(const std::vector<std::string>& paths, std::size_t max_memory);

}  // namespace airlight::detail
