// SPDX-License-Identifier: Apache-2.0
// airlight sh: spherical-harmonic coefficients of a map, or of its foggy version.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/engine_flags.h"
#include "cli/map_flags.h"
#include "cli/numbers.h"
#include "cli/phase_flag.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "envmap/engine_light.h"
#include "envmap/io.h"
#include "envmap/sun.h"
#include "sh/dering.h"
#include "sh/index.h"
#include "sh/phase_psf.h"
#include "sh/project.h"
#include "sh/rotation.h"
#include "sh/sh_file.h"
#include "sh/window.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

constexpr std::size_t kChannels = 3;
constexpr int kEngineOrder = 3;

enum class Window { none, hann, lanczos, automatic, bands, nearest };
constexpr const char* kWindowNames[] = {"none", "hann", "lanczos", "auto", "bands", "nearest"};

bool keeps_least(Window window) {
    return window == Window::automatic || window == Window::bands || window == Window::nearest;
}

struct ShRequest {
    std::vector<std::string> inputs;
    std::string output;
    std::optional<int> order;
    std::optional<std::vector<double>> fog;
    std::vector<double> albedo = {1.0};
    PhaseFunction phase;
    bool extract_sun = false;
    Window window = Window::none;
    double least = 0;
    bool least_given = false, medium_given = false;
    EngineFlags engine;  ///< without a format: a coefficient file
    ReadOptions read;
};

int order_of(const ShRequest& request) {
    if (!request.engine.format) return request.order.value_or(6);
    const int order = request.order.value_or(kEngineOrder);
    if (order > kEngineOrder) {
        throw Error(ErrorCode::usage,
                    fmt::format("{} is beyond {}, all that engines take (see --format json)", order,
                                kEngineOrder),
                    "--order");
    }
    return order;
}

void check(const ShRequest& request, const CommonOptions& common) {
    if (request.inputs.size() != 1) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "a map is missing (see airlight sh --help)"
                                          : "takes one map, not several");
    }
    if (request.output.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o FILE");
    }
    if (request.engine.turn && !request.engine.format) {
        throw Error(ErrorCode::usage, "goes with the formats of engines only", "--turn");
    }
    if (!request.fog && request.medium_given) {
        throw Error(ErrorCode::usage, "--albedo and --phase go with --fog T only");
    }
    if (request.least_given && !keeps_least(request.window)) {
        throw Error(ErrorCode::usage, "goes with --window auto, bands and nearest only", "--least");
    }
    const int order = order_of(request);
    if (keeps_least(request.window) && order > kLargestAutomaticOrder) {
        throw Error(ErrorCode::usage,
                    fmt::format("{} goes up to order {}, not {}",
                                kWindowNames[static_cast<int>(request.window)],
                                kLargestAutomaticOrder, order),
                    "--window");
    }
    if (request.output != "-") check_target(request.output, common.force);
}

void take_sun(Image& map, ShFile& light, const std::string& input_name) {
    const Sun sun = extract_sun(map);
    if (sun.verdict != SunVerdict::found) {
        spdlog::warn("{}: no sun was taken out: {}", input_name, to_text(sun.verdict));
        return;
    }
    light.sun = ShFileSun{sun.direction, {}, sun.angular_radius};
    std::copy(sun.irradiance.begin(), sun.irradiance.end(), light.sun->irradiance.begin());
}

/// The sun's light that reaches the viewer unscattered stays apart; what fog scatters joins the
/// map.
void add_fog(const ShRequest& request, ShFile& light) {
    const std::size_t count = sh_count(light.order);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto channel = [c](const std::vector<double>& values) {
            return values.size() == 1 ? values[0] : values[c];
        };
        const double thickness = channel(*request.fog);
        std::vector<double> lambda =
            fog_eigenvalues(thickness, channel(request.albedo), request.phase, light.order);
        double* coefficients = light.coefficients.data() + c * count;
        zonal_convolve(lambda, 1, coefficients);
        if (!light.sun) continue;
        for (double& value : lambda)
            value = (value - std::exp(-thickness)) * light.sun->irradiance[c];
        const auto [x, y, z] = light.sun->direction;
        std::vector<double> glow(count);
        rotate_zonal(light.order, zonal_coefficients(lambda).data(), {x, y, z}, glow.data());
        for (std::size_t i = 0; i < count; ++i) coefficients[i] += glow[i];
        light.sun->irradiance[c] *= std::exp(-thickness);
    }
    light.fog = ShFileFog{*request.fog, request.albedo, phase_name(request.phase)};
}

void add_window(const ShRequest& request, ShFile& light) {
    if (request.window == Window::none) return;
    light.window = ShFileWindow{kWindowNames[static_cast<int>(request.window)], request.least};
    std::vector<double> factors;
    switch (request.window) {
        case Window::none:
            return;
        case Window::hann:
            factors = hann_window(light.order);
            break;
        case Window::lanczos:
            factors = lanczos_window(light.order);
            break;
        case Window::automatic: {
            const AutomaticWindow window =
                automatic_window(light.order, kChannels, light.coefficients.data(), request.least);
            light.window->strength = window.strength;
            factors = window.factors;
            spdlog::info("window of strength {:.6g}", window.strength);
            break;
        }
        case Window::bands:
            factors = least_change_window(light.order, kChannels, light.coefficients.data(),
                                          request.least);
            light.window->factors = factors;
            spdlog::info("window of factors {:.6g}", fmt::join(factors, ", "));
            break;
        case Window::nearest:
            light.coefficients = dering(DeringMethod::nearest, light.order, kChannels,
                                        light.coefficients.data(), request.least);
            return;
    }
    apply_window(factors, kChannels, light.coefficients.data());
}

