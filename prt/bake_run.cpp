// SPDX-License-Identifier: Apache-2.0
#include "prt/bake_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>
#include <map>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/threads.h"
#include "core/work_file.h"
#include "prt/bake.h"
#include "prt/bake_buffers.h"
#include "prt/bake_scene.h"
#include "prt/part_set.h"
#include "prt/prt_layout.h"
#include "prt/prt_writer.h"

namespace airlight {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kSuffix = ".baking";
// Rays that a thread traces between two looks at the work file, about: half a second. At its end
// threads wait for the last one, half of a task of prt/bake.cpp, which is 1 %.
constexpr std::uint64_t kThreadRays = std::uint64_t{1} << 22;
constexpr std::size_t kThreadRows = 2048;
constexpr std::size_t kBatchRows = 16384;
// With a batch and the time of the sync itself, far under the 30 s that may be lost.
constexpr std::chrono::seconds kBetweenSyncs{5};

double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

/// Rows that are made between two looks at the work file: whole blocks.
std::size_t batch_rows(const PrtHeader& header) {
    const auto threads = static_cast<std::size_t>(thread_count());
    const std::size_t by_rays = static_cast<std::size_t>(kThreadRays / header.rays) * threads;
    const std::size_t most = std::max(kBatchRows, kThreadRows * threads);
    const std::size_t rows = std::clamp<std::size_t>(by_rays, 1, most);
    return (rows + header.block_rows - 1) / header.block_rows * header.block_rows;
}

std::size_t file_bytes(const PrtHeader& header) {
    // And the report.
    constexpr std::size_t kMore = 4096;
    const detail::PrtLayout layout(header);
    return layout.chunks_end() + layout.index_bytes() + kMore;
}

/// Of the merged result, about; never less.
std::size_t result_bytes(const PrtHeader& part, const std::vector<PrtTable>& tables) {
    PrtHeader header = part;
    header.tables = tables;
    return file_bytes(header);
}

/// One pass and its file.
struct Stage {
    PrtHeader header;
    WorkFile work;
    PrtWriter writer;

    Stage(const PrtHeader& given, const BakeRunOptions& options, const std::string& suffix)
        : header(given),
          work(options.output, suffix, options.force),
          writer(work, header, options.force) {}
    bool complete() const { return writer.rows() == header.rows; }
};

}  // namespace

struct BakeRun::State {
    const BakeRunOptions options;
    const BakePlan plan;
    int first = 0, last = 0;  ///< passes of this run
    int start = 0;            ///< the first that is not complete, or the last
    std::map<int, std::unique_ptr<Stage>> stages;
    std::string base;  ///< of the names of their files
    std::uint64_t found = 0;
    std::vector<std::string> warnings;
    BakeRunReport report;
    std::vector<float> before;  ///< the transfer of the pass before
    std::unique_ptr<RayScene> scene;
    std::size_t scene_mesh = 0;
    Progress* progress = nullptr;

    State(const BakeJob& job, const BakeRunOptions& given) : options(given), plan(job) {
        check();
        first = options.pass.value_or(0);
        last = options.pass.value_or(plan.last_pass());
        open(last);
        base = stages[last]->work.path();
        start = first;
        if (stages[last]->complete()) {
            start = last;
        } else {
            find_start();
        }
        for (int pass = first; pass < start; ++pass) {
            if (pass < start - 1 || stages[last]->complete()) remove(pass);
        }
        for (int pass = start; pass < std::min(start + 2, last); ++pass) open(pass);
        for (int pass = first; pass <= last; ++pass) {
            const auto stage = stages.find(pass);
            if (pass < start) found += plan.rows(pass);
            if (pass >= start && stage != stages.end()) found += stage->second->writer.rows();
        }
    }

    void check() const {
        const auto refuse = [](const std::string& message, const char* flag) {
            throw Error(ErrorCode::usage, message, flag);
        };
        if (options.pass && (*options.pass < 0 || *options.pass > plan.last_pass())) {
            refuse(fmt::format("with {} bounces the passes are 0 to {}, got {}", plan.last_pass(),
                               plan.last_pass(), *options.pass),
                   "--pass");
        }
        if (options.shards > 0 && options.shard >= options.shards) {
            refuse(fmt::format("there is no part {} of {}", options.shard + 1, options.shards),
                   "--shard");
        }
        if (options.shards > 0 && !options.pass && plan.last_pass() > 0) {
            refuse(fmt::format("a part of a bake with bounces is of one pass: give --pass 0 to {}",
                               plan.last_pass()),
                   "--shard");
        }
        const int pass = options.pass.value_or(0);
        if (pass > 0 && options.before.empty()) {
            refuse(fmt::format("pass {} needs the merged result of pass {}: give --before FILE.prt",
                               pass, pass - 1),
                   "--pass");
        }
        if (pass == 0 && !options.before.empty()) {
            refuse("goes with --pass 1 and higher only", "--before");
        }
    }

