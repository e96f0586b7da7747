// SPDX-License-Identifier: Apache-2.0
// What a bake is asked for, and how it falls into passes and rows that processes can share.
//
// Light that bounces is found in passes: pass k = 0 … bounces - 1 makes the transfer T_k
// (prt/bake.h) of the vertices of all meshes that reflect, as float32; the last pass, k = bounces,
// makes what was asked for of the first mesh. Each pass but the first needs all of the pass before.
//
// The rows of a pass have one order for all processes: the Morton order of the first mesh, then, in
// a pass before the last, that of every other mesh that reflects (likewise the first one's rows are
// there only if it does). A part of a pass is one of n equal ranges of that order. In the result of
// a pass rows are in the order of the files: all vertices of the first mesh, then of the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "prt/bake.h"
#include "prt/bake_scene.h"
#include "prt/prt_file.h"

namespace airlight {

/// Parts of a bake, at most.
inline constexpr int kMostShards = 1000000;

struct BakeJob {
    BakeScene scene;  ///< its meshes stay until the end
    BakeOptions bake;
    int bounces = 0;
    std::vector<PrtTable> tables;    ///< of the result
    std::string program;             ///< for its report
    std::vector<std::string> notes;  ///< likewise; nothing in it may name files
};

/// A run of rows of a pass that are of one mesh.
struct BakeSegment {
    std::size_t mesh = 0;
    /// Of rows of the pass's result, one more than the mesh's vertex by this.
    std::size_t offset = 0;
    const std::uint32_t* vertices = nullptr;
    std::size_t count = 0;
};

/// The plan of a job. Cheap but for the Morton orders, which the constructor makes.
class BakePlan {
  public:
    /// Throws Error: usage for bounces or albedos outside their domain, and for tables of errors
    /// that the method does not estimate;
    /// data for more than 2^32 - 1 rows. The job must outlive the plan.
    explicit BakePlan(const BakeJob& job);

    const BakeJob& job() const { return *job_; }
    int last_pass() const { return job_->bounces; }
    std::uint64_t rows(int pass) const;
    /// The tables of a pass's result.
    std::vector<PrtTable> tables(int pass) const;
    /// Equal keys mean equal results. Those of passes before the last do not depend on the number
    /// of bounces or the tables.
    PrtKey key(int pass) const;
    /// Of part `shard` (counted from 0) of `shards`: float32, with ray_count, blocked_count and
    /// vertex_index. Depends on nothing but key(pass) and the part.
    PrtHeader part_header(int pass, std::uint32_t shard, std::uint32_t shards) const;
    std::string part_report(int pass) const;

    /// Rows first … first + count - 1 of a pass, mesh by mesh.
    std::vector<BakeSegment> segments(int pass, std::uint64_t first, std::size_t count) const;
    /// Where a reflecting mesh's rows begin in the result of a pass before the last.
    std::size_t stage_offset(std::size_t mesh) const { return offsets_[mesh]; }
    bool reflects(std::size_t mesh) const {
        return job_->bounces > 0 && job_->scene.albedo(mesh) > 0;
    }

  private:
    const BakeJob* job_;
    std::vector<std::vector<std::uint32_t>> orders_;  ///< empty for meshes that are never baked
    std::vector<std::size_t> offsets_;
    std::uint64_t stage_rows_ = 0;
    std::vector<PrtKey> mesh_keys_;
};

}  // namespace airlight
