// SPDX-License-Identifier: Apache-2.0
// What `airlight fog` says about a file: the output's attributes and the report of --json.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "envmap/fog.h"
#include "envmap/image.h"

namespace airlight {

enum class FogComponent { total, direct, scattered, layers };

const char* component_name(FogComponent component);

struct FogRecord {
    std::string input;
    std::string output;
    int width = 0;
    int height = 0;
    FogComponent component = FogComponent::total;
    FogOptions options;  ///< as asked for
    FogPlan plan;        ///< as carried out
    double read_seconds = 0;
    double compute_seconds = 0;
    double write_seconds = 0;
    std::size_t peak_memory = 0;
    std::vector<std::string> notes;
};

/// The name of the method that computed scattered light, "none" where there was none to compute.
const char* method_name(const FogPlan& plan);

/// "airlight:opticalThickness" (one value, or three separated by blanks), "airlight:albedo",
/// "airlight:phase", "airlight:psf", "airlight:component", "airlight:method", and
/// "airlight:tolerance" where the method has one.
std::vector<Attribute> settings_attributes(const FogRecord& record);

/// {"version", "files"}: for each file its "input", "output", "width", "height", "component",
/// "optical_thickness" and "albedo" (of R, G, B), "phase", "psf", "method", "lmax" (null without
/// bands), "near_radius" [rad], "tolerance", "estimated_error" (relative; null for sh, which has no
/// bound), "seconds" {"read", "compute", "write"}, "peak_memory_bytes" of the process so far, and
/// "notes", sentences about what was read and written.
nlohmann::ordered_json to_json(const std::vector<FogRecord>& records);

}  // namespace airlight
