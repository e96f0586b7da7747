// SPDX-License-Identifier: Apache-2.0
// airlight render: the picture of a scene.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/picture_output.h"
#include "cli/plan_flags.h"
#include "cli/render_compare.h"
#include "cli/stopwatch.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/progress.h"
#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/reference_picture.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

struct RenderRequest {
    std::vector<std::string> inputs;
    std::string output;
    ReferencePictureOptions options;
    PlanOptions plan;
    double exposure = 0;
    bool bounces = false;  ///< --bounces is there
    bool compare = false;  ///< both engines
};

void check(const RenderRequest& request, const CommonOptions& common) {
    if (request.inputs.size() != 1) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "a scene is missing (see airlight render --help)"
                                          : "takes one scene");
    }
    if (request.output.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o FILE.exr or FILE.png");
    }
    if (request.options.scattering == Scattering::multiple && request.plan.engine == Engine::fast) {
        throw Error(ErrorCode::usage, "is for --engine reference", "--scattering multiple");
    }
    if (request.options.scattering == Scattering::multiple &&
        (request.plan.all || !request.plan.only.full())) {
        throw Error(ErrorCode::usage,
                    "takes no --all, --only or --without, which choose among effects of light that "
                    "is scattered once",
                    "--scattering multiple");
    }
    if (request.compare && request.options.scattering == Scattering::multiple) {
        throw Error(ErrorCode::usage, "takes no --scattering multiple", "--compare");
    }
    if (request.bounces && request.options.scattering == Scattering::single) {
        throw Error(ErrorCode::usage, "is for --scattering multiple", "--bounces");
    }
    if (!request.compare) check_picture_target(request.output, common.force);
}

void run_fast(const RenderRequest& request, const World& world, const Plan& plan,
              double read_seconds, const CommonOptions& common) {
    const auto start = std::chrono::steady_clock::now();
    FastPictureOptions options;
    options.samples = std::min(request.options.samples, kLargestFastSamples);
    options.width = request.options.width;
    options.height = request.options.height;
    const Camera& camera = world.scene().camera;
    const int width = options.width > 0 ? options.width : camera.width;
    const int height = options.height > 0 ? options.height : camera.height;
    FastPicture picture;
    {
        ProgressOptions drawing;
        drawing.quiet = common.verbosity < 0;
        Progress progress("render", std::uint64_t(width) * std::uint64_t(height), drawing);
        picture =
            render_fast(world, plan, fast_methods(plan), options, common.max_memory, &progress);
    }
    const double render_seconds = seconds_since(start);
    write_picture(request.output, picture.image, request.exposure, common.force);
    spdlog::info("{}: {} x {} pixels, {} samples, {:.2f} s", request.output, width, height,
                 picture.samples, render_seconds);
    if (!common.json) return;
    nlohmann::ordered_json effects;
    for (const auto& [effect, name] : kEffects) {
        effects[std::string(name)] = picture.counts[effect];
    }
    print(nlohmann::ordered_json{{"version", AIRLIGHT_VERSION},
                                 {"input", request.inputs[0]},
                                 {"output", request.output},
                                 {"engine", "fast"},
                                 {"width", width},
                                 {"height", height},
                                 {"samples", picture.samples},
                                 {"triangles", world.triangles()},
                                 {"rays", picture.counts.rays + picture.counts.shadow_rays},
                                 {"tables", picture.counts.tables},
                                 {"evaluations", effects},
                                 {"plan", to_json(plan)},
                                 {"seconds", {{"read", read_seconds}, {"render", render_seconds}}},
                                 {"peak_memory_bytes", peak_memory()}});
}

