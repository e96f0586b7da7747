// SPDX-License-Identifier: Apache-2.0
// Which file each input of `airlight fog` is written to.
#pragma once

#include <string>
#include <vector>

namespace airlight {

struct FogFiles {
    std::string input;
    std::string output;
};

/// Splits IN... OUT, and puts each input's name without directory and extension ("stdin" for "-")
/// in place of {name} in OUT. Throws Error(usage) when an input or OUT is missing, when two inputs
/// would be written to one file or over each other, or when "-" appears more than once on a side.
std::vector<FogFiles> pair_files(const std::vector<std::string>& arguments);

}  // namespace airlight
