// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "prt/merge.h"
#include "prt/morton.h"
#include "prt/part_set.h"
#include "prt/prt_key.h"

namespace airlight {
namespace {

// Rays of a block of rows of a part, about, where a row has many: a tenth of a second of one core.
constexpr std::uint64_t kBlockRays = std::uint64_t{1} << 20;
constexpr std::uint64_t kBlockBytes = std::uint64_t{256} << 10;

bool has(const std::vector<PrtTable>& tables, PrtKind kind) {
    return std::any_of(tables.begin(), tables.end(),
                       [&](const PrtTable& table) { return table.kind == kind; });
}

}  // namespace

BakePlan::BakePlan(const BakeJob& job) : job_(&job) {
    if (job.bounces < 0 || job.bounces > kLargestBounces) {
        throw Error(ErrorCode::usage,
                    fmt::format("bounces must be 0 to {}, got {}", kLargestBounces, job.bounces));
    }
    for (const double albedo : job.scene.albedos) {
        if (!(albedo >= 0 && albedo <= 1)) {
            throw Error(ErrorCode::usage,
                        fmt::format("the albedo must be in [0, 1], got {}", albedo));
        }
    }
    for (const PrtKind kind : {PrtKind::visibility_error, PrtKind::transfer_error}) {
        if (job.bake.method == BakeMethod::adaptive || !has(job.tables, kind)) continue;
        throw Error(
            ErrorCode::usage,
            fmt::format("a bake does not make {} unless by the method adaptive", prt_name(kind)));
    }
    orders_.resize(job.scene.meshes.size());
    offsets_.resize(job.scene.meshes.size());
    for (std::size_t m = 0; m < job.scene.meshes.size(); ++m) {
        mesh_keys_.push_back(mesh_key(*job.scene.meshes[m]));
        if (m == 0 || reflects(m)) orders_[m] = morton_order(*job.scene.meshes[m]);
        offsets_[m] = static_cast<std::size_t>(stage_rows_);
        if (reflects(m)) stage_rows_ += orders_[m].size();
    }
    if (stage_rows_ > kMostPrtVertices) {
        throw Error(ErrorCode::data, fmt::format("the meshes that reflect have {} vertices, and "
                                                 "there can be {}",
                                                 stage_rows_, kMostPrtVertices));
    }
}

std::uint64_t BakePlan::rows(int pass) const {
    return pass == last_pass() ? orders_[0].size() : stage_rows_;
}

std::vector<PrtTable> BakePlan::tables(int pass) const {
    if (pass == last_pass()) return job_->tables;
    return {{PrtKind::transfer, PrtType::float32}};
}

PrtKey BakePlan::key(int pass) const {
    const bool last = pass == last_pass();
    PrtKeyHash hash;
    hash.add(last ? "airlight bake 3" : "airlight bake 3: pass");
    hash.add_integer(mesh_keys_.size());
    for (const PrtKey& key : mesh_keys_) hash.add(key);
    hash.add_integer(static_cast<std::uint64_t>(job_->bake.order));
    hash.add_integer(static_cast<std::uint64_t>(job_->bake.rays));
    hash.add(method_name(kBakeMethods, job_->bake.method)).add(job_->bake.tolerance);
    hash.add_integer(job_->scene.rays.ground_height ? 1 : 0);
    hash.add(job_->scene.rays.ground_height.value_or(0));
    hash.add_integer(static_cast<std::uint64_t>(pass));
    for (std::size_t m = 0; m < mesh_keys_.size(); ++m)
        hash.add(reflects(m) ? job_->scene.albedo(m) : 0.0);
    if (last) {
        for (const PrtTable& table : job_->tables) {
            hash.add(prt_name(table.kind));
            hash.add(prt_name(table.type));
        }
    }
    return hash.key();
}

PrtHeader BakePlan::part_header(int pass, std::uint32_t shard, std::uint32_t shards) const {
    PrtHeader header;
    header.order = job_->bake.order;
    for (const PrtTable& table : tables(pass)) {
        header.tables.push_back(
            {table.kind, table.type == PrtType::uint32 ? PrtType::uint32 : PrtType::float32});
    }
    for (const PrtKind kind : {PrtKind::ray_count, PrtKind::blocked_count, PrtKind::vertex_index}) {
        if (!has(header.tables, kind)) header.tables.push_back({kind, PrtType::uint32});
    }
    header.mesh_vertices = rows(pass);
    header.first_row = detail::part_begin(rows(pass), shard, shards);
    header.rows =
        detail::part_begin(rows(pass), shard + std::uint64_t{1}, shards) - header.first_row;
    header.shard = shard;
    header.shards = shards;
    header.rays = static_cast<std::uint64_t>(job_->bake.rays);
    header.tolerance = job_->bake.tolerance;
    header.key = key(pass);
    header.mesh = mesh_keys_[0];
    if (rows(pass) != orders_[0].size() || (pass != last_pass() && !reflects(0))) {
        // Of several meshes, so that nobody takes it for the transfer of one.
        PrtKeyHash hash;
        for (const PrtKey& key : mesh_keys_) hash.add(key);
        header.mesh = hash.key();
    }
    const std::uint64_t widest = 4 * prt_components(PrtKind::transfer, header.order);
    header.block_rows = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        std::min(kBlockBytes / widest, kBlockRays / header.rays), 1, kMostPrtBlockRows));
    return header;
}

std::string BakePlan::part_report(int pass) const {
    PartReport report;
    report.program = job_->program;
    report.tables = tables(pass);
    report.notes = job_->notes;
    report.occluders = job_->scene.meshes.size() > 1 || job_->scene.rays.ground_height.has_value();
    return to_json(report);
}

std::vector<BakeSegment> BakePlan::segments(int pass, std::uint64_t first,
                                            std::size_t count) const {
    std::vector<BakeSegment> segments;
    std::uint64_t begin = 0;
    for (std::size_t m = 0; m < orders_.size() && count > 0; ++m) {
        const bool baked = pass == last_pass() ? m == 0 : reflects(m);
        if (!baked) continue;
        const std::uint64_t end = begin + orders_[m].size();
        if (first < end) {
            const auto skip = static_cast<std::size_t>(first - begin);
            const std::size_t here = std::min(count, orders_[m].size() - skip);
            segments.push_back(
                {m, pass == last_pass() ? 0 : offsets_[m], orders_[m].data() + skip, here});
            first += here;
            count -= here;
        }
        begin = end;
    }
    return segments;
}

}  // namespace airlight
