// SPDX-License-Identifier: Apache-2.0
// airlight: light in fog, from the command line. One subcommand per file of this folder.
#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <new>
#include <vector>

#include "cli/command.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/log.h"
#include "core/threads.h"

namespace airlight {
namespace {

// A file opened while descriptor 1 is closed would become it and take what is meant for standard
// output. A stand-in that cannot be written makes such writes fail as they should.
void occupy_standard_descriptors() {
    while (true) {
        const int descriptor = open("/dev/null", O_RDONLY);
        if (descriptor < 0) return;
        if (descriptor > STDERR_FILENO) {
            close(descriptor);
            return;
        }
    }
}

std::string names_of(const std::vector<Command>& commands) {
    std::string names;
    for (const Command& command : commands) {
        names += (names.empty() ? "" : ", ") + command.app->get_name();
    }
    return names;
}

Error usage_error(const CLI::ParseError& error) {
    std::string message = error.what();
    message = message.substr(0, message.find('\n'));
    // "--flag: 1 required TEXT missing" and "--flag: At Most 1 required but received 2".
    const std::size_t colon = message.find(": ");
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr ||
        colon == std::string::npos) {
        return Error(ErrorCode::usage, message);
    }
    const bool missing = message.find("missing") != std::string::npos;
    return Error(ErrorCode::usage, missing ? "needs a value" : "is given more than once",
                 message.substr(0, colon));
}

// The first argument that nobody took; CLI11 lists the separator "--" among them.
std::string leftover(const CLI::App& app) {
    for (const std::string& argument : app.remaining()) {
        if (argument != "--") return argument;
    }
    return {};
}

bool is_flag(const std::string& argument) {
    return argument.size() > 1 && argument[0] == '-';
}

const Command* parse(CLI::App& program, const std::vector<Command>& commands, int argc,
                     char** argv) {
    program.parse(argc, argv);
    if (const std::string extra = leftover(program); !extra.empty()) {
        throw Error(ErrorCode::usage, is_flag(extra)
                                          ? "unknown flag " + extra + " (see airlight --help)"
                                          : "unknown command '" + extra + "'; the commands are " +
                                                names_of(commands));
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        if (const std::string extra = leftover(*command.app); !extra.empty()) {
            throw Error(ErrorCode::usage,
                        (is_flag(extra) ? "unknown flag " : "unexpected argument ") + extra +
                            " (see airlight " + command.app->get_name() + " --help)");
        }
        return &command;
    }
    return nullptr;
}

int run(int argc, char** argv) {
    CLI::App program("Light in fog: foggy environment maps and the functions behind them.",
                     "airlight");
    program.allow_extras();
    program.require_subcommand(0, 1);
    program.set_help_flag("-h,--help", "Print this help and exit");
    program.set_version_flag("--version", "airlight " AIRLIGHT_VERSION,
                             "Print the version and exit");
    program.footer(
        "Examples:\n"
        "  airlight fog room.exr foggy.exr --optical-thickness 1\n"
        "  airlight info foggy.exr\n"
        "  airlight sheet room.exr foggy.exr -o sheet.png\n"
        "  airlight eval psf < points.csv\n"
        "  airlight plan courtyard.json\n"
        "  airlight render courtyard.json -o courtyard.png\n"
        "airlight COMMAND --help tells more. Exit status: 0 done, 1 the data or the machine\n"
        "failed, 2 wrong usage; 128 and the signal's number: interrupted.");
    const std::vector<Command> commands = {
        declare_fog(program),    declare_info(program),   declare_eval(program),
        declare_sheet(program),  declare_ladder(program), declare_sh(program),
        declare_export(program), declare_brdf(program),   declare_bake(program),
        declare_merge(program),  declare_plan(program),   declare_render(program)};
    const Command* command = nullptr;
    try {
        command = parse(program, commands, argc, argv);
    } catch (const CLI::CallForHelp&) {
        print(program.help());
        return 0;
    } catch (const CLI::CallForVersion& version) {
        print(std::string(version.what()) + "\n");
        return 0;
    } catch (const CLI::ParseError& error) {
        throw usage_error(error);
    }
    if (command == nullptr) {
        const std::string help = program.help();
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, help.data(), help.size());
        return 2;
    }
    set_up_log(command->common->verbosity);
    const ThreadLimit limit(command->common->threads);
    command->run();
    return 0;
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    airlight::occupy_standard_descriptors();
    // Writing into a closed pipe, or beyond the size that files may have, is an error like others.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    airlight::set_up_log(0);
    try {
        return airlight::run(argc, argv);
    } catch (const airlight::Error& error) {
        spdlog::error("{}", error.describe());
        return error.code() == airlight::ErrorCode::usage ? 2 : 1;
    } catch (const airlight::Interrupted& interrupted) {
        spdlog::warn("{}", interrupted.what());
        airlight::end_by_signal(interrupted.signal());
    } catch (const std::bad_alloc&) {
        spdlog::error("not enough memory for this work (see --max-memory)");
    } catch (const std::exception& error) {
        spdlog::error("{}", error.what());
    }
    return 1;
}
