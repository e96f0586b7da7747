// SPDX-License-Identifier: Apache-2.0
#include "cli/fog_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/phase_flag.h"

namespace airlight {
namespace {

std::string values_text(const std::vector<double>& values) {
    const bool equal =
        std::all_of(values.begin(), values.end(), [&](double v) { return v == values[0]; });
    return equal ? fmt::format("{}", values.at(0)) : fmt::to_string(fmt::join(values, " "));
}

const char* psf_name(PsfForm form) {
    return form == PsfForm::exact ? "exact" : "factored";
}

bool has_bound(const FogPlan& plan) {
    return !plan.groups.empty() && plan.estimated_error >= 0;
}

nlohmann::ordered_json file_json(const FogRecord& record) {
    nlohmann::ordered_json json;
    json["input"] = record.input;
    json["output"] = record.output;
    json["width"] = record.width;
    json["height"] = record.height;
    json["component"] = component_name(record.component);
    json["optical_thickness"] = record.plan.optical_thickness;
    json["albedo"] =
        record.options.albedo.size() == 1
            ? std::vector<double>(record.plan.optical_thickness.size(), record.options.albedo[0])
            : record.options.albedo;
    json["phase"] = phase_name(record.options.phase);
    json["psf"] = psf_name(record.plan.psf);
    json["method"] = method_name(record.plan);
    json["lmax"] = record.plan.groups.empty() || record.plan.lmax < 0
                       ? nlohmann::ordered_json()
                       : nlohmann::ordered_json(record.plan.lmax);
    json["near_radius"] = record.plan.radius;
    json["tolerance"] = record.options.tolerance;
    if (record.plan.groups.empty()) {
        json["estimated_error"] = 0;
    } else if (has_bound(record.plan)) {
        json["estimated_error"] = record.plan.estimated_error;
    } else {
        json["estimated_error"] = nullptr;
    }
    json["seconds"] = {{"read", record.read_seconds},
                       {"compute", record.compute_seconds},
                       {"write", record.write_seconds}};
    json["peak_memory_bytes"] = record.peak_memory;
    json["notes"] = record.notes;
    return json;
}

}  // namespace

const char* component_name(FogComponent component) {
    switch (component) {
        case FogComponent::total:
            return "total";
        case FogComponent::direct:
            return "direct";
        case FogComponent::scattered:
            return "scattered";
        case FogComponent::layers:
            return "layers";
    }
    return "";
}

const char* method_name(const FogPlan& plan) {
    return plan.groups.empty() ? "none" : fog_method_name(plan.method);
}

std::vector<Attribute> settings_attributes(const FogRecord& record) {
    std::vector<Attribute> attributes = {
        {"airlight:opticalThickness", values_text(record.plan.optical_thickness)},
        {"airlight:albedo", values_text(record.options.albedo)},
        {"airlight:phase", phase_name(record.options.phase)},
        {"airlight:psf", std::string(psf_name(record.plan.psf))},
        {"airlight:component", std::string(component_name(record.component))},
        {"airlight:method", std::string(method_name(record.plan))},
    };
    if (has_bound(record.plan)) {
        attributes.push_back({"airlight:tolerance", static_cast<float>(record.options.tolerance)});
    }
    return attributes;
}

nlohmann::ordered_json to_json(const std::vector<FogRecord>& records) {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const FogRecord& record : records) files.push_back(file_json(record));
    return {{"version", AIRLIGHT_VERSION}, {"files", std::move(files)}};
}

}  // namespace airlight
