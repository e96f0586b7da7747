// SPDX-License-Identifier: Apache-2.0
// The flag --phase: a phase function by name.
#pragma once

#include <string>

#include "medium/phase_function.h"

namespace airlight {

/// "isotropic", "rayleigh", "hg:G" with G in (-1, 1), or "table:FILE", a CSV file with the columns
/// angle_degrees and value: rising angles in [0, 180], 0 being forward, and values on any scale
/// (medium/phase_table.h, monotone). Throws Error: usage for any other text, io and data for a file
/// that cannot be used.
PhaseFunction parse_phase(const std::string& text, const std::string& flag);

/// The text that names a phase function, the shortest that keeps G; "table" for a table.
std::string phase_name(const PhaseFunction& phase);

}  // namespace airlight
