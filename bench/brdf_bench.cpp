// SPDX-License-Identifier: Apache-2.0
// Tabulated BRDFs on one thread: cost beside error, for rough metals at the published size.
//
// lookup       evaluate_brdf by its rungs; max_error against the function tabulated, relative to
//              its value at the mirror direction, both directions within 80 degrees of the normal
// bands        BrdfBands for one outgoing angle; max_error is the norm of the difference from four
//              times as many rows and columns, over the norm, of outgoing angles to 75 degrees
// reflectance  directional_reflectance by samples; max_error against 1024 samples, to 75 degrees
// fog          foggy_brdf at T = 1 by order; max_error of E against quadrature of the function
//              tabulated, over the largest E, both directions within 80 degrees; what the report
//              says beside it
// Names end with the metal's roughness, in hundredths.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "cli/ladder_metal.h"
#include "core/constants.h"
#include "core/threads.h"
#include "sh/brdf_bands.h"
#include "sh/brdf_fog.h"
#include "sh/brdf_models.h"
#include "sh/brdf_reflectance.h"
#include "sh/index.h"

namespace airlight {
namespace {

const double kLowest = std::cos(80 * kPi / 180);

RoughMetal metal_of(int hundredths) {
    RoughMetal metal;
    metal.roughness = hundredths / 100.0;
    return metal;
}

glm::dvec3 spherical(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Every other pair has its half vector near the normal, where the highlight is.
std::vector<BrdfDirections> random_pairs(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto direction = [&] {
        return spherical(std::acos(1 - (1 - kLowest) * unit(random)), 2 * kPi * unit(random));
    };
    std::vector<BrdfDirections> pairs;
    while (pairs.size() < count) {
        const glm::dvec3 in = direction(), mirror(-in.x, -in.y, in.z);
        glm::dvec3 out = direction();
        if (pairs.size() % 2 == 0) out = glm::normalize(mirror + 0.1 * out);
        if (out.z >= kLowest) pairs.push_back({in, out});
    }
    return pairs;
}

void add_lookup(int hundredths, BrdfLookup lookup, std::string_view name) {
    benchmark::RegisterBenchmark(
        ("lookup/" + std::string(name) + "/" + std::to_string(hundredths)).c_str(),
        [=](benchmark::State& state) {
            const RoughMetal metal = metal_of(hundredths);
            const BrdfTable table = tabulate(metal);
            const std::vector<BrdfDirections> pairs = random_pairs(20000);
            double worst = 0;
            for (const BrdfDirections& pair : pairs) {
                const glm::dvec3 mirror(-pair.in.x, -pair.in.y, pair.in.z);
                const glm::dvec3 apart = evaluate_brdf(table, pair.in, pair.out, lookup) -
                                         evaluate_metal(metal, pair.in, pair.out);
                worst =
                    std::max(worst, std::abs(apart.x) / evaluate_metal(metal, pair.in, mirror).x);
            }
            state.counters["max_error"] = worst;
            std::size_t i = 0;
            for (auto _ : state) {
                const BrdfDirections& pair = pairs[i++ % pairs.size()];
                benchmark::DoNotOptimize(evaluate_brdf(table, pair.in, pair.out, lookup));
            }
        });
}

void add_bands(int order, int hundredths) {
    benchmark::RegisterBenchmark(
        ("bands/" + std::to_string(order) + "/" + std::to_string(hundredths)).c_str(),
        [=](benchmark::State& state) {
            const ThreadLimit one(1);
            const BrdfTable table = tabulate(metal_of(hundredths));
            const BrdfBands bands(order), fine(4 * order);
            const std::size_t count = sh_count(order);
            std::vector<double> values(3 * count), exact(3 * sh_count(4 * order));
            double worst = 0;
            for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
                bands.coefficients(table, degrees * kPi / 180, values.data());
                fine.coefficients(table, degrees * kPi / 180, exact.data());
                double apart = 0, all = 0;
                for (std::size_t i = 0; i < count; ++i) {
                    apart += (values[i] - exact[i]) * (values[i] - exact[i]);
                    all += exact[i] * exact[i];
                }
                worst = std::max(worst, std::sqrt(apart / all));
            }
            state.counters["max_error"] = worst;
            for (auto _ : state) bands.coefficients(table, 0.5, values.data());
        })
        ->Unit(benchmark::kMillisecond);
}

void add_reflectance(int samples, int hundredths) {
    benchmark::RegisterBenchmark(
        ("reflectance/" + std::to_string(samples) + "/" + std::to_string(hundredths)).c_str(),
        [=](benchmark::State& state) {
            const ThreadLimit one(1);
            const BrdfTable table = tabulate(metal_of(hundredths));
            double worst = 0;
            for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
                const double theta = degrees * kPi / 180;
                worst = std::max(worst, std::abs(directional_reflectance(table, theta, samples).x -
                                                 directional_reflectance(table, theta, 1024).x));
            }
            state.counters["max_error"] = worst;
            for (auto _ : state) {
                benchmark::DoNotOptimize(directional_reflectance(table, 0.5, samples));
            }
        })
        ->Unit(benchmark::kMillisecond);
}

struct Check {
    std::size_t index;
    double cosine, exact;
};

// Cells of a directed table of the published size, and E there.
const std::vector<Check>& checks_of(int hundredths) {
    static std::vector<std::pair<int, std::vector<Check>>> known;
    for (const auto& [key, checks] : known) {
        if (key == hundredths) return checks;
    }
    const BrdfSize size = {90, 90, 360};
    std::vector<Check> checks;
    for (const int h : {0, 5, 15, 30, 50, 70}) {
        for (const int d : {1, 30, 60, 75}) {
            for (const int p : {10, 130, 250}) {
                const BrdfDirections at = brdf_directions(brdf_cell_centre(size, h, d, p));
                if (at.in.z < kLowest || at.out.z < kLowest) continue;
                const auto index = static_cast<std::size_t>((h * 90 + d) * 360 + p);
                checks.push_back(
                    {index, at.in.z, metal_airlight(metal_of(hundredths), 1, at, 800, 640)});
            }
        }
    }
    known.emplace_back(hundredths, std::move(checks));
    return known.back().second;
}

void add_fog(int order, int hundredths) {
    benchmark::RegisterBenchmark(
        ("fog/" + std::to_string(order) + "/" + std::to_string(hundredths)).c_str(),
        [=](benchmark::State& state) {
            const BrdfTable table = tabulate(metal_of(hundredths));
            BrdfFogOptions options;
            options.optical_thickness = {1};
            options.order = order;
            options.component = BrdfComponent::scattered;
            options.directed = true;
            const std::vector<Check>& checks = checks_of(hundredths);
            const ThreadLimit one(1);
            BrdfFogReport report;
            BrdfTable foggy;
            for (auto _ : state) foggy = foggy_brdf(table, options, &report);
            double worst = 0, largest = 0;
            for (const Check& check : checks) {
                const double value = foggy.channel(0)[check.index] * kBrdfScale[0] * check.cosine;
                worst = std::max(worst, std::abs(value - check.exact));
                largest = std::max(largest, check.exact);
            }
            state.counters["max_error"] = worst / largest;
            state.counters["tail"] = report.tail;
            state.counters["deepest"] = report.deepest;
            state.counters["asymmetry"] = report.asymmetry;
        })
        ->Unit(benchmark::kSecond)
        ->Iterations(1);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    for (const int hundredths : {5, 10, 20, 50}) {
        for (const auto& rung : airlight::kBrdfLookups) {
            airlight::add_lookup(hundredths, rung.method, rung.name);
        }
    }
    for (const int order : {16, 64, 128}) airlight::add_bands(order, 20);
    for (const int samples : {64, 128, 256}) {
        airlight::add_reflectance(samples, 5);
        airlight::add_reflectance(samples, 20);
    }
    for (const int order : {32, 64, 128, 256}) airlight::add_fog(order, 20);
    for (const int hundredths : {5, 10, 50}) airlight::add_fog(128, hundredths);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
