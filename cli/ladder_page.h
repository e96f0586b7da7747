// SPDX-License-Identifier: Apache-2.0
// The ladder report for people: one HTML page that needs nothing else.
#pragma once

#include <string>
#include <vector>

#include "cli/ladder_effects.h"

namespace airlight {

/// What the figures were measured on and when, "CPU, N processors, T threads used, system,
/// compiler, airlight version, day".
std::string machine_line();

/// The page: the machine, then each effect's plots and tables.
std::string ladder_page(const std::vector<LadderEffect>& effects, const std::string& machine);

}  // namespace airlight
