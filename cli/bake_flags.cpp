// SPDX-License-Identifier: Apache-2.0
#include "cli/bake_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "cli/numbers.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "prt/adaptive_hemisphere.h"
#include "prt/bake_plan.h"

namespace airlight {
namespace {

constexpr PrtKind kBakedKinds[] = {PrtKind::visibility, PrtKind::transfer,
                                   PrtKind::unshadowed_transfer, PrtKind::bent_normal,
                                   PrtKind::ambient_occlusion};

std::string kind_names() {
    std::string names;
    for (const PrtKind kind : kBakedKinds) names += (names.empty() ? "" : ", ") + prt_name(kind);
    return names;
}

std::vector<std::string> bake_methods() {
    return method_names(kBakeMethods, BakeMethod::fibonacci);
}

BakeMethod parse_method(const std::string& text) {
    const auto method = method_from_name(kBakeMethods, text);
    if (!method) {
        throw Error(ErrorCode::usage,
                    "'" + text + "' is no method; it can be " + list_choices(bake_methods()),
                    "--method");
    }
    return *method;
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

void parse_shard(const std::string& text, BakeRequest& request) {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) {
        throw Error(ErrorCode::usage, "'" + text + "' is not I/N, as in 3/8", "--shard");
    }
    const int shards = parse_integer(text.substr(slash + 1), "--shard", 1, kMostShards);
    request.shards = static_cast<std::uint32_t>(shards);
    request.shard =
        static_cast<std::uint32_t>(parse_integer(text.substr(0, slash), "--shard", 1, shards) - 1);
}

// With --force a bake would replace what it reads.
void check_files_read(const BakeRequest& request) {
    std::vector<std::string> files = request.inputs;
    files.insert(files.end(), request.occluders.begin(), request.occluders.end());
    if (std::count(files.begin(), files.end(), "-") > 1) {
        throw Error(ErrorCode::usage, "standard input holds one mesh only", "--occluder");
    }
    files.push_back(request.before);
    for (const std::string& file : files) {
        std::error_code none;
        if (file != "-" && std::filesystem::equivalent(file, request.output, none)) {
            throw Error(ErrorCode::usage, "is read by this bake and cannot be its output", file);
        }
    }
}

}  // namespace

void resolve_bake_method(BakeRequest& request) {
    BakeOptions& bake = request.bake;
    const BakeMethod fitting = bake.tolerance > 0 ? BakeMethod::adaptive : BakeMethod::fibonacci;
    bake.method = request.method.value_or(fitting);
    const bool adaptive = bake.method == BakeMethod::adaptive;
    if (adaptive && bake.tolerance == 0) {
        throw Error(ErrorCode::usage, "adaptive needs a --tolerance to stop at", "--method");
    }
    if (!adaptive && bake.tolerance > 0) {
        throw Error(ErrorCode::usage,
                    fmt::format("{} takes a fixed number of --rays and estimates no error: leave "
                                "--tolerance out, or take adaptive",
                                method_name(kBakeMethods, bake.method)),
                    "--method");
    }
    if (adaptive && request.rays.value_or(kAdaptiveBakeRays) < kFewestAdaptiveRays) {
        throw Error(ErrorCode::usage,
                    fmt::format("must be {} or more with --tolerance, got {}", kFewestAdaptiveRays,
                                *request.rays),
                    "--rays");
    }
    bake.rays = request.rays.value_or(adaptive ? kAdaptiveBakeRays : BakeOptions().rays);
}

void check_bake_request(const BakeRequest& request, bool force) {
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
    if (request.bounces > 0 &&
        std::count(request.kinds.begin(), request.kinds.end(), PrtKind::transfer) == 0) {
        throw Error(ErrorCode::usage, "goes with the kind transfer only", "--bounces");
    }
    check_files_read(request);
    check_target(request.output, force);
}

void add_bake_flags(const Command& command, BakeRequest& request) {
    add_flag(command, "-o,--output", "FILE.prt", "The result (docs/PRT_FILES.md)",
             [&](const std::string& text) { request.output = text; });
    add_flag(command, "--order", "N",
             "Coefficients of degree l = 0 ... N-1 (default: 6, at most 10)",
             [&](const std::string& text) {
                 request.bake.order = parse_integer(text, "--order", 1, kLargestBakeOrder);
             });
    add_flag(command, "--rays", "N",
             "Directions of the hemisphere of each vertex (default: 1024); with --tolerance the\n"
             "most that a vertex may take, about (default: 16384)",
             [&](const std::string& text) {
                 request.rays = parse_integer(text, "--rays", 1, kLargestBakeRays);
             });
    add_flag(
        command, "--tolerance", "E",
        "Each vertex takes rays until the estimate of its error, relative to an open\n"
        "hemisphere, is E or less in the visibility and transfer that are kept; the file\n"
        "records the estimates",
        [&](const std::string& text) {
            request.bake.tolerance = parse_number(text, "--tolerance", {kSmallestBakeTolerance, 1});
        });
    add_flag(command, "--method", "NAME",
             fmt::format("How directions are chosen: {} (default: fibonacci,\nwith --tolerance "
                         "adaptive)",
                         fmt::join(bake_methods(), ", ")),
             [&](const std::string& text) { request.method = parse_method(text); });
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
    add_flag(command, "--shard", "I/N",
             "Make part I of N (from 1) alone, for airlight merge (docs/farm.md)",
             [&](const std::string& text) { parse_shard(text, request); });
    add_flag(command, "--pass", "K", "Make pass K of 0 ... --bounces alone (docs/farm.md)",
             [&](const std::string& text) {
                 request.pass = parse_integer(text, "--pass", 0, kLargestBounces);
             });
    add_flag(command, "--before", "FILE.prt", "The merged result of the pass before --pass K",
             [&](const std::string& text) { request.before = text; });
    command.app->add_flag(
        "--force", command.common->force,
        "Replace an existing output, and discard unfinished work that is not of these flags");
}

}  // namespace airlight
