// SPDX-License-Identifier: Apache-2.0
// airlight export: what airlight computed, in the formats of other programs.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "cli/command.h"
#include "cli/engine_flags.h"
#include "cli/export_prt.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "prt/prt_reader.h"
#include "sh/sh_file.h"

namespace airlight {
namespace {

struct ExportRequest {
    std::vector<std::string> inputs;
    std::string output;
    EngineFlags engine;
    PrtExport prt;
};

void check_paths(const ExportRequest& request) {
    if (request.inputs.size() != 1) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "an input is missing (see airlight export --help)"
                                          : "takes one input, not several");
    }
    if (request.output.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o FILE");
    }
}

void check_light(const ExportRequest& request, const CommonOptions& common) {
    if (request.prt.kind || !request.prt.mesh.empty()) {
        throw Error(ErrorCode::usage, "is for .prt files alone",
                    request.prt.kind ? "--kind" : "--mesh");
    }
    if (!request.engine.format) {
        throw Error(ErrorCode::usage,
                    "the format is missing: give --format filament, three, unity, unreal or gltf");
    }
    if (request.output != "-") check_target(request.output, common.force);
}

void run_export(const ExportRequest& request, const CommonOptions& common) {
    check_paths(request);
    const std::string& input = request.inputs[0];
    if (looks_like_prt(input)) {
        if (request.engine.format || request.engine.turn) {
            throw Error(ErrorCode::usage, "is for coefficient files alone",
                        request.engine.format ? "--format" : "--turn");
        }
        return export_prt(request.prt, input, request.output, common);
    }
    check_light(request, common);
    const ShFile light = read_sh_file(input, common.max_memory);
    const std::string name = input == "-" ? "standard input" : input;
    if (light.order > 3) {
        spdlog::info("{}: engines take three of its {} degrees", name, light.order);
    }
    std::string text;
    try {
        text = engine_text(request.engine, light.order, light.coefficients);
    } catch (const Error& error) {
        throw Error(error.code(), error.what(), name);
    }
    if (light.sun) warn_of_sun(request.engine, *light.sun, request.output);
    if (request.output == "-") return print(text);
    write_file_atomically(request.output, text, common.force);
}

}  // namespace

Command declare_export(CLI::App& program) {
    Command command = declare_command(
        program, "export", "IN -o OUT",
        "Turn a coefficient file of airlight sh into what engines read, and a .prt file into .npy "
        "or "
        ".ply",
        "  airlight sh room.exr -o room.json\n"
        "  airlight export room.json -o sh.txt --format filament\n"
        "  airlight export room.json -o room.gltf --format gltf\n"
        "  airlight export bunny.prt -o bunny.npy --kind visibility\n"
        "  airlight export bunny.prt --mesh bunny.obj -o bunny.ply\n"
        "Engines take three degrees: windows should be chosen with airlight sh --order 3.");
    const auto request = std::make_shared<ExportRequest>();
    command.app
        ->add_option("files", request->inputs,
                     "A coefficient file (.json; - is standard input), or a .prt file")
        ->option_text(" ");
    add_flag(command, "-o,--output", "FILE", "What to write (- is standard output)",
             [request](const std::string& text) { request->output = text; });
    add_flag(command, "--format", "filament|three|unity|unreal|gltf", kEngineFormatHelp,
             [request](const std::string& text) {
                 request->engine.format = parse_engine(text, "--format", false);
             });
    add_turn_flag(command, request->engine);
    add_prt_flags(command, request->prt);
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_export(*request, *common); };
    return command;
}

}  // namespace airlight
