// SPDX-License-Identifier: Apache-2.0
#include "cli/brdf_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/constants.h"
#include "sh/brdf_reflectance.h"

namespace airlight {
namespace {

nlohmann::ordered_json channels(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

BrdfFigures brdf_figures(const BrdfTable& table, std::size_t nonfinite) {
    BrdfFigures figures;
    figures.size = table.size;
    figures.nonfinite = nonfinite;
    for (std::size_t c = 0; c < 3; ++c) {
        double smallest = std::numeric_limits<double>::infinity(), largest = 0;
        for (std::size_t i = 0; i < table.size.cells(); ++i) {
            const double value = table.channel(static_cast<int>(c))[i];
            if (value < 0) {
                ++figures.without;
                continue;
            }
            smallest = std::min(smallest, value);
            largest = std::max(largest, value);
        }
        figures.smallest[c] = kBrdfScale[c] * std::min(smallest, largest);
        figures.largest[c] = kBrdfScale[c] * largest;
    }
    for (const double degrees : kBrdfReportDegrees) {
        figures.directional.push_back(directional_reflectance(table, degrees * kPi / 180));
    }
    figures.white_sky = white_sky_reflectance(table);
    figures.reciprocity_error = reciprocity_error(table);
    return figures;
}

double largest_albedo(const BrdfFigures& figures) {
    double largest = 0;
    for (const glm::dvec3& v : figures.directional) largest = std::max({largest, v.x, v.y, v.z});
    return largest;
}

nlohmann::ordered_json to_json(const BrdfFigures& figures) {
    nlohmann::ordered_json directional = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < figures.directional.size(); ++i) {
        directional.push_back({{"theta_out_degrees", kBrdfReportDegrees[i]},
                               {"reflectance", channels(figures.directional[i])}});
    }
    return {{"size", {figures.size.half, figures.size.difference, figures.size.azimuth}},
            {"cells_without_value", figures.without},
            {"nonfinite", figures.nonfinite},
            {"minimum", figures.smallest},
            {"maximum", figures.largest},
            {"directional", std::move(directional)},
            {"largest_albedo", largest_albedo(figures)},
            {"white_sky", channels(figures.white_sky)},
            {"reciprocity_error", figures.reciprocity_error}};
}

std::string to_lines(const BrdfFigures& figures) {
    const BrdfSize& size = figures.size;
    std::string text = fmt::format(
        "  {} x {} x {} cells of theta_half, theta_diff and phi_diff ({}), channels R G B, BRDF\n",
        size.half, size.difference, size.azimuth, size.directed() ? "0 to 360" : "0 to 180");
    const auto row = [&](const char* name, const auto& v) {
        text += fmt::format("  {:<26} {:>12.6g} {:>12.6g} {:>12.6g}\n", name, v[0], v[1], v[2]);
    };
    row("minimum [1/sr]", figures.smallest);
    row("maximum [1/sr]", figures.largest);
    row("reflectance, white sky", figures.white_sky);
    for (std::size_t i = 0; i < figures.directional.size(); ++i) {
        row(fmt::format("reflectance to {} deg", kBrdfReportDegrees[i]).c_str(),
            figures.directional[i]);
    }
    const double albedo = largest_albedo(figures);
    text += fmt::format("  {:<26} {:>12.6g}{}\n", "largest albedo", albedo,
                        albedo > 1 ? " (more than it receives)" : "");
    text += fmt::format("  {:<26} {:>12.6g}\n", "reciprocity error", figures.reciprocity_error);
    text += fmt::format("  {:<26} {} of {} without one (negative), {} of them non-finite\n",
                        "values", figures.without, 3 * size.cells(), figures.nonfinite);
    return text;
}

}  // namespace airlight