void run_sh(ShRequest request, const CommonOptions& common) {
    check(request, common);
    request.read.max_memory = common.max_memory;
    const std::string& input = request.inputs[0];
    const std::string input_name = input == "-" ? "standard input" : input;
    ReadReport report;
    Image map = read_image(input, request.read, &report);
    for (const std::string& note : report.notes) spdlog::warn("{}: {}", input_name, note);
    if (report.negative > 0) {
        spdlog::warn("{}: {} negative values down to {:.6g}", input_name, report.negative,
                     report.most_negative);
    }
    ShFile light;
    light.map = ShFileMap{map.width, map.height};
    light.order = order_of(request);
    if (request.extract_sun) take_sun(map, light, input_name);
    light.coefficients =
        project_latlong(map.pixels.data(), map.height, map.width, map.channels, light.order);
    std::string text;
    try {
        if (request.fog) add_fog(request, light);
        add_window(request, light);
        text = request.engine.format ? engine_text(request.engine, light.order, light.coefficients)
                                     : sh_file_text(light);
    } catch (const Error& error) {
        throw Error(error.code(), error.what(), input_name);
    }
    if (light.sun && request.engine.format) {
        warn_of_sun(request.engine, *light.sun, request.output);
    }
    if (request.output == "-") return print(text);
    write_file_atomically(request.output, text, common.force);
}

void add_light_flags(const Command& command, ShRequest& request) {
    add_flag(command, "--order", "N",
             "Degrees l = 0 ... N-1 (default: 6; engines take 3, the default for their formats)",
             [&](const std::string& text) {
                 request.order = parse_integer(text, "--order", 1, kLargestProjectionOrder);
             });
    add_flag(command, "--fog", "T[,T,T]",
             "Fog of that optical thickness between viewer and map, one value or R,G,B",
             [&](const std::string& text) {
                 request.fog = parse_channels(text, "--fog", kNotNegative);
             });
    add_flag(command, "--albedo", "A[,A,A]", "Single-scattering albedo in [0, 1] (default: 1)",
             [&](const std::string& text) {
                 request.albedo = parse_channels(text, "--albedo", {0, 1});
                 request.medium_given = true;
             });
    add_flag(command, "--phase", "isotropic|rayleigh|hg:G|table:FILE",
             "Phase function, as for airlight fog (default: isotropic)",
             [&](const std::string& text) {
                 request.phase = parse_phase(text, "--phase");
                 request.medium_given = true;
             });
    add_flag(command, "--sun", "keep|extract",
             "extract: the sun becomes a directional light of its own, which json holds beside the "
             "coefficients and the formats of engines leave to a warning (default: keep)",
             [&](const std::string& text) {
                 request.extract_sun = parse_choice(text, "--sun", {"keep", "extract"}) == 1;
             });
    add_flag(
        command, "--window", "none|hann|lanczos|auto|bands|nearest",
        "Window against ringing. auto: the weakest smoothing that keeps --least; bands: of all "
        "windows the least change that does; nearest: the least change of any kind, which may "
        "move light and its hue (default: none)",
        [&](const std::string& text) {
            request.window = static_cast<Window>(parse_choice(
                text, "--window", {"none", "hann", "lanczos", "auto", "bands", "nearest"}));
        });
    add_flag(command, "--least", "F",
             "With --window auto, bands and nearest: no radiance below F times its channel's mean "
             "(default: 0)",
             [&](const std::string& text) {
                 request.least = parse_number(text, "--least", {-1e6, 1, false, true});
                 request.least_given = true;
             });
}

void add_file_flags(const Command& command, ShRequest& request) {
    add_flag(command, "-o,--output", "FILE", "The coefficients (- is standard output)",
             [&](const std::string& text) { request.output = text; });
    add_flag(command, "--format", "json|filament|three|unity|unreal|gltf",
             std::string("json: radiance in our own convention, docs/SH_FILES.md; ") +
                 kEngineFormatHelp + " (default: json)",
             [&](const std::string& text) {
                 request.engine.format = parse_engine(text, "--format", true);
             });
    add_turn_flag(command, request.engine);
    add_map_flags(command, request.read);
}

}  // namespace

Command declare_sh(CLI::App& program) {
    Command command = declare_command(
        program, "sh", "IN -o OUT",
        "Spherical-harmonic coefficients of an environment map, for engines",
        "  airlight sh room.exr -o room.json --order 9\n"
        "  airlight sh room.exr -o sh.txt --format filament --fog 0.8 --window lanczos\n"
        "  airlight sh room.exr -o - --format three --turn 90 --window auto\n"
        "airlight export turns a coefficient file into the formats of engines.");
    const auto request = std::make_shared<ShRequest>();
    command.app
        ->add_option("maps", request->inputs,
                     "A lat-long map (.exr, .hdr, .pfm, .tif; - is standard input)")
        ->option_text(" ");
    add_light_flags(command, *request);
    add_file_flags(command, *request);
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_sh(*request, *common); };
    return command;
}

}  // namespace airlight
