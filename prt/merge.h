// SPDX-License-Identifier: Apache-2.0
// Parts of a bake to the file that one process would have written.
//
// A part has the rows of a range of the bake's own order (prt/bake_plan.h), named by a table
// vertex_index, as float32, with the tables ray_count and blocked_count; its report says what the
// result is to hold. So everything in the result, rounding errors and counts included, follows from
// the rows, and however they were cut into parts, its bytes are the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/checked.h"
#include "core/progress.h"
#include "prt/prt_file.h"
#include "prt/prt_reader.h"

namespace airlight {

/// What the rays of some rows met.
struct RayCounts {
    std::uint64_t rays = 0, blocked = 0;
    std::uint64_t mostly_blocked = 0;  ///< rows more than half of whose rays are blocked
    /// Rows whose visibility_error or transfer_error, where there are such tables, is above the
    /// tolerance.
    std::uint64_t unmet = 0;
};

/// Of the rows of a part; throws as PrtReader does.
RayCounts count_rays(const PrtReader& part);

/// What the report of every part of a bake says, which is the same in all of them.
struct PartReport {
    std::string program;
    std::vector<PrtTable> tables;    ///< of the result
    std::vector<std::string> notes;  ///< for its report
    bool occluders = false;          ///< whether anything but the mesh hides light
};

std::string to_json(const PartReport& report);

struct MergeOptions {
    bool force = false;  ///< replace the output
    /// Half of it is what rows may take that wait for their place; what does not fit is read again.
    std::size_t max_memory = kDefaultMaxMemory;
    ProgressOptions progress;
};

struct MergeReport {
    PrtHeader header;  ///< of the result
    RayCounts counts;
    std::vector<std::string> notes;
};

/// Joins all parts of a bake, in any order. Throws Error, in one sentence that names the files:
///   usage  no part at all;
///   data   one that is no part, of another bake, twice or missing; and what PrtReader throws, for
///          every chunk is checked;
///   io     what AtomicFile throws for the output.
/// Throws Interrupted if options.progress is interruptible. Memory: the rows, if they fit in half
/// of max_memory, 4 bytes for each of a part's rows and an index. Cost: reading and writing.
MergeReport merge_parts(const std::vector<std::string>& parts, const std::string& output,
                        const MergeOptions& options = {});

}  // namespace airlight
