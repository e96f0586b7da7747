// SPDX-License-Identifier: Apache-2.0
#include "cli/fog_files.h"

#include <filesystem>
#include <map>
#include <system_error>

#include "core/error.h"

namespace airlight {
namespace {

constexpr const char* kName = "{name}";

std::string expand(const std::string& pattern, const std::string& input) {
    const std::string stem = input == "-" ? "stdin" : std::filesystem::path(input).stem().string();
    std::string path = pattern;
    for (std::size_t at = path.find(kName); at != std::string::npos;
         at = path.find(kName, at + stem.size())) {
        path.replace(at, std::string(kName).size(), stem);
    }
    return path;
}

// One spelling for all paths to a file, existing or not.
std::string identity(const std::string& path) {
    std::error_code error;
    const auto canonical =
        std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
    return error ? path : canonical.string();
}

}  // namespace

std::vector<FogFiles> pair_files(const std::vector<std::string>& arguments) {
    if (arguments.size() < 2) {
        throw Error(ErrorCode::usage, arguments.empty()
                                          ? "an input and an output are missing (see airlight fog "
                                            "--help)"
                                          : "an output is missing after the input " + arguments[0]);
    }
    const std::string pattern = arguments.back();
    const std::size_t count = arguments.size() - 1;
    if (count > 1 && pattern.find(kName) == std::string::npos) {
        throw Error(ErrorCode::usage,
                    "several inputs need {name} in the output, as in foggy/{name}.exr", pattern);
    }
    std::vector<FogFiles> files;
    std::map<std::string, std::string> input_of_output, inputs;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string& input = arguments[i];
        files.push_back({input, expand(pattern, input)});
        const std::string id = input == "-" ? "-" : identity(input);
        if (!inputs.emplace(id, input).second) {
            throw Error(ErrorCode::usage, "is given as an input twice", input);
        }
    }
    for (const FogFiles& file : files) {
        if (file.output == "-") continue;
        const std::string id = identity(file.output);
        const auto [other, is_new] = input_of_output.emplace(id, file.input);
        if (!is_new) {
            throw Error(ErrorCode::usage,
                        other->second + " and " + file.input + " would both be written to it",
                        file.output);
        }
        const auto overwritten = inputs.find(id);
        if (overwritten != inputs.end() && overwritten->second != file.input) {
            throw Error(ErrorCode::usage,
                        "is an input and would be overwritten by what becomes of " + file.input,
                        file.output);
        }
    }
    return files;
}

}  // namespace airlight
