// SPDX-License-Identifier: Apache-2.0
#include "cli/command.h"

#include <unistd.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "cli/numbers.h"
#include "core/atomic_file.h"
#include "core/descriptor.h"
#include "core/error.h"

namespace airlight {
namespace {

constexpr int kMostThreads = 4096;

class HelpFormatter : public CLI::Formatter {
  public:
    explicit HelpFormatter(std::string arguments) : arguments_(std::move(arguments)) {}

    std::string make_usage(const CLI::App* app, std::string) const override {
        return "Usage: airlight " + app->get_name() + " [FLAGS] " + arguments_ + "\n";
    }

  private:
    std::string arguments_;
};

}  // namespace

Command declare_command(CLI::App& program, const std::string& name, const std::string& arguments,
                        const std::string& description, const std::string& examples) {
    Command command;
    command.app = program.add_subcommand(name, description);
    command.common = std::make_shared<CommonOptions>();
    command.app->formatter(std::make_shared<HelpFormatter>(arguments));
    // Unknown flags are reported by main, in a sentence of ours.
    command.app->allow_extras();
    command.app->footer("Examples:\n" + examples);
    command.app->set_help_flag("-h,--help", "Print this help and exit");
    command.app->set_version_flag("--version", "airlight " AIRLIGHT_VERSION,
                                  "Print the version and exit");
    CommonOptions* common = command.common.get();
    command.app->add_flag_function(
        "-v,--verbose",
        [common](std::int64_t count) { common->verbosity += static_cast<int>(count); },
        "Say more (twice: everything)");
    command.app->add_flag_function(
        "-q,--quiet",
        [common](std::int64_t count) { common->verbosity -= static_cast<int>(count); },
        "Say errors only, and show no progress");
    add_flag(command, "--threads", "N", "Threads to use (default: all); results never depend on it",
             [common](const std::string& text) {
                 common->threads = parse_integer(text, "--threads", 1, kMostThreads);
             });
    return command;
}

void add_json_flag(const Command& command, const std::string& help) {
    command.app->add_flag("--json", command.common->json, help);
}

void add_force_flag(const Command& command) {
    command.app->add_flag("--force", command.common->force, "Replace existing output files");
}

void add_max_memory_flag(const Command& command) {
    CommonOptions* common = command.common.get();
    add_flag(command, "--max-memory", "SIZE",
             "Memory that pictures and work may take (default: 2G)",
             [common](const std::string& text) {
                 common->max_memory = parse_size(text, "--max-memory");
             });
}

CLI::Option* add_flag(const Command& command, const std::string& flag, const std::string& value,
                      const std::string& help, std::function<void(const std::string&)> take) {
    return command.app->add_option_function<std::string>(flag, std::move(take), help)
        ->type_name(value);
}

void print(const std::string& text) {
    if (const int error = write_all(STDOUT_FILENO, text.data(), text.size()); error != 0) {
        throw Error(ErrorCode::io, "cannot write: " + system_message(error), "standard output");
    }
}

void print(const nlohmann::ordered_json& report) {
    print(report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace airlight
