// SPDX-License-Identifier: Apache-2.0
#include "cli/render_compare.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/picture_output.h"
#include "cli/plan_flags.h"
#include "cli/stopwatch.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/progress.h"
#include "envmap/sheet.h"
#include "viewer/fast_choice.h"
#include "viewer/fast_picture.h"
#include "viewer/picture_compare.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

nlohmann::ordered_json to_json(const PictureErrors& errors) {
    return {{"rms", errors.rms},
            {"p99", errors.p99},
            {"max", errors.largest},
            {"relative", errors.relative},
            {"bias", errors.bias}};
}

std::string to_row(std::string_view name, const PictureErrors& e) {
    return fmt::format("{:21} {:9.1e} {:9.1e} {:9.1e} {:9.1e} {:10.1e}\n", name, e.rms, e.p99,
                       e.largest, e.relative, e.bias);
}

}  // namespace

std::string name_beside(const std::string& output, const std::string& what,
                        const std::string& extension) {
    const std::filesystem::path path(output);
    const std::string end = extension.empty() ? path.extension().string() : extension;
    return (path.parent_path() / (path.stem().string() + "-" + what + end)).string();
}

void render_and_compare(const CompareRequest& request, const CommonOptions& common) {
    check_picture_name(request.output);
    if (request.output == "-")
        throw Error(ErrorCode::usage, "writes files; give -o a name", "--compare");
    const std::string reference_path = name_beside(request.output, "reference");
    const std::string fast_path = name_beside(request.output, "fast");
    const std::string difference_path = name_beside(request.output, "difference", ".png");
    for (const std::string& path : {reference_path, fast_path, difference_path}) {
        check_picture_target(path, common.force);
    }
    const Scene scene = read_scene(request.input, common.max_memory);
    WorldOptions reading;
    reading.max_memory = common.max_memory;
    World world(scene, reading);
    ReferencePictureOptions options = request.reference;
    options.width = options.width > 0 ? options.width : scene.camera.width;
    options.height = options.height > 0 ? options.height : scene.camera.height;
    options.layers = true;
    options.tolerance = 0;  // the same rays as the other engine
    options.samples = std::min(options.samples, kLargestFastSamples);
    const std::uint64_t pixels = std::uint64_t(options.width) * std::uint64_t(options.height);
    ProgressOptions drawing;
    drawing.quiet = common.verbosity < 0;

    PlanOptions whole;
    whole.bounds = false;
    options.reference.quadrature =
        0.1 * (request.plan.tolerance > 0 ? request.plan.tolerance : scene.tolerance);
    ReferencePicture truth;
    auto start = std::chrono::steady_clock::now();
    {
        Progress progress("reference", pixels, drawing);
        truth =
            render_reference(world, make_plan(world, whole), options, common.max_memory, &progress);
    }
    const double reference_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    PlanOptions planning = request.plan;
    planning.engine = Engine::fast;
    planning.width = options.width;
    planning.height = options.height;
    const Plan plan = make_plan(world, planning);
    world.set_media(plan.media);
    const double plan_seconds = seconds_since(start);
    warn_of_tolerance(request.input, plan);
    FastPictureOptions fast;
    fast.samples = options.samples;
    fast.width = options.width;
    fast.height = options.height;
    fast.layers = true;
    FastPicture picture;
    start = std::chrono::steady_clock::now();
    {
        Progress progress("fast", pixels, drawing);
        picture = render_fast(world, plan, fast_methods(plan), fast, common.max_memory, &progress);
    }
    const double fast_seconds = seconds_since(start);

    const double brightest = brightest_of(truth.image);
    const PictureErrors errors = compare_pictures(picture.image, truth.image, brightest);
    const LayerErrors layers = compare_layers(picture.layers, truth.layers, brightest);
    const double exposure = automatic_exposure(truth.image);
    write_picture(reference_path, truth.image, request.stops, common.force, exposure);
    write_picture(fast_path, picture.image, request.stops, common.force, exposure);
    write_png(difference_path, difference_picture(picture.image, truth.image, brightest),
              common.force);
    const std::string owner(layers.owner ? method_name(kRadianceLayers, *layers.owner) : "none");
    const double ratio = fast_seconds > 0 ? reference_seconds / fast_seconds : 0;
    if (!common.json) {
        std::string text = fmt::format(
            "{}: errors of the fast engine over the brightest pixel\n\n{:21} {:>9} "
            "{:>9} {:>9} {:>9} {:>10}\n",
            request.input, "light", "rms", "99 %", "largest", "relative", "bias");
        for (std::size_t i = 0; i < kRadianceLayerCount; ++i) {
            if (brightest_of(truth.layers[i]) == 0 && layers.layers[i].largest == 0) continue;
            text += to_row(kRadianceLayers[i].name, layers.layers[i]);
        }
        text += to_row("all", errors);
        text += fmt::format(
            "\nMost of it is {}. The reference's own noise is {:.1e} rms; the plan allows {:.1e}.\n"
            "{:.2f} s against {:.2f} s: {:.0f} times as fast.\n{}, {} and {}\n",
            owner, truth.noise, plan.bound(), fast_seconds, reference_seconds, ratio,
            reference_path, fast_path, difference_path);
        print(text);
        return;
    }
    nlohmann::ordered_json by_layer;
    for (std::size_t i = 0; i < kRadianceLayerCount; ++i) {
        by_layer[std::string(kRadianceLayers[i].name)] = to_json(layers.layers[i]);
    }
    print(nlohmann::ordered_json{
        {"version", AIRLIGHT_VERSION},
        {"input", request.input},
        {"outputs", {reference_path, fast_path, difference_path}},
        {"width", options.width},
        {"height", options.height},
        {"samples", truth.samples},
        {"brightest", brightest},
        {"errors", to_json(errors)},
        {"layers", by_layer},
        {"owner", owner},
        {"reference_noise", truth.noise},
        {"plan", to_json(plan)},
        {"seconds",
         {{"reference", reference_seconds}, {"plan", plan_seconds}, {"fast", fast_seconds}}},
        {"speedup", ratio},
        {"peak_memory_bytes", peak_memory()}});
}

}  // namespace airlight
