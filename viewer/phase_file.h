// SPDX-License-Identifier: Apache-2.0
// Files of phase functions: CSV with the header angle_degrees,value.
#pragma once

#include <string>

#include "medium/phase_function.h"

namespace airlight {

/// Reads one, of at most 1024 entries (see medium/phase_table.h). Throws Error naming file and
/// line: io when it cannot be read, data for what is no such table.
PhaseFunction read_phase_table(const std::string& path);

}  // namespace airlight