    std::string suffix(int pass) const {
        return pass == last ? kSuffix : fmt::format("{}-pass{}", kSuffix, pass);
    }

    void open(int pass) {
        if (stages.count(pass) > 0) return;
        const PrtHeader header =
            plan.part_header(pass, options.shard, std::max<std::uint32_t>(options.shards, 1));
        // Refuses tables that nobody makes, before the work.
        detail::BakeBuffers(header, 0);
        auto stage = std::make_unique<Stage>(header, options, suffix(pass));
        if (stage->writer.damaged()) {
            warnings.push_back(fmt::format("{}: is damaged from row {} on, which are baked again",
                                           stage->work.path(),
                                           header.first_row + stage->writer.rows()));
        }
        std::size_t bytes = file_bytes(stage->header);
        if (pass == last && options.shards == 0) {
            bytes += result_bytes(stage->header, plan.tables(pass));
        }
        stage->work.reserve(bytes);
        stages[pass] = std::move(stage);
    }

    bool is_there(int pass) const {
        return access(fmt::format("{}-pass{}", base, pass).c_str(), F_OK) == 0;
    }

    void find_start() {
        for (int pass = last - 1; pass >= first; --pass) {
            if (!is_there(pass)) continue;
            open(pass);
            if (!stages[pass]->complete()) continue;
            stages[pass]->writer.finish(plan.part_report(pass));
            start = pass + 1;
            return;
        }
    }

    void remove(int pass) {
        if (stages.count(pass) > 0) {
            stages[pass]->work.remove();
            stages.erase(pass);
        } else if (is_there(pass)) {
            WorkFile(options.output, suffix(pass), options.force).remove();
        }
    }

    /// Fills `before` with the transfer of pass `pass` - 1, in the order of the files.
    void load_before(int pass) {
        if (pass == 0 || plan.rows(pass - 1) == 0) return;
        const bool given = pass == first;
        const std::string path = given ? options.before : stages.at(pass - 1)->work.path();
        const PrtReader reader(path, options.max_memory);
        if (given) check_before(reader, pass);
        const auto rows = static_cast<std::size_t>(reader.header().rows);
        if (!detail::is_part(reader.header())) {
            before = reader.read_all(PrtKind::transfer);
            return;
        }
        const std::size_t width = reader.components(PrtKind::transfer);
        require_memory(rows * width * sizeof(float), options.max_memory, "the light of a bounce",
                       path);
        before.resize(rows * width);
        const std::size_t step = reader.header().block_rows;
        std::vector<float> block(step * width);
        std::vector<std::uint32_t> index(step);
        for (std::size_t begin = 0; begin < rows; begin += step) {
            const std::size_t count = std::min(step, rows - begin);
            reader.read(PrtKind::transfer, begin, count, block.data());
            reader.read(PrtKind::vertex_index, begin, count, index.data());
            for (std::size_t r = 0; r < count; ++r) {
                std::memcpy(before.data() + index[r] * width, block.data() + r * width,
                            width * sizeof(float));
            }
        }
    }

    void check_before(const PrtReader& reader, int pass) const {
        const PrtHeader& header = reader.header();
        if (header.key != plan.key(pass - 1)) {
            throw Error(ErrorCode::data,
                        fmt::format("is not pass {} of this bake, but of another mesh or with "
                                    "other options",
                                    pass - 1),
                        reader.path());
        }
        if (detail::is_part(header)) {
            throw Error(ErrorCode::data,
                        fmt::format("is part {} of {} of pass {}: merge them all first",
                                    header.shard + 1, header.shards, pass - 1),
                        reader.path());
        }
    }

    const RayScene& scene_of(std::size_t mesh) {
        if (scene && scene_mesh == mesh) return *scene;
        const auto begin = Clock::now();
        scene.reset();
        scene = std::make_unique<RayScene>(make_ray_scene(plan.job().scene, mesh));
        scene_mesh = mesh;
        if (mesh == 0) report.scene = scene->report();
        report.scene_seconds += seconds(Clock::now() - begin);
        if (progress != nullptr) progress->tick(0);
        return *scene;
    }

    std::vector<Reflector> reflectors_of(std::size_t mesh) const {
        if (before.empty()) return {};
        const BakeJob& job = plan.job();
        const std::size_t width = prt_components(PrtKind::transfer, job.bake.order);
        std::vector<const float*> transfers;
        for (std::size_t m = 0; m < job.scene.meshes.size(); ++m) {
            const bool reflects = plan.reflects(m);
            transfers.push_back(reflects ? before.data() + plan.stage_offset(m) * width : nullptr);
        }
        return make_reflectors(job.scene, mesh, transfers);
    }

