// SPDX-License-Identifier: Apache-2.0
// airlight merge: the parts of a bake become the file that one process would have written.
#include "prt/merge.h"

#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"

namespace airlight {
namespace {

struct MergeRequest {
    std::vector<std::string> parts;
    std::string output;
};

void run_merge(const MergeRequest& request, const CommonOptions& common) {
    if (request.parts.empty()) {
        throw Error(ErrorCode::usage, "parts are missing (see airlight merge --help)");
    }
    if (request.output.empty()) {
        throw Error(ErrorCode::usage, "the output is missing: give -o FILE.prt");
    }
    if (request.output == "-") {
        throw Error(ErrorCode::usage, "a .prt file cannot go to standard output", "-o");
    }
    check_target(request.output, common.force);
    MergeOptions options;
    options.force = common.force;
    options.max_memory = common.max_memory;
    options.progress.quiet = common.verbosity < 0;
    const MergeReport report = merge_parts(request.parts, request.output, options);
    for (const std::string& note : report.notes) spdlog::warn("{}: {}", request.output, note);
    if (!common.json) return;
    print(nlohmann::ordered_json{{"version", AIRLIGHT_VERSION},
                                 {"output", request.output},
                                 {"parts", request.parts.size()},
                                 {"vertices", report.header.mesh_vertices},
                                 {"order", report.header.order},
                                 {"rays", report.counts.rays},
                                 {"blocked", report.counts.blocked},
                                 {"mostly_blocked_vertices", report.counts.mostly_blocked},
                                 {"key", to_text(report.header.key)},
                                 {"peak_memory_bytes", peak_memory()},
                                 {"notes", report.notes}});
}

}  // namespace

Command declare_merge(CLI::App& program) {
    Command command = declare_command(
        program, "merge", "PART... -o OUT.prt", "Join the parts of a bake",
        "  airlight bake statue.ply -o part1.prt --shard 1/2\n"
        "  airlight bake statue.ply -o part2.prt --shard 2/2\n"
        "  airlight merge part1.prt part2.prt -o statue.prt\n"
        "The parts may be given in any order. The result is the file that airlight bake writes\n"
        "without --shard, byte for byte. docs/farm.md tells more.");
    const auto request = std::make_shared<MergeRequest>();
    command.app->add_option("parts", request->parts, "All parts of one bake")->option_text(" ");
    add_flag(command, "-o,--output", "FILE.prt", "The result (docs/PRT_FILES.md)",
             [request](const std::string& text) { request->output = text; });
    add_json_flag(command, "Report on standard output: counts, rays, memory, notes");
    add_force_flag(command);
    add_max_memory_flag(command);
    command.run = [request, common = command.common] { run_merge(*request, *common); };
    return command;
}

}  // namespace airlight
