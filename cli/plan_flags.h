// SPDX-License-Identifier: Apache-2.0
// What plan and render have in common: flags that change a plan, and its report.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "viewer/plan.h"

namespace airlight {

/// --engine, --all, --only and --without.
void add_plan_flags(const Command& command, PlanOptions& options);

/// "640x360"; throws Error(usage), naming --size.
void parse_picture_size(const std::string& text, int& width, int& height);

/// "--tolerance" of a plan; throws Error(usage).
double parse_tolerance(const std::string& text);

/// One sentence on standard error where the tolerance is finer than any method's error.
void warn_of_tolerance(const std::string& path, const Plan& plan);

std::string to_lines(const std::string& path, const Plan& plan);
nlohmann::ordered_json to_json(const Plan& plan);

}  // namespace airlight
