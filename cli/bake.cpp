// SPDX-License-Identifier: Apache-2.0
// airlight bake: how the vertices of a mesh see and reflect distant light.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/stopwatch.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/progress.h"
#include "prt/bake.h"
#include "prt/bake_scene.h"
#include "prt/mesh_io.h"
#include "prt/prt_key.h"
#include "prt/prt_writer.h"
#include "prt/ray_scene.h"

namespace airlight {
namespace {

struct BakeRequest {
    std::vector<std::string> inputs;
    std::string output;
    std::vector<std::string> occluders;
    std::vector<PrtKind> kinds = {PrtKind::visibility, PrtKind::transfer};
    BakeOptions bake;
    RaySceneOptions scene;
    MeshReadOptions read;
    PrtType type = PrtType::float32;
    int bounces = 0;
    std::vector<double> albedos = {0.5};  // of the mesh, then of the occluders
    bool albedo_given = false;
};

constexpr PrtKind kBakedKinds[] = {PrtKind::visibility, PrtKind::transfer,
                                   PrtKind::unshadowed_transfer, PrtKind::bent_normal,
                                   PrtKind::ambient_occlusion};

std::string kind_names() {
    std::string names;
    for (const PrtKind kind : kBakedKinds) names += (names.empty() ? "" : ", ") + prt_name(kind);
    return names;
}

std::vector<double> parse_albedos(const std::string& text) {
    std::vector<double> albedos;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        albedos.push_back(parse_number(text.substr(begin, end - begin), "--albedo", {0, 1}));
        begin = end + 1;
    }
    return albedos;
}

std::vector<PrtKind> parse_kinds(const std::string& text) {
    std::vector<PrtKind> kinds;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string name = text.substr(begin, end - begin);
        const auto* found = std::find_if(std::begin(kBakedKinds), std::end(kBakedKinds),
                                         [&](PrtKind kind) { return prt_name(kind) == name; });
        if (found == std::end(kBakedKinds)) {
            throw Error(ErrorCode::usage,
                        "'" + name + "' is no kind; the kinds are " + kind_names(), "--kind");
        }
        if (std::find(kinds.begin(), kinds.end(), *found) != kinds.end()) {
            throw Error(ErrorCode::usage, name + " is named twice", "--kind");
        }
        kinds.push_back(*found);
        begin = end + 1;
    }
    return kinds;
}

/// What was found on the way and is worth a warning.
std::vector<std::string> notes_of(const MeshReport& mesh, const BakeReport& bake, bool occluders) {
    std::vector<std::string> notes = mesh.notes;
    const auto note = [&](std::uint64_t count, const char* what) {
        if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
    };
    note(mesh.nonfinite, "non-finite coordinates became 0");
    note(mesh.degenerate, "triangles named a vertex twice and were dropped");
    note(mesh.duplicate, "triangles repeated another and were dropped");
    note(mesh.normals_up, "vertices belong to no triangle with area: their normal is +Y");
    note(mesh.against_winding, "triangles face away from the normals of the file");
    if (!occluders && 2 * bake.mostly_blocked > bake.vertices) {
        notes.push_back(
            fmt::format("{} of {} vertices see less than half of their hemisphere: if the mesh "
                        "should be seen from outside, its winding or normals may be turned",
                        bake.mostly_blocked, bake.vertices));
    }
    return notes;
}

PrtKey key_of(const BakeRequest& request, const Mesh& mesh, const std::vector<Mesh>& occluders) {
    PrtKeyHash hash;
    hash.add("airlight bake 1").add(mesh).add_integer(occluders.size());
    for (const Mesh& occluder : occluders) hash.add(occluder);
    hash.add_integer(static_cast<std::uint64_t>(request.bake.order));
    hash.add_integer(static_cast<std::uint64_t>(request.bake.rays));
    hash.add_integer(request.scene.ground_height ? 1 : 0);
    hash.add(request.scene.ground_height.value_or(0));
    hash.add_integer(static_cast<std::uint64_t>(request.bounces));
    for (std::size_t i = 0; i <= occluders.size(); ++i) {
        const bool reflects = request.bounces > 0 && i < request.albedos.size();
        hash.add(reflects ? request.albedos[i] : 0.0);
    }
    for (const PrtKind kind : request.kinds) hash.add(prt_name(kind));
    hash.add(prt_name(request.type));
    return hash.key();
}

