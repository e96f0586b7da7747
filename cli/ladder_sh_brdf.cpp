// SPDX-License-Identifier: Apache-2.0
// Ladders of tabulated BRDFs.
#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <memory>

#include "cli/ladder_draws.h"
#include "cli/ladder_metal.h"
#include "cli/ladder_sh.h"
#include "sh/brdf.h"
#include "sh/brdf_fog.h"
#include "sh/brdf_models.h"

namespace airlight {
namespace {

const double kLowest = std::cos(80 * kPi / 180);
constexpr double kFogRoughness = 0.2;

RoughMetal metal_of(double roughness) {
    RoughMetal metal;
    metal.roughness = roughness;
    return metal;
}

// Every other pair has its half vector near the normal, where the highlight is.
std::vector<BrdfDirections> random_pairs(std::size_t count) {
    Draws draws(41);
    std::vector<BrdfDirections> pairs;
    while (pairs.size() < count) {
        const glm::dvec3 in = draws.direction(kLowest), mirror(-in.x, -in.y, in.z);
        glm::dvec3 out = draws.direction(kLowest);
        if (pairs.size() % 2 == 0) out = glm::normalize(mirror + 0.1 * out);
        if (out.z >= kLowest) pairs.push_back({in, out});
    }
    return pairs;
}

/// The table of a metal, which takes some time to make.
struct Metal {
    RoughMetal metal;
    BrdfTable table;

    const BrdfTable& tabulated() {
        if (table.values.empty()) table = tabulate(metal);
        return table;
    }
};

RungResult measure_lookup(Metal& metal, BrdfLookup lookup) {
    const BrdfTable& table = metal.tabulated();
    const std::vector<BrdfDirections> pairs = random_pairs(5000);
    LadderErrors errors;
    for (const BrdfDirections& pair : pairs) {
        const glm::dvec3 mirror(-pair.in.x, -pair.in.y, pair.in.z);
        const double apart = evaluate_brdf(table, pair.in, pair.out, lookup).x -
                             evaluate_metal(metal.metal, pair.in, pair.out).x;
        errors.add(std::abs(apart) / evaluate_metal(metal.metal, pair.in, mirror).x);
    }
    double sink = 0;
    const double nanoseconds = nanoseconds_each(static_cast<double>(pairs.size()), [&] {
        for (const BrdfDirections& pair : pairs) {
            sink += evaluate_brdf(table, pair.in, pair.out, lookup).x;
        }
    });
    // So that no compiler leaves the sums out.
    if (std::isnan(sink)) errors.add(sink);
    return {nanoseconds, errors.largest(), errors.rms()};
}

struct Cell {
    std::size_t index;
    double cosine, exact;
};

/// A metal and E at some cells of its table, on twice as many azimuths.
struct FoggyMetal : Metal {
    std::vector<Cell> cells;

    const std::vector<Cell>& checked() {
        const BrdfSize size = {90, 90, 360};
        if (!cells.empty()) return cells;
        for (const int h : {0, 5, 15, 30, 50, 70}) {
            for (const int d : {1, 30, 60, 75}) {
                for (const int p : {10, 130, 250}) {
                    const BrdfDirections at = brdf_directions(brdf_cell_centre(size, h, d, p));
                    if (at.in.z < kLowest || at.out.z < kLowest) continue;
                    cells.push_back({static_cast<std::size_t>((h * 90 + d) * 360 + p), at.in.z,
                                     metal_airlight(metal, 1, at, 400, 320)});
                }
            }
        }
        return cells;
    }
};

RungResult measure_fog(FoggyMetal& metal, int order) {
    BrdfFogOptions options;
    options.optical_thickness = {1};
    options.order = order;
    options.component = BrdfComponent::scattered;
    options.directed = true;
    BrdfTable foggy;
    const BrdfTable& table = metal.tabulated();
    const double seconds =
        fastest_seconds(1, TimeKind::cpu, [&] { foggy = foggy_brdf(table, options); });
    double largest = 0;
    for (const Cell& cell : metal.checked()) largest = std::max(largest, cell.exact);
    LadderErrors errors;
    for (const Cell& cell : metal.checked()) {
        const double value = foggy.channel(0)[cell.index] * kBrdfScale[0] * cell.cosine;
        errors.add(std::abs(value - cell.exact) / largest);
    }
    return {1e9 * seconds, errors.largest(), errors.rms()};
}

}  // namespace

RungLadder brdf_lookup_ladder() {
    RungLadder ladder;
    ladder.effect = "brdf";
    ladder.title = "Lookups in tabulated BRDFs";
    ladder.text =
        "<p>Rough metals tabulated on 90 × 90 × 180 cells of half and difference angles, looked "
        "up at 5000 pairs of directions within 80° of the normal, every other one near the mirror "
        "direction. Dots are labelled with the roughness. The error is that against the function "
        "tabulated, relative to its value at the mirror direction.</p>";
    ladder.result = "lookup";
    ladder.error = "error over the mirror direction's value";
    RungFigure figure;
    figure.file = "brdf";
    figure.title = ladder.title;
    figure.subtitle = "metals of the roughness in the label";
    for (const auto& info : kBrdfLookups) {
        figure.series.push_back(
            {std::string(info.name), kPlotColours[figure.series.size()], false, {}});
    }
    for (const double roughness : {0.05, 0.2, 0.5}) {
        const auto metal = std::make_shared<Metal>();
        metal->metal = metal_of(roughness);
        for (std::size_t i = 0; i < std::size(kBrdfLookups); ++i) {
            figure.rungs.push_back(
                {std::string(kBrdfLookups[i].name), fmt::format("roughness {}", roughness),
                 fmt::format("{}", roughness), i,
                 [=] { return measure_lookup(*metal, kBrdfLookups[i].method); }});
        }
    }
    ladder.figures = {std::move(figure)};
    return ladder;
}

RungLadder brdf_fog_ladder() {
    RungLadder ladder;
    ladder.effect = "brdf-fog";
    ladder.title = "Effective BRDFs in fog";
    ladder.text = fmt::format(
        "<p>The airlight part of the effective BRDF of a metal of roughness {} at optical "
        "thickness 1, on 90 × 90 × 360 cells, by the number of its bands. The error of "
        "E = f cos θ at some cells within 80° of the normal is relative to its largest value; "
        "exact is the integral over the function tabulated. What stays is the error of the "
        "table.</p>",
        kFogRoughness);
    ladder.result = "table";
    ladder.milliseconds = true;
    ladder.error = "error over the largest E";
    RungFigure figure;
    figure.file = "brdf-fog";
    figure.title = ladder.title;
    figure.subtitle = fmt::format("metal of roughness {}, T = 1; labels are orders", kFogRoughness);
    figure.series = {{"by order", kPlotColours[0], true, {}}};
    const auto metal = std::make_shared<FoggyMetal>();
    metal->metal = metal_of(kFogRoughness);
    for (const int order : {8, 16, 32, 64}) {
        figure.rungs.push_back({"bands", order_name(order), std::to_string(order), 0,
                                [=] { return measure_fog(*metal, order); }, 0,
                                static_cast<std::uint64_t>(1500 + 25 * order), true});
    }
    ladder.figures = {std::move(figure)};
    return ladder;
}

}  // namespace airlight
