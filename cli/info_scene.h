// SPDX-License-Identifier: Apache-2.0
// What airlight info says about a scene.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "viewer/scene.h"

namespace airlight {

std::string to_lines(const std::string& path, const Scene& scene);
nlohmann::ordered_json to_json(const std::string& path, const Scene& scene);

}  // namespace airlight
