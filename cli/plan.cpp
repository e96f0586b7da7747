// SPDX-License-Identifier: Apache-2.0
// airlight plan: the effects that a scene calls for.
#include <nlohmann/json.hpp>

#include "cli/numbers.h"
#include "cli/plan_flags.h"
#include "core/error.h"
#include "viewer/scene_file.h"

namespace airlight {
namespace {

struct PlanRequest {
    std::vector<std::string> inputs;
    PlanOptions options;
};

void run_plan(const PlanRequest& request, const CommonOptions& common) {
    if (request.inputs.size() != 1) {
        throw Error(ErrorCode::usage, request.inputs.empty()
                                          ? "a scene is missing (see airlight plan --help)"
                                          : "takes one scene");
    }
    const std::string& input = request.inputs[0];
    WorldOptions reading;
    reading.max_memory = common.max_memory;
    const World world(read_scene(input, common.max_memory), reading);
    const Plan plan = make_plan(world, request.options);
    warn_of_tolerance(input, plan);
    if (!common.json) {
        print(to_lines(input, plan));
        return;
    }
    nlohmann::ordered_json report = {{"version", AIRLIGHT_VERSION}, {"input", input}};
    report.update(to_json(plan));
    print(report);
}

}  // namespace

Command declare_plan(CLI::App& program) {
    Command command = declare_command(
        program, "plan", "SCENE", "Tell which effects a scene calls for, why and how",
        "  airlight plan courtyard.json\n"
        "  airlight plan courtyard.json --engine fast --tolerance 0.001\n"
        "  airlight plan courtyard.json --without shafts --json\n"
        "An effect is left out when the scene rules it out, or when a bound on what it adds to "
        "any\n"
        "pixel is under the tolerance. airlight render follows the same plan.");
    const auto request = std::make_shared<PlanRequest>();
    command.app->add_option("scenes", request->inputs, "A scene (docs/SCENES.md)")
        ->option_text(" ");
    add_plan_flags(command, request->options);
    add_flag(command, "--tolerance", "E",
             "Error of a pixel, relative to the brightest (default: the scene's)",
             [=](const std::string& text) { request->options.tolerance = parse_tolerance(text); });
    add_flag(command, "--size", "WxH", "Pixels of the picture (default: the camera's)",
             [=](const std::string& text) {
                 parse_picture_size(text, request->options.width, request->options.height);
             });
    add_json_flag(command, "Report on standard output as JSON");
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_plan(*request, *common); };
    return command;
}

}  // namespace airlight
