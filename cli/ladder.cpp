// SPDX-License-Identifier: Apache-2.0
// airlight ladder: what each method's accuracy costs in time on this machine.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "cli/command.h"
#include "cli/ladder_closed_forms.h"
#include "cli/ladder_effects.h"
#include "cli/ladder_page.h"
#include "cli/ladder_rungs.h"
#include "cli/ladder_sh.h"
#include "cli/numbers.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/progress.h"
#include "core/threads.h"

namespace airlight {
namespace {

// The rings' time grows with the third power of the size: minutes beyond.
constexpr int kSmallestWidth = 32, kLargestWidth = 2048;

struct LadderEffectInfo {
    std::string name;
    std::function<LadderWork(const LadderOptions& options)> plan;
};

std::vector<LadderEffectInfo> ladder_effects() {
    std::vector<LadderEffectInfo> effects = {{"fog", plan_fog_ladder}};
    for (const ClosedFormLadder& ladder : closed_form_ladders()) {
        effects.push_back({ladder.effect, [&ladder](const LadderOptions&) {
                               return plan_rung_ladder(closed_form_rungs(ladder));
                           }});
    }
    for (const ShLadder& ladder : sh_ladders()) {
        effects.push_back(
            {ladder.effect, [&ladder](const LadderOptions&) { return ladder.plan(); }});
    }
    effects.push_back({"transfer", [](const LadderOptions&) { return plan_transfer_ladder(); }});
    effects.push_back({"multiple", plan_multiple_ladder});
    return effects;
}

std::vector<std::string> effect_names() {
    std::vector<std::string> names;
    for (const LadderEffectInfo& effect : ladder_effects()) names.push_back(effect.name);
    return names;
}

struct LadderRequest {
    std::vector<std::string> effects;
    std::string directory;
    LadderOptions options;
};

void take_size(const std::string& text, LadderOptions& options) {
    const std::size_t x = text.find('x');
    if (x == std::string::npos) {
        throw Error(ErrorCode::usage, "'" + text + "' is no size such as 512x256", "--size");
    }
    options.width = parse_integer(text.substr(0, x), "--size", kSmallestWidth, kLargestWidth);
    options.height = parse_integer(text.substr(x + 1), "--size", 1, kLargestWidth);
    if (options.width != 2 * options.height) {
        throw Error(ErrorCode::usage, "'" + text + "' is not twice as wide as high", "--size");
    }
}

std::vector<LadderWork> plan_work(const LadderRequest& request) {
    const std::vector<std::string> names = effect_names();
    const std::vector<std::string>& asked = request.effects.empty() ? names : request.effects;
    for (const std::string& name : asked) {
        if (std::count(names.begin(), names.end(), name) == 0) {
            throw Error(ErrorCode::usage,
                        "unknown effect '" + name + "'; it can be " + list_choices(names));
        }
    }
    std::vector<LadderWork> work;
    for (const LadderEffectInfo& effect : ladder_effects()) {
        if (std::count(asked.begin(), asked.end(), effect.name) > 0) {
            work.push_back(effect.plan(request.options));
        }
    }
    return work;
}

void make_directory(const std::string& path) {
    std::error_code error;
    std::filesystem::create_directory(path, error);
    if (!std::filesystem::is_directory(path)) {
        throw Error(ErrorCode::io,
                    "cannot be made a directory" + (error ? ": " + error.message() : ""), path);
    }
}

std::vector<LadderEffect> measure(const std::vector<LadderWork>& work,
                                  const CommonOptions& common) {
    std::uint64_t total = 0;
    for (const LadderWork& each : work) {
        for (const LadderStep& step : each.steps) total += step.weight;
    }
    ProgressOptions drawing;
    drawing.quiet = common.verbosity < 0;
    Progress progress("ladder", total, drawing);
    std::vector<LadderEffect> effects;
    for (const LadderWork& each : work) {
        for (const LadderStep& step : each.steps) {
            step.run();
            progress.tick(step.weight);
        }
        effects.push_back(each.finish());
    }
    return effects;
}

void run_ladder(const LadderRequest& request, const CommonOptions& common) {
    if (request.directory.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o DIR");
    }
    const std::vector<LadderWork> work = plan_work(request);
    make_directory(request.directory);
    const auto file = [&](const std::string& name) {
        return (std::filesystem::path(request.directory) / name).string();
    };
    for (const LadderWork& each : work) {
        for (const std::string& name : each.files) check_target(file(name), common.force);
    }
    check_target(file("index.html"), common.force);

    const std::vector<LadderEffect> effects = measure(work, common);
    const std::string machine = machine_line();
    nlohmann::ordered_json report = {{"version", AIRLIGHT_VERSION},
                                     {"machine", machine},
                                     {"threads", thread_count()},
                                     {"page", file("index.html")}};
    for (const LadderEffect& effect : effects) {
        for (const LadderFigure& figure : effect.figures) {
            write_file_atomically(file(figure.name + ".svg"), to_svg(figure.plot), common.force);
            if (figure.table.columns.empty()) continue;
            write_file_atomically(file(figure.name + ".csv"), to_csv(figure.table), common.force);
            report["tables"][figure.name] = to_json(figure.table);
        }
    }
    write_file_atomically(file("index.html"), ladder_page(effects, machine), common.force);
    spdlog::info("{}: {}", file("index.html"), machine);
    if (common.json) print(report);
}

}  // namespace

Command declare_ladder(CLI::App& program) {
    Command command = declare_command(
        program, "ladder", "[EFFECT...] -o DIR",
        "Measure what accuracy costs in time on this machine",
        "  airlight ladder -o report\n"
        "  airlight ladder fog --size 1024x512 --optical-thickness 0.5 -o report --force\n"
        "  airlight ladder airlight -o report --json\n"
        "DIR gets EFFECT.csv, EFFECT.svg and index.html, one page with all plots and tables. It "
        "is\n"
        "made if it does not exist. The default takes some minutes. With --threads 1 times\n"
        "are CPU time, which a busy machine hardly changes; otherwise those of fog are wall time.");
    const auto request = std::make_shared<LadderRequest>();
    command.app
        ->add_option("effects", request->effects,
                     fmt::format("{} (default: all)", fmt::join(effect_names(), ", ")))
        ->option_text(" ");
    add_flag(command, "-o,--output", "DIR", "Directory of the report",
             [=](const std::string& text) { request->directory = text; });
    add_flag(command, "--size", "WxH",
             "Map on which errors of fog are measured, and the smallest of the cost plot "
             "(default: 512x256)",
             [=](const std::string& text) { take_size(text, request->options); });
    add_flag(command, "--optical-thickness", "T", "Of the fog (default: 2)",
             [=](const std::string& text) {
                 request->options.optical_thickness =
                     parse_number(text, "--optical-thickness", {0, 50, true});
             });
    command.app->add_flag(
        "--full", request->options.full,
        "Cost for maps 16 times as wide as --size (default: 8 times); 80 times the paths of "
        "multiple");
    add_json_flag(command, "Print the tables as JSON");
    add_force_flag(command);
    command.run = [request, common = command.common] { run_ladder(*request, *common); };
    return command;
}

}  // namespace airlight
