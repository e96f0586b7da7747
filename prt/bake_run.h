// SPDX-License-Identifier: Apache-2.0
// Running a bake, or a part of one, so that it can end at any moment and go on later.
//
// Rows go to a work file beside the output as they are made (core/work_file.h): OUT.baking, and for
// the passes before the last OUT.baking-pass0 and so on, of which those that are still needed
// exist. They are unfinished parts (prt/prt_prefix.h). Whoever runs the same job again goes on
// behind the last whole block of rows; work that is lost when a process or a machine dies is that
// of a few seconds. In the end the rows are merged (prt/merge.h) into the output, or, of a part,
// the work file becomes the output, and nothing else stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "prt/bake_plan.h"
#include "prt/merge.h"
#include "prt/prt_file.h"

namespace airlight {

struct BakeRunOptions {
    std::string output;
    bool force = false;  ///< replace the output, and discard unfinished work of other jobs
    std::size_t max_memory = kDefaultMaxMemory;
    /// Part `shard`, counted from 0, of `shards`; 0 shards is the whole, which is merged.
    std::uint32_t shard = 0, shards = 0;
    /// Only that pass. A part of a job with bounces is of one pass.
    std::optional<int> pass;
    std::string before;  ///< of a single pass k > 0: the merged result of pass k - 1
};

struct BakeRunReport {
    PrtKey key;
    std::uint64_t rows = 0;     ///< of all passes of this run
    std::uint64_t resumed = 0;  ///< of these, what was there already
    RayCounts counts;           ///< of the rows of the last pass of this run
    RaySceneReport scene;
    double scene_seconds = 0, bake_seconds = 0, write_seconds = 0;
    std::vector<std::string> notes;
};

class BakeRun {
  public:
    /// Opens the output's work files, locks them, checks what they hold and reserves the disk space
    /// that the run will take. The job must outlive this object. Throws Error:
    ///   usage  a pass, part or table that the job does not have;
    ///   io     the output exists, cannot be made, is being baked by another process, does not fit
    ///          on the disk; its work file is of another job.
    BakeRun(const BakeJob& job, const BakeRunOptions& options);
    /// Unfinished work stays, if any row is there.
    ~BakeRun();
    BakeRun(const BakeRun&) = delete;
    BakeRun& operator=(const BakeRun&) = delete;

    std::uint64_t rows() const;   ///< of all passes of this run
    std::uint64_t found() const;  ///< of these, what was there when it began
    /// Sentences about work files that were damaged.
    const std::vector<std::string>& warnings() const;

    /// Makes the rows that are missing and puts the output in place. Counts rows at `progress`,
    /// which has to begin at found(). Throws what bake_vertices, RayScene, merge_parts and the
    /// files throw, and Interrupted, with a sentence that says how much is done, if signals are
    /// noted (core/interrupt.h) and `progress` is interruptible; then unfinished work is safe on
    /// the disk.
    BakeRunReport run(Progress* progress = nullptr);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace airlight
