// SPDX-License-Identifier: Apache-2.0
// airlight brdf: a tabulated BRDF in, the effective one of a surface lit through fog out.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/brdf_report.h"
#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/phase_flag.h"
#include "cli/stopwatch.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/progress.h"
#include "sh/brdf_file.h"
#include "sh/brdf_fog.h"
#include "sh/brdf_models.h"

namespace airlight {
namespace {

struct BrdfRequest {
    std::vector<std::string> paths;
    bool has_thickness = false;
    BrdfFogOptions fog;
    BrdfReadOptions read;
};

// "metal:A" and "lambert:R" are tables of ours.
std::optional<BrdfTable> built_in(const std::string& name) {
    const std::size_t colon = name.find(':');
    const std::string kind = name.substr(0, colon);
    if (colon == std::string::npos || (kind != "metal" && kind != "lambert")) return std::nullopt;
    const std::string value = name.substr(colon + 1);
    if (kind == "lambert") return tabulate_lambertian(parse_number(value, name, {0, 1}));
    RoughMetal metal;
    metal.roughness = parse_number(value, name, {1e-3, 1});
    return tabulate(metal);
}

void run_brdf(BrdfRequest request, const CommonOptions& common) {
    if (request.paths.size() != 2) {
        throw Error(ErrorCode::usage,
                    request.paths.size() < 2
                        ? "an input and an output are needed (see airlight brdf --help)"
                        : "takes one input and one output, got also " + request.paths[2]);
    }
    if (!request.has_thickness) {
        throw Error(ErrorCode::usage, "the fog is missing: give --optical-thickness T");
    }
    const std::string &input = request.paths[0], &output = request.paths[1];
    if (output != "-") check_target(output, common.force);
    if (output == "-" && common.json) {
        throw Error(ErrorCode::usage, "cannot go with the output -, which is standard output",
                    "--json");
    }
    auto start = std::chrono::steady_clock::now();
    request.read.max_memory = common.max_memory;
    BrdfReadReport read;
    const std::optional<BrdfTable> ours = built_in(input);
    const BrdfTable table = ours ? *ours : read_brdf(input, request.read, &read);
    const double read_seconds = seconds_since(start);
    const std::string name = input == "-" ? "standard input" : input;
    std::vector<std::string> notes;
    if (read.nonfinite > 0) {
        notes.push_back(
            fmt::format("{} non-finite values count as cells without a value", read.nonfinite));
    }
    require_memory(foggy_brdf_memory(table.size, request.fog), common.max_memory,
                   "computing its fog", name);

    start = std::chrono::steady_clock::now();
    BrdfFogReport report;
    BrdfTable foggy;
    {
        ProgressOptions drawing;
        drawing.quiet = common.verbosity < 0;
        Progress progress("brdf", static_cast<std::uint64_t>(request.fog.outgoing), drawing);
        foggy = foggy_brdf(table, request.fog, &report, [&] { progress.tick(); });
    }
    const double compute_seconds = seconds_since(start);
    if (!foggy.size.directed() && report.asymmetry > 1e-6) {
        notes.push_back(fmt::format(
            "light through fog is not reciprocal: the layout holds the mean of both directions, "
            "{:.3g} of the whole away from either (--directed keeps both)",
            report.asymmetry));
    }
    if (report.tail > 0.05) {
        notes.push_back(
            fmt::format("{:.3g} of the scattered light is in the upper half of the {} "
                        "bands; a higher --order would resolve more",
                        report.tail, request.fog.order));
    }
    for (const std::string& note : notes) spdlog::warn("{}: {}", name, note);

    start = std::chrono::steady_clock::now();
    write_brdf(output, foggy, common.force);
    const double write_seconds = seconds_since(start);
    if (!common.json) return;
    print(nlohmann::ordered_json{
        {"version", AIRLIGHT_VERSION},
        {"input", input},
        {"output", output},
        {"optical_thickness", request.fog.optical_thickness},
        {"albedo", request.fog.albedo},
        {"phase", phase_name(request.fog.phase)},
        {"psf", request.fog.psf == PsfForm::exact ? "exact" : "factored"},
        {"order", request.fog.order},
        {"tail", report.tail},
        {"undershoots", {{"cells", report.undershoots}, {"deepest", report.deepest}}},
        {"asymmetry", report.asymmetry},
        {"before", to_json(brdf_figures(table, read.nonfinite))},
        {"after", to_json(brdf_figures(foggy))},
        {"seconds",
         {{"read", read_seconds}, {"compute", compute_seconds}, {"write", write_seconds}}},
        {"peak_memory_bytes", peak_memory()},
        {"notes", notes}});
}

void add_flags(const Command& command, BrdfRequest& request) {
    add_flag(command, "--optical-thickness", "T[,T,T]",
             "Optical thickness between surface and source, one value or R,G,B",
             [&](const std::string& text) {
                 request.fog.optical_thickness =
                     parse_channels(text, "--optical-thickness", kNotNegative);
                 request.has_thickness = true;
             });
    add_flag(command, "--albedo", "A[,A,A]", "Single-scattering albedo in [0, 1] (default: 1)",
             [&](const std::string& text) {
                 request.fog.albedo = parse_channels(text, "--albedo", {0, 1});
             });
    add_flag(command, "--phase", "isotropic|rayleigh|hg:G|table:FILE",
             "Phase function, as for airlight fog (default: isotropic)",
             [&](const std::string& text) { request.fog.phase = parse_phase(text, "--phase"); });
    add_flag(command, "--psf", "exact|factored",
             "Point spread function: exact at this T, or the paper's T e^-T NPSF (default: exact)",
             [&](const std::string& text) {
                 request.fog.psf = parse_choice(text, "--psf", {"exact", "factored"}) == 0
                                       ? PsfForm::exact
                                       : PsfForm::factored;
             });
    add_flag(command, "--component", "total|direct|scattered",
             "What to write: e^-T times the BRDF, what airlight adds, or the sum (default: total)",
             [&](const std::string& text) {
                 request.fog.component = static_cast<BrdfComponent>(
                     parse_choice(text, "--component", {"total", "direct", "scattered"}));
             });
    add_flag(command, "--order", "N", "Bands l = 0 ... N-1 of the BRDF (default: 128)",
             [&](const std::string& text) {
                 request.fog.order = parse_integer(text, "--order", 1, 512);
             });
    command.app->add_flag("--directed", request.fog.directed,
                          "Write twice as many phi_diff, 0 to 360 degrees: light through fog is "
                          "not reciprocal, and the published layout keeps the mean of both "
                          "directions");
    add_flag(command, "--nonfinite", "refuse|invalid",
             "NaN and infinite values of the input (default: refuse)",
             [&](const std::string& text) {
                 request.read.nonfinite = static_cast<BrdfNonfinite>(
                     parse_choice(text, "--nonfinite", {"refuse", "invalid"}));
             });
}

}  // namespace

Command declare_brdf(CLI::App& program) {
    Command command = declare_command(
        program, "brdf", "IN OUT", "Make the effective BRDF of a surface lit through fog",
        "  airlight brdf blue-metallic-paint.binary foggy.binary --optical-thickness 1\n"
        "  airlight brdf metal:0.2 foggy.binary --optical-thickness 1 --directed --json\n"
        "  airlight brdf paint.binary airlight.binary --optical-thickness 1 --component scattered\n"
        "  airlight brdf metal:0.1 metal.binary --optical-thickness 0\n"
        "Tables have the layout of the MERL BRDF database. Renderers multiply them by the cosine\n"
        "of the light's direction, as any BRDF.");
    const auto request = std::make_shared<BrdfRequest>();
    command.app
        ->add_option("files", request->paths,
                     "A BRDF table (- is standard input), or one of ours: metal:ROUGHNESS, "
                     "lambert:REFLECTANCE; then the output (- is standard output)")
        ->option_text(" ");
    add_flags(command, *request);
    add_json_flag(command, "Report on standard output: energy, reciprocity, bands, seconds, notes");
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_brdf(*request, *common); };
    return command;
}

}  // namespace airlight