PrtColumn column_of(const Bake& bake, PrtKind kind) {
    switch (kind) {
        case PrtKind::visibility:
            return bake.visibility;
        case PrtKind::unshadowed_transfer:
            return bake.unshadowed_transfer;
        case PrtKind::bent_normal:
            return bake.bent_normal;
        case PrtKind::ambient_occlusion:
            return bake.ambient_occlusion;
        default:
            return bake.transfer;
    }
}

bool has(const BakeRequest& request, PrtKind kind) {
    return std::find(request.kinds.begin(), request.kinds.end(), kind) != request.kinds.end();
}

void check(const BakeRequest& request, const CommonOptions& common) {
    if (request.inputs.size() != 1) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "a mesh is missing (see airlight bake --help)"
                                          : "takes one mesh; others can hide its light with "
                                            "--occluder FILE");
    }
    if (request.output.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o FILE.prt");
    }
    if (request.output == "-") {
        throw Error(ErrorCode::usage, "a .prt file cannot go to standard output", "-o");
    }
    if (request.albedo_given && request.bounces == 0) {
        throw Error(ErrorCode::usage, "goes with --bounces only", "--albedo");
    }
    if (request.albedos.size() > 1 + request.occluders.size()) {
        throw Error(ErrorCode::usage,
                    fmt::format("names {} albedos, there are {} meshes", request.albedos.size(),
                                1 + request.occluders.size()),
                    "--albedo");
    }
    if (request.bounces > 0 && !has(request, PrtKind::transfer)) {
        throw Error(ErrorCode::usage, "goes with the kind transfer only", "--bounces");
    }
    check_target(request.output, common.force);
}

void run_bake(BakeRequest request, const CommonOptions& common) {
    check(request, common);
    auto start = std::chrono::steady_clock::now();
    request.read.max_memory = request.scene.max_memory = common.max_memory;
    MeshReport read;
    const std::string& input = request.inputs[0];
    const std::string name = input == "-" ? "standard input" : input;
    const Mesh mesh = read_mesh(input, request.read, &read);
    std::vector<Mesh> occluders;
    for (const std::string& path : request.occluders) {
        occluders.push_back(read_mesh(path, request.read));
    }
    const double read_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    BakeScene meshes;
    meshes.meshes.push_back(&mesh);
    for (const Mesh& occluder : occluders) meshes.meshes.push_back(&occluder);
    meshes.albedos = request.albedos;
    meshes.rays = request.scene;
    BakeKinds kinds;
    kinds.visibility = has(request, PrtKind::visibility);
    kinds.transfer = has(request, PrtKind::transfer);
    kinds.unshadowed_transfer = has(request, PrtKind::unshadowed_transfer);
    kinds.ambient_occlusion = has(request, PrtKind::ambient_occlusion);
    kinds.bent_normal = has(request, PrtKind::bent_normal);
    ProgressOptions drawing;
    drawing.quiet = common.verbosity < 0;
    Bake bake;
    {
        Progress progress("bake", bake_scene_ticks(meshes, request.bounces), drawing);
        bake =
            bake_scene(meshes, request.bake, request.bounces, kinds, common.max_memory, &progress);
    }
    const double bake_seconds = seconds_since(start);
    const std::vector<std::string> notes = notes_of(read, bake.report, !occluders.empty());
    for (const std::string& note : notes) spdlog::warn("{}: {}", name, note);

    start = std::chrono::steady_clock::now();
    PrtHeader header;
    header.order = request.bake.order;
    for (const PrtKind kind : request.kinds) header.tables.push_back({kind, request.type});
    header.mesh_vertices = header.rows = mesh.positions.size();
    header.rays = static_cast<std::uint64_t>(request.bake.rays);
    header.key = key_of(request, mesh, occluders);
    header.mesh = mesh_key(mesh);
    std::vector<PrtColumn> columns;
    for (const PrtKind kind : request.kinds) columns.push_back(column_of(bake, kind));
    PrtWriter writer(request.output, header, common.force);
    writer.append(mesh.positions.size(), columns);
    // Nothing that differs between equal bakes: the file's bytes follow from its key.
    writer.finish(nlohmann::ordered_json{
        {"program", "airlight " AIRLIGHT_VERSION},
        {"blocked", bake.report.blocked},
        {"notes",
         notes}}.dump());
    const double write_seconds = seconds_since(start);
    if (!common.json) return;
    print(nlohmann::ordered_json{
        {"version", AIRLIGHT_VERSION},
        {"input", input},
        {"output", request.output},
        {"vertices", mesh.positions.size()},
        {"triangles", bake.scene.triangles},
        {"order", request.bake.order},
        {"rays", bake.report.rays},
        {"bounces", request.bounces},
        {"blocked", bake.report.blocked},
        {"mostly_blocked_vertices", bake.report.mostly_blocked},
        {"scene_bytes", bake.scene.bytes},
        {"key", to_text(header.key)},
        {"seconds", {{"read", read_seconds}, {"bake", bake_seconds}, {"write", write_seconds}}},
        {"peak_memory_bytes", peak_memory()},
        {"notes", notes}});
}

