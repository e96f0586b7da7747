// SPDX-License-Identifier: Apache-2.0
// What airlight info says about a coefficient file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "sh/sh_file.h"

namespace airlight {

std::string to_lines(const std::string& path, const ShFile& light);
nlohmann::ordered_json to_json(const std::string& path, const ShFile& light);

}  // namespace airlight
