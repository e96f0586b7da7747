// SPDX-License-Identifier: Apache-2.0
// What the subcommands share: how one is declared, the flags that all of them have, and output.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/checked.h"

namespace airlight {

/// The values of the common flags.
struct CommonOptions {
    int verbosity = 0;  ///< -v up, -q down, as set_up_log takes it
    int threads = 0;    ///< 0: all
    bool json = false;
    bool force = false;
    std::size_t max_memory = kDefaultMaxMemory;
};

/// One subcommand: its flags are declared, `run` does its work after they have been parsed.
struct Command {
    CLI::App* app = nullptr;
    std::shared_ptr<CommonOptions> common;
    std::function<void()> run;
};

/// A subcommand with --help, --version, -v, -q and --threads. Its help says `arguments` behind the
/// name ("IN... OUT") and ends with `examples`.
Command declare_command(CLI::App& program, const std::string& name, const std::string& arguments,
                        const std::string& description, const std::string& examples);

void add_json_flag(const Command& command, const std::string& help);
void add_force_flag(const Command& command);
void add_max_memory_flag(const Command& command);

/// A flag with one value, handed to `take` as text. Errors of `take` reach main.
CLI::Option* add_flag(const Command& command, const std::string& flag, const std::string& value,
                      const std::string& help, std::function<void(const std::string&)> take);

Command declare_fog(CLI::App& program);
Command declare_info(CLI::App& program);
Command declare_eval(CLI::App& program);
Command declare_sheet(CLI::App& program);
Command declare_ladder(CLI::App& program);
Command declare_sh(CLI::App& program);
Command declare_export(CLI::App& program);
Command declare_brdf(CLI::App& program);
Command declare_bake(CLI::App& program);
Command declare_merge(CLI::App& program);
Command declare_plan(CLI::App& program);
Command declare_render(CLI::App& program);

/// Writes to standard output. Throws Error(io) when it is closed, full or a broken pipe.
void print(const std::string& text);

/// The same for a report. Names of files may hold bytes that are no UTF-8; they become U+FFFD.
void print(const nlohmann::ordered_json& report);

}  // namespace airlight