void add_flags(const Command& command, BakeRequest& request) {
    add_flag(command, "-o,--output", "FILE.prt", "The result (docs/PRT_FILES.md)",
             [&](const std::string& text) { request.output = text; });
    add_flag(command, "--order", "N",
             "Coefficients of degree l = 0 ... N-1 (default: 6, at most 10)",
             [&](const std::string& text) {
                 request.bake.order = parse_integer(text, "--order", 1, kLargestBakeOrder);
             });
    add_flag(command, "--rays", "N", "Directions of the hemisphere of each vertex (default: 1024)",
             [&](const std::string& text) {
                 request.bake.rays = parse_integer(text, "--rays", 1, kLargestBakeRays);
             });
    add_flag(command, "--bounces", "N",
             "Times that light goes on between parts of the mesh, in transfer (default: 0)",
             [&](const std::string& text) {
                 request.bounces = parse_integer(text, "--bounces", 0, kLargestBounces);
             });
    add_flag(command, "--albedo", "A[,A...]",
             "Albedos in [0, 1] for --bounces: the mesh's (default: 0.5), then those of the\n"
             "occluders in their order (default: 0, black)",
             [&](const std::string& text) {
                 request.albedos = parse_albedos(text);
                 request.albedo_given = true;
             });
    add_flag(command, "--kind", "KIND[,KIND...]", kind_names() + " (default: visibility,transfer)",
             [&](const std::string& text) { request.kinds = parse_kinds(text); });
    command.app
        ->add_option("--occluder", request.occluders,
                     "A further mesh that hides light, in the same world; may be repeated")
        ->option_text("FILE")
        ->allow_extra_args(false);
    add_flag(command, "--ground", "Y", "Everything under that height is solid",
             [&](const std::string& text) {
                 request.scene.ground_height = parse_number(text, "--ground", {-1e100, 1e100});
             });
    add_flag(command, "--type", "float32|float16",
             "How numbers are stored; float16 records its error (default: float32)",
             [&](const std::string& text) {
                 request.type = parse_choice(text, "--type", {"float32", "float16"}) == 0
                                    ? PrtType::float32
                                    : PrtType::float16;
             });
    add_flag(command, "--nonfinite", "refuse|zero",
             "NaN and infinite coordinates of the meshes (default: refuse)",
             [&](const std::string& text) {
                 request.read.nonfinite = parse_choice(text, "--nonfinite", {"refuse", "zero"}) == 0
                                              ? NonfiniteVertex::refuse
                                              : NonfiniteVertex::zero;
             });
}

}  // namespace

Command declare_bake(CLI::App& program) {
    Command command = declare_command(
        program, "bake", "MESH -o OUT.prt",
        "Precompute how the vertices of a mesh see and reflect distant light",
        "  airlight bake bunny.obj -o bunny.prt\n"
        "  airlight bake statue.ply -o statue.prt --order 4 --rays 4096 --ground 0\n"
        "  airlight bake cup.obj -o cup.prt --bounces 3 --albedo 0.7\n"
        "  airlight bake chair.obj -o chair.prt --occluder room.obj --bounces 2 --albedo 0.5,0.8\n"
        "Meshes are OBJ, PLY, STL or OFF. airlight info describes the result, airlight export\n"
        "turns it into .npy or .ply.");
    const auto request = std::make_shared<BakeRequest>();
    command.app->add_option("meshes", request->inputs, "A mesh (- is standard input)")
        ->option_text(" ");
    add_flags(command, *request);
    add_json_flag(command, "Report on standard output: counts, rays, seconds, memory, notes");
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_bake(*request, *common); };
    return command;
}

}  // namespace airlight
