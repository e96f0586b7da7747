// SPDX-License-Identifier: Apache-2.0
// airlight bake: how the vertices of a mesh see and reflect distant light.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/bake_flags.h"
#include "cli/command.h"
#include "cli/stopwatch.h"
#include "core/interrupt.h"
#include "core/memory.h"
#include "core/progress.h"
#include "prt/bake_run.h"
#include "prt/mesh_io.h"

namespace airlight {
namespace {

/// What was found in the mesh and is worth a warning.
std::vector<std::string> notes_of(const MeshReport& mesh) {
    std::vector<std::string> notes = mesh.notes;
    const auto note = [&](std::uint64_t count, const char* what) {
        if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
    };
    note(mesh.nonfinite, "non-finite coordinates became 0");
    note(mesh.degenerate, "triangles named a vertex twice and were dropped");
    note(mesh.duplicate, "triangles repeated another and were dropped");
    note(mesh.normals_up, "vertices belong to no triangle with area: their normal is +Y");
    note(mesh.against_winding, "triangles face away from the normals of the file");
    return notes;
}

BakeJob job_of(const BakeRequest& request, const std::vector<Mesh>& meshes,
               const MeshReport& read) {
    BakeJob job;
    for (const Mesh& mesh : meshes) job.scene.meshes.push_back(&mesh);
    job.scene.albedos = request.albedos;
    job.scene.rays = request.scene;
    job.bake = request.bake;
    job.bounces = request.bounces;
    for (const PrtKind kind : request.kinds) job.tables.push_back({kind, request.type});
    if (request.bake.method == BakeMethod::adaptive) {
        const auto kept = [&](PrtKind kind) {
            return std::count(request.kinds.begin(), request.kinds.end(), kind) > 0;
        };
        if (kept(PrtKind::visibility)) {
            job.tables.push_back({PrtKind::visibility_error, PrtType::float32});
        }
        if (kept(PrtKind::transfer)) {
            job.tables.push_back({PrtKind::transfer_error, PrtType::float32});
        }
        job.tables.push_back({PrtKind::ray_count, PrtType::uint32});
    }
    job.program = "airlight " AIRLIGHT_VERSION;
    job.notes = notes_of(read);
    return job;
}

BakeRunOptions run_options(const BakeRequest& request, const CommonOptions& common) {
    BakeRunOptions options;
    options.output = request.output;
    options.force = common.force;
    options.max_memory = common.max_memory;
    options.shard = request.shard;
    options.shards = request.shards;
    options.pass = request.pass;
    options.before = request.before;
    return options;
}

BakeRunReport run_job(const BakeJob& job, const BakeRunOptions& options, bool quiet) {
    const InterruptGuard guard;
    BakeRun run(job, options);
    for (const std::string& warning : run.warnings()) spdlog::warn("{}", warning);
    if (run.found() > 0) {
        spdlog::warn("{}: goes on at {} %", options.output, 100 * run.found() / run.rows());
    }
    ProgressOptions drawing;
    drawing.quiet = quiet;
    drawing.before = run.found();
    drawing.interruptible = true;
    Progress progress("bake", run.rows(), drawing);
    return run.run(&progress);
}

void print_report(const BakeRequest& request, const BakeJob& job, const BakeRunReport& report,
                  double read_seconds) {
    nlohmann::ordered_json json = {{"version", AIRLIGHT_VERSION},
                                   {"input", request.inputs[0]},
                                   {"output", request.output},
                                   {"vertices", job.scene.meshes[0]->positions.size()},
                                   {"triangles", report.scene.triangles},
                                   {"order", job.bake.order},
                                   {"method", method_name(kBakeMethods, job.bake.method)},
                                   {"tolerance", job.bake.tolerance},
                                   {"rays", report.counts.rays},
                                   {"unmet_vertices", report.counts.unmet},
                                   {"bounces", job.bounces},
                                   {"blocked", report.counts.blocked},
                                   {"mostly_blocked_vertices", report.counts.mostly_blocked},
                                   {"scene_bytes", report.scene.bytes},
                                   {"key", to_text(report.key)},
                                   {"rows", report.rows},
                                   {"resumed_rows", report.resumed}};
    if (request.pass) json["pass"] = *request.pass;
    if (request.shards > 0) json["part"] = {{"number", request.shard + 1}, {"of", request.shards}};
    json["seconds"] = {{"read", read_seconds},
                       {"scene", report.scene_seconds},
                       {"bake", report.bake_seconds},
                       {"write", report.write_seconds}};
    json["peak_memory_bytes"] = peak_memory();
    json["notes"] = report.notes;
    print(json);
}

void run_bake(BakeRequest request, const CommonOptions& common) {
    resolve_bake_method(request);
    check_bake_request(request, common.force);
    const auto start = std::chrono::steady_clock::now();
    request.read.max_memory = request.scene.max_memory = common.max_memory;
    MeshReport read;
    std::vector<Mesh> meshes = {read_mesh(request.inputs[0], request.read, &read)};
    for (const std::string& path : request.occluders) {
        meshes.push_back(read_mesh(path, request.read));
    }
    const double read_seconds = seconds_since(start);
    const BakeJob job = job_of(request, meshes, read);
    const BakeRunReport report = run_job(job, run_options(request, common), common.verbosity < 0);
    const std::string& input = request.inputs[0];
    for (const std::string& note : report.notes) {
        spdlog::warn("{}: {}", input == "-" ? "standard input" : input, note);
    }
    if (common.json) print_report(request, job, report, read_seconds);
}

}  // namespace

Command declare_bake(CLI::App& program) {
    Command command = declare_command(
        program, "bake", "MESH -o OUT.prt",
        "Precompute how the vertices of a mesh see and reflect distant light",
        "  airlight bake bunny.obj -o bunny.prt\n"
        "  airlight bake statue.ply -o statue.prt --order 4 --rays 4096 --ground 0\n"
        "  airlight bake statue.ply -o statue.prt --tolerance 1e-3\n"
        "  airlight bake cup.obj -o cup.prt --bounces 3 --albedo 0.7\n"
        "  airlight bake chair.obj -o chair.prt --occluder room.obj --bounces 2 --albedo 0.5,0.8\n"
        "  airlight bake statue.ply -o part3.prt --shard 3/8\n"
        "Meshes are OBJ, PLY, STL or OFF. airlight info describes the result, airlight export\n"
        "turns it into .npy or .ply. A bake that is interrupted goes on where it was when the "
        "same\n"
        "command runs again.");
    const auto request = std::make_shared<BakeRequest>();
    command.app->add_option("meshes", request->inputs, "A mesh (- is standard input)")
        ->option_text(" ");
    add_bake_flags(command, *request);
    add_json_flag(command, "Report on standard output: counts, rays, seconds, memory, notes");
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_bake(*request, *common); };
    return command;
}

}  // namespace airlight