    void make_pass(int pass) {
        open(pass);
        if (pass + 1 < last) open(pass + 1);
        Stage& stage = *stages[pass];
        if (!stage.complete()) {
            load_before(pass);
            make_rows(pass, stage);
            before = {};
        }
        const auto begin = Clock::now();
        stage.writer.finish(plan.part_report(pass));
        if (pass > first) remove(pass - 1);
        report.write_seconds += seconds(Clock::now() - begin);
    }

    void make_rows(int pass, Stage& stage) {
        const BakeJob& job = plan.job();
        const PrtHeader& header = stage.header;
        const std::uint64_t batch = batch_rows(header);
        detail::BakeBuffers buffers(header, static_cast<std::size_t>(std::min(batch, header.rows)));
        auto synced = Clock::now();
        std::future<void> syncing;
        for (std::uint64_t row = stage.writer.rows(); row < header.rows;) {
            const auto count = static_cast<std::size_t>(std::min(batch, header.rows - row));
            std::size_t at = 0;
            for (const BakeSegment& segment : plan.segments(pass, header.first_row + row, count)) {
                const RayScene& rays = scene_of(segment.mesh);
                const auto begin = Clock::now();
                bake_vertices(*job.scene.meshes[segment.mesh], rays, job.bake, segment.vertices,
                              segment.count, buffers.rows(at), reflectors_of(segment.mesh),
                              progress);
                report.bake_seconds += seconds(Clock::now() - begin);
                buffers.name(at, segment);
                at += segment.count;
            }
            const auto begin = Clock::now();
            stage.writer.append(count, buffers.columns());
            row += count;
            report.write_seconds += seconds(Clock::now() - begin);
            if (Clock::now() - synced > kBetweenSyncs) {
                if (syncing.valid()) syncing.get();
                synced = Clock::now();
                syncing = std::async(std::launch::async, [&stage] { stage.work.sync(); });
            }
        }
        if (syncing.valid()) syncing.get();
    }

    void finish() {
        Stage& stage = *stages[last];
        scene.reset();
        const auto begin = Clock::now();
        report.key = stage.header.key;
        report.rows = rows();
        report.resumed = found;
        if (options.shards > 0) {
            report.counts = count_rays(PrtReader(stage.work.path(), options.max_memory));
            stage.work.publish();
        } else {
            stage.work.cut(stage.work.size());
            MergeOptions merging;
            merging.force = options.force;
            merging.max_memory = options.max_memory;
            merging.progress.quiet = true;
            merging.progress.interruptible = true;
            const MergeReport merged = merge_parts({stage.work.path()}, options.output, merging);
            report.counts = merged.counts;
            report.notes = merged.notes;
            stage.work.remove();
        }
        // What a job with more bounces may have left.
        for (int pass = 0; pass < kLargestBounces; ++pass) {
            if (!is_there(pass)) continue;
            WorkFile(options.output, fmt::format("{}-pass{}", kSuffix, pass), true).remove();
        }
        report.write_seconds += seconds(Clock::now() - begin);
    }

    std::uint64_t rows() const {
        std::uint64_t sum = stages.at(last)->header.rows;
        for (int pass = first; pass < last; ++pass) sum += plan.rows(pass);
        return sum;
    }

    /// Rows that are on the disk, in percent of all.
    int percent() const {
        std::uint64_t done = 0;
        int complete = last;
        for (const auto& [pass, stage] : stages) {
            stage->work.sync();
            done += stage->writer.rows();
            complete = std::min(complete, pass);
        }
        // What is before the first of the files was finished and is not needed any more.
        for (int pass = first; pass < complete; ++pass) done += plan.rows(pass);
        const std::uint64_t all = rows();
        return all == 0 ? 100 : static_cast<int>(100 * done / all);
    }
};

BakeRun::BakeRun(const BakeJob& job, const BakeRunOptions& options)
    : state_(std::make_unique<State>(job, options)) {}
BakeRun::~BakeRun() = default;

std::uint64_t BakeRun::rows() const {
    return state_->rows();
}
std::uint64_t BakeRun::found() const {
    return state_->found;
}
const std::vector<std::string>& BakeRun::warnings() const {
    return state_->warnings;
}

BakeRunReport BakeRun::run(Progress* progress) {
    State& s = *state_;
    s.progress = progress;
    try {
        for (int pass = s.start; pass <= s.last; ++pass) s.make_pass(pass);
        s.finish();
    } catch (const Interrupted& interrupted) {
        throw Interrupted(
            interrupted.signal(),
            fmt::format("interrupted at {} %; the same command goes on from there", s.percent()));
    }
    return s.report;
}

}  // namespace airlight
