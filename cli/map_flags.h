// SPDX-License-Identifier: Apache-2.0
// How the maps of a command are read.
#pragma once

#include "cli/command.h"
#include "envmap/io.h"

namespace airlight {

/// --nonfinite, --negative and --layout.
void add_map_flags(const Command& command, ReadOptions& read);

}  // namespace airlight
