// SPDX-License-Identifier: Apache-2.0
// What is told about a tabulated BRDF, by airlight brdf and airlight info.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sh/brdf.h"

namespace airlight {

struct BrdfFigures {
    BrdfSize size;
    std::size_t nonfinite = 0;  ///< values of the file that were
    std::size_t without = 0;    ///< values that mark cells without one, those included
    std::array<double, 3> smallest{}, largest{};  ///< of the cells with a value [1/sr]
    std::vector<glm::dvec3> directional;          ///< at each of kBrdfReportDegrees
    glm::dvec3 white_sky{0.0};
    double reciprocity_error = 0;
};

/// Outgoing angles whose reflectance is reported; the albedo is the largest of them.
inline constexpr std::array<double, 8> kBrdfReportDegrees = {0, 15, 30, 45, 60, 70, 80, 85};

BrdfFigures brdf_figures(const BrdfTable& table, std::size_t nonfinite = 0);

/// The largest reflectance of any channel at any reported angle.
double largest_albedo(const BrdfFigures& figures);

nlohmann::ordered_json to_json(const BrdfFigures& figures);
std::string to_lines(const BrdfFigures& figures);

}  // namespace airlight
