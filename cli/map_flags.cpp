// SPDX-License-Identifier: Apache-2.0
#include "cli/map_flags.h"

#include "cli/numbers.h"

namespace airlight {

void add_map_flags(const Command& command, ReadOptions& read) {
    add_flag(
        command, "--nonfinite", "refuse|zero",
        "NaN and infinite pixels of the input (default: refuse)", [&read](const std::string& text) {
            read.nonfinite =
                static_cast<NonfinitePolicy>(parse_choice(text, "--nonfinite", {"refuse", "zero"}));
        });
    add_flag(command, "--negative", "keep|clamp", "Negative pixels of the input (default: keep)",
             [&read](const std::string& text) {
                 read.negative = static_cast<NegativePolicy>(
                     parse_choice(text, "--negative", {"keep", "clamp"}));
             });
    add_flag(command, "--layout", "latlong", "Take maps of any shape for lat-long maps",
             [&read](const std::string& text) {
                 parse_choice(text, "--layout", {"latlong"});
                 read.allow_any_aspect = true;
             });
}

}  // namespace airlight