void run_render(const RenderRequest& request, const CommonOptions& common) {
    check(request, common);
    if (request.compare) {
        CompareRequest comparison{request.inputs[0], request.output, request.options, request.plan,
                                  request.exposure};
        comparison.plan.tolerance = request.options.tolerance;
        render_and_compare(comparison, common);
        return;
    }
    auto start = std::chrono::steady_clock::now();
    const std::string& input = request.inputs[0];
    const Scene scene = read_scene(input, common.max_memory);
    WorldOptions reading;
    reading.max_memory = common.max_memory;
    World world(scene, reading);
    const double read_seconds = seconds_since(start);
    const bool multiple = request.options.scattering == Scattering::multiple;
    if (scene.shafts && multiple) {
        spdlog::warn("{}: --scattering multiple leaves out the particles of shafts", input);
    }

    start = std::chrono::steady_clock::now();
    const int width = request.options.width > 0 ? request.options.width : scene.camera.width;
    const int height = request.options.height > 0 ? request.options.height : scene.camera.height;
    ReferencePictureOptions options = request.options;
    PlanOptions planning = request.plan;
    // Its bounds are those of light that is scattered once.
    planning.bounds = !multiple;
    planning.tolerance = options.tolerance;
    planning.width = width;
    planning.height = height;
    const Plan plan = make_plan(world, planning);
    if (!multiple) {
        world.set_media(plan.media);
        warn_of_tolerance(input, plan);
    }
    if (plan.engine == Engine::fast) {
        run_fast(request, world, plan, read_seconds, common);
        return;
    }
    options.reference.quadrature = plan.quadrature;
    ReferencePicture picture;
    {
        ProgressOptions drawing;
        drawing.quiet = common.verbosity < 0;
        const bool twice = request.options.tolerance > 0 && request.options.samples > kFirstSamples;
        // Paths go round the picture as often as their number doubles.
        int rounds = twice && !multiple ? 2 : 1;
        if (twice && multiple) {
            for (int n = kFirstSamples; n < request.options.samples; n *= 2) ++rounds;
        }
        Progress progress("render",
                          std::uint64_t(rounds) * std::uint64_t(width) * std::uint64_t(height),
                          drawing);
        picture = render_reference(world, plan, options, common.max_memory, &progress);
    }
    const double render_seconds = seconds_since(start);
    if (picture.unfinished > 0) {
        spdlog::warn(
            "{}: {} pixels have noise above the tolerance after {} samples; more come "
            "with --samples",
            input, picture.unfinished, request.options.samples);
    }
    write_picture(request.output, picture.image, request.exposure, common.force);
    spdlog::info("{}: {} x {} pixels, {} samples, noise {:.2g} of the brightest, {:.1f} s",
                 request.output, width, height, picture.samples, picture.noise, render_seconds);
    if (!common.json) return;
    nlohmann::ordered_json report = {
        {"version", AIRLIGHT_VERSION},
        {"input", input},
        {"output", request.output},
        {"engine", "reference"},
        {"scattering", std::string(method_name(kScatterings, request.options.scattering))},
        {"width", width},
        {"height", height},
        {"samples", picture.samples},
        {"noise", picture.noise},
        {"unfinished_pixels", picture.unfinished},
        {"triangles", world.triangles()},
        {"rays", picture.counts.rays},
        {"line_points", picture.counts.line_points},
        {"seconds", {{"read", read_seconds}, {"render", render_seconds}}},
        {"peak_memory_bytes", peak_memory()}};
    if (!multiple) report["plan"] = to_json(plan);
    print(report);
}

}  // namespace

Command declare_render(CLI::App& program) {
    Command command = declare_command(
        program, "render", "SCENE -o OUT",
        "Render a scene, with light scattered once or many times",
        "  airlight render courtyard.json -o courtyard.png\n"
        "  airlight render courtyard.json -o courtyard.exr --samples 256 --tolerance 0.002\n"
        "  airlight render courtyard.json -o small.png --size 200x150 --json\n"
        "  airlight render courtyard.json -o both.png --compare --samples 64\n"
        "  airlight render courtyard.json -o all.png --scattering multiple --samples 256\n"
        "OUT is .exr, .hdr, .pfm or .tif (linear radiance) or .png (tone-mapped).");
    const auto request = std::make_shared<RenderRequest>();
    command.app->add_option("scenes", request->inputs, "A scene (docs/SCENES.md)")
        ->option_text(" ");
    add_flag(command, "-o,--output", "OUT", "The picture",
             [=](const std::string& text) { request->output = text; });
    add_plan_flags(command, request->plan);
    add_flag(
        command, "--scattering", "single|multiple",
        "How often media and surfaces pass light on: once, or any number of times by paths "
        "(default: single)",
        [=](const std::string& text) {
            request->options.scattering =
                kScatterings[parse_choice(text, "--scattering", {"single", "multiple"})].method;
        });
    add_flag(command, "--bounces", "N",
             "Points at most where a path is scattered or reflected, with --scattering multiple "
             "(default: 4096)",
             [=](const std::string& text) {
                 request->options.paths.max_bounces =
                     parse_integer(text, "--bounces", 1, kLargestPathBounces);
                 request->bounces = true;
             });
    command.app
        ->add_flag_callback(
            "--compare", [=] { request->compare = true; },
            "Render by both engines and measure the fast one: writes OUT with -reference, -fast "
            "and -difference before its extension")
        ->option_text(" ");
    add_flag(command, "--size", "WxH", "Pixels (default: the camera's)",
             [=](const std::string& text) {
                 parse_picture_size(text, request->options.width, request->options.height);
             });
    add_flag(command, "--samples", "N", "Samples of a pixel, at most (default: 16)",
             [=](const std::string& text) {
                 request->options.samples = parse_integer(text, "--samples", 1, kLargestSamples);
             });
    add_flag(
        command, "--tolerance", "E",
        "Noise, relative to the brightest pixel, at which a pixel is done (default: take all "
        "samples), or the picture, with multiple scattering; with --engine fast and --compare, "
        "the error that the plan aims at; integrals along rays are made to a tenth of it or of "
        "the scene's",
        [=](const std::string& text) { request->options.tolerance = parse_tolerance(text); });
    add_flag(command, "--exposure", "EV", "Stops brighter than automatic, for .png (default: 0)",
             [=](const std::string& text) {
                 request->exposure = parse_number(text, "--exposure", {-30, 30});
             });
    add_json_flag(command, "Report on standard output: counts, noise, seconds, memory");
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_render(*request, *common); };
    return command;
}

}  // namespace airlight
