// SPDX-License-Identifier: Apache-2.0
// airlight fog: an HDR environment map in, its foggy version out.
#include "envmap/fog.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.h"
#include "cli/fog_files.h"
#include "cli/fog_report.h"
#include "cli/map_flags.h"
#include "cli/numbers.h"
#include "cli/phase_flag.h"
#include "cli/stopwatch.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/progress.h"
#include "envmap/io.h"

namespace airlight {
namespace {

// Koschmieder: at the meteorological visibility, contrast has fallen to 2 %.
const double kVisibilityThickness = -std::log(0.02);

constexpr int kLargestOrder = 1 << 20;

/// The command line, parsed but not yet made sense of.
struct FogRequest {
    std::vector<std::string> paths;
    std::optional<std::vector<double>> optical_thickness, density;
    std::optional<double> visibility, distance;
    FogOptions fog;
    FogComponent component = FogComponent::total;
    ReadOptions read;
    WriteOptions write;
};

std::vector<double> thickness_of(const FogRequest& request) {
    const int ways = int{request.optical_thickness.has_value()} + int{request.density.has_value()} +
                     int{request.visibility.has_value()};
    if (ways != 1) {
        throw Error(ErrorCode::usage,
                    std::string(ways == 0 ? "the fog is missing: give "
                                          : "the fog is given twice: use one of ") +
                        "--optical-thickness T, --density B --distance M or "
                        "--visibility M --distance M");
    }
    if (request.optical_thickness) {
        if (request.distance) {
            throw Error(ErrorCode::usage, "goes with --density or --visibility only", "--distance");
        }
        return *request.optical_thickness;
    }
    if (!request.distance) {
        throw Error(ErrorCode::usage, "needs --distance M, how far the map is away, in metres",
                    request.density ? "--density" : "--visibility");
    }
    std::vector<double> thickness;
    if (request.density) {
        for (const double density : *request.density) {
            thickness.push_back(density * *request.distance);
        }
    } else {
        thickness.push_back(kVisibilityThickness * (*request.distance / *request.visibility));
    }
    for (const double value : thickness) {
        if (!std::isfinite(value)) {
            throw Error(ErrorCode::usage, "the optical thickness that follows is not finite",
                        "--distance");
        }
    }
    return thickness;
}

void check_layers_file(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (path != "-" && extension != ".exr") {
        throw Error(ErrorCode::usage, "--component layers needs an .exr file or -", path);
    }
}

std::vector<std::string> reading_notes(const ReadReport& report, const ReadOptions& options,
                                       const Image& map) {
    std::vector<std::string> notes = report.notes;
    if (report.nonfinite > 0) {
        notes.push_back(fmt::format("{} non-finite values became 0", report.nonfinite));
    }
    if (report.negative > 0) {
        notes.push_back(fmt::format(
            "{} negative values down to {:.6g} {}", report.negative, report.most_negative,
            options.negative == NegativePolicy::clamp ? "became 0"
                                                      : "kept (--negative=clamp makes them 0)"));
    }
    if (const Attribute* before = map.metadata.find("airlight:opticalThickness")) {
        if (const auto* text = std::get_if<std::string>(&before->value)) {
            notes.push_back("is foggy already (optical thickness " + *text + ")");
        }
    }
    return notes;
}

/// The pictures that the component asks for, in the order of the file.
struct FogPictures {
    Image total, direct, scattered;
};

FogPictures compute(const Image& map, const FogPlan& plan, FogComponent component,
                    Progress& progress) {
    FogPictures pictures;
    if (component == FogComponent::direct) {
        pictures.direct = direct_light(map, plan);
        return pictures;
    }
    Image scattered = scattered_light(map, plan, &progress);
    if (component == FogComponent::layers) {
        pictures.scattered = scattered;
        pictures.direct = direct_light(map, plan);
    }
    if (component == FogComponent::scattered) {
        pictures.scattered = std::move(scattered);
    } else {
        add_direct_light(map, plan, scattered);
        pictures.total = std::move(scattered);
    }
    return pictures;
}

void write(const std::string& path, const FogPictures& pictures, FogComponent component,
           const WriteOptions& options, WriteReport& report) {
    switch (component) {
        case FogComponent::total:
            return write_image(path, pictures.total, options, &report);
        case FogComponent::direct:
            return write_image(path, pictures.direct, options, &report);
        case FogComponent::scattered:
            return write_image(path, pictures.scattered, options, &report);
        case FogComponent::layers:
            return write_layers(path,
                                {{"total", &pictures.total},
                                 {"direct", &pictures.direct},
                                 {"scattered", &pictures.scattered}},
                                options, &report);
    }
}

FogRecord convert(const FogFiles& files, const FogRequest& request, const CommonOptions& common) {
    FogRecord record;
    record.input = files.input;
    record.output = files.output;
    record.component = request.component;
    record.options = request.fog;

    auto start = std::chrono::steady_clock::now();
    ReadReport read_report;
    const Image map = read_image(files.input, request.read, &read_report);
    record.width = map.width;
    record.height = map.height;
    record.notes = reading_notes(read_report, request.read, map);
    const std::string input_name = files.input == "-" ? "standard input" : files.input;
    for (const std::string& note : record.notes) spdlog::warn("{}: {}", input_name, note);
    record.read_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    FogOptions options = request.fog;
    // Without scattering there is no kernel to build.
    if (request.component == FogComponent::direct) options.albedo = {0.0};
    record.plan = plan_fog(map.height, map.width, map.channels, options);
    const std::size_t pictures = request.component == FogComponent::layers ? 4 : 2;
    const std::size_t map_bytes = map.pixels.size() * sizeof(float);
    require_memory(checked_add(checked_multiply(pictures, map_bytes, "the fog"),
                               record.plan.working_bytes, "the fog"),
                   common.max_memory, "computing its fog", input_name);
    spdlog::info("{}: {} x {}, method {}, estimated error {:.1e}", input_name, map.width,
                 map.height, method_name(record.plan), record.plan.estimated_error);
    FogPictures result;
    {
        ProgressOptions drawing;
        drawing.quiet = common.verbosity < 0;
        Progress progress("fog", record.plan.ticks, drawing);
        result = compute(map, record.plan, request.component, progress);
    }
    record.compute_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    WriteOptions write_options = request.write;
    write_options.force = common.force;
    write_options.attributes = settings_attributes(record);
    WriteReport write_report;
    write(files.output, result, request.component, write_options, write_report);
    for (const std::string& note : write_report.notes) {
        spdlog::info("{}: {}", files.output, note);
        record.notes.push_back(note);
    }
    record.write_seconds = seconds_since(start);
    record.peak_memory = peak_memory();
    return record;
}

void run_fog(FogRequest request, const CommonOptions& common) {
    const std::vector<FogFiles> files = pair_files(request.paths);
    request.fog.optical_thickness = thickness_of(request);
    request.read.max_memory = common.max_memory;
    request.write.force = common.force;
    if (request.fog.sh_order != 0 && request.fog.method != FogMethod::sh) {
        throw Error(ErrorCode::usage, "goes with --method sh only", "--order");
    }
    for (const FogFiles& file : files) {
        if (file.output == "-" && common.json) {
            throw Error(ErrorCode::usage, "cannot go with the output -, which is standard output",
                        "--json");
        }
        if (request.component == FogComponent::layers) check_layers_file(file.output);
        check_writable(file.output, request.write);
    }
    std::vector<FogRecord> records;
    for (const FogFiles& file : files) records.push_back(convert(file, request, common));
    if (common.json) print(to_json(records));
}

void add_fog_flags(const Command& command, FogRequest& request) {
    add_flag(command, "--optical-thickness", "T[,T,T]",
             "Optical thickness between viewer and map, one value or R,G,B",
             [&](const std::string& text) {
                 request.optical_thickness =
                     parse_channels(text, "--optical-thickness", kNotNegative);
             });
    add_flag(command, "--density", "B[,B,B]", "Extinction coefficient in 1/m; T = B * distance",
             [&](const std::string& text) {
                 request.density = parse_channels(text, "--density", kNotNegative);
             });
    add_flag(command, "--visibility", "M",
             "Meteorological visibility in m; T = -ln(0.02) * distance / visibility",
             [&](const std::string& text) {
                 request.visibility = parse_number(text, "--visibility", kPositive);
             });
    add_flag(command, "--distance", "M", "Distance of what the map shows, in m",
             [&](const std::string& text) {
                 request.distance = parse_number(text, "--distance", kNotNegative);
             });
    add_flag(command, "--albedo", "A[,A,A]", "Single-scattering albedo in [0, 1] (default: 1)",
             [&](const std::string& text) {
                 request.fog.albedo = parse_channels(text, "--albedo", {0, 1});
             });
    add_flag(command, "--phase", "isotropic|rayleigh|hg:G|table:FILE",
             "Phase function (default: isotropic); G in (-1, 1) is the mean cosine of Henyey and "
             "Greenstein, > 0 forward; FILE is CSV with the columns angle_degrees,value",
             [&](const std::string& text) { request.fog.phase = parse_phase(text, "--phase"); });
    add_flag(
        command, "--psf", "exact|factored",
        "Point spread function: exact at this T, or the paper's T e^-T NPSF, with the NPSF of the "
        "phase function (default: exact)",
        [&](const std::string& text) {
            request.fog.psf = parse_choice(text, "--psf", {"exact", "factored"}) == 0
                                  ? PsfForm::exact
                                  : PsfForm::factored;
        });
    add_flag(command, "--component", "total|direct|scattered|layers",
             "What to write; layers is one EXR with all three (default: total)",
             [&](const std::string& text) {
                 request.component = static_cast<FogComponent>(
                     parse_choice(text, "--component", {"total", "direct", "scattered", "layers"}));
             });
}

void add_method_flags(const Command& command, FogRequest& request) {
    add_flag(command, "--tolerance", "E",
             "Largest relative error of a pixel's scattered light, 1e-6 up (default: 1e-3)",
             [&](const std::string& text) {
                 request.fog.tolerance = parse_number(text, "--tolerance", {1e-6, 1, false, true});
             });
    add_flag(command, "--method", "auto|split|rings|sh",
             "How scattered light is computed (default: auto, the cheapest within the tolerance); "
             "sh has no error bound",
             [&](const std::string& text) {
                 constexpr FogMethod kMethods[] = {FogMethod::automatic, FogMethod::split,
                                                   FogMethod::rings, FogMethod::sh};
                 request.fog.method =
                     kMethods[parse_choice(text, "--method", {"auto", "split", "rings", "sh"})];
             });
    add_flag(command, "--order", "N", "Bands l = 0 ... N-1 for --method sh (default: all)",
             [&](const std::string& text) {
                 request.fog.sh_order = parse_integer(text, "--order", 1, kLargestOrder);
             });
}

void add_file_flags(const Command& command, FogRequest& request) {
    command.app->add_flag_function(
        "--half", [&](std::int64_t) { request.write.pixel_type = PixelType::half; },
        "Write 16-bit pixels (EXR) instead of 32-bit float");
    add_flag(command, "--compression", "NAME",
             "EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab; TIFF: none, zip, lzw "
             "(default: zip)",
             [&](const std::string& text) { request.write.compression = text; });
    add_map_flags(command, request.read);
}

}  // namespace

Command declare_fog(CLI::App& program) {
    Command command = declare_command(
        program, "fog", "IN... OUT", "Make the foggy version of an HDR environment map",
        "  airlight fog room.exr foggy.exr --optical-thickness 1\n"
        "  airlight fog day.hdr haze.exr --visibility 2000 --distance 500 --albedo 0.9\n"
        "  airlight fog sea.exr mist.exr --optical-thickness 1 --phase hg:0.8\n"
        "  airlight fog a.exr b.exr 'foggy/{name}.exr' --density 0.01,0.012,0.015 --distance 80\n"
        "  airlight fog room.exr parts.exr --optical-thickness 2 --component layers --json\n"
        "  airlight fog - - --optical-thickness 1 < room.exr > foggy.exr\n"
        "Outputs carry the settings as attributes airlight:opticalThickness, airlight:albedo,\n"
        "airlight:phase, airlight:psf, airlight:component, airlight:method, airlight:tolerance.");
    const auto request = std::make_shared<FogRequest>();
    command.app
        ->add_option("files", request->paths,
                     "Lat-long maps (.exr, .hdr, .pfm, .tif; - is standard input), then the output "
                     "(- is standard output, as EXR); with several inputs, {name} in the output "
                     "stands for the input's name")
        ->option_text(" ");
    add_fog_flags(command, *request);
    add_method_flags(command, *request);
    add_file_flags(command, *request);
    add_json_flag(command, "Report on standard output: method, error, seconds, memory, notes");
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_fog(*request, *common); };
    return command;
}

}  // namespace airlight
