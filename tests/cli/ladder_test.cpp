// SPDX-License-Identifier: Apache-2.0
// airlight ladder: the report's files, and that what it measures keeps what the plans promise.
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "medium/airlight_method.h"
#include "tests/cli/program.h"
#include "tests/core/scratch_directory.h"

namespace airlight {
namespace {

using CsvRow = std::map<std::string, std::string>;

// None of the report's fields is quoted.
std::vector<CsvRow> read_csv(const std::string& path) {
    std::istringstream text(read_bytes(path));
    std::vector<std::string> header;
    std::vector<CsvRow> rows;
    for (std::string line; std::getline(text, line);) {
        std::vector<std::string> fields;
        for (std::size_t begin = 0; begin <= line.size();) {
            const std::size_t end = std::min(line.find(',', begin), line.size());
            fields.push_back(line.substr(begin, end - begin));
            begin = end + 1;
        }
        if (header.empty()) {
            header = fields;
            continue;
        }
        EXPECT_EQ(fields.size(), header.size()) << line;
        CsvRow row;
        for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = fields.at(i);
        rows.push_back(row);
    }
    return rows;
}

// The page must stand alone; the name space of SVG is no address that anything loads.
void expect_self_contained(const std::string& page) {
    for (const char* word : {"<script", "<link", "<img", "src=", "href=", "url(", "@import"}) {
        EXPECT_EQ(page.find(word), std::string::npos) << word;
    }
    EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
    EXPECT_NE(page.find("</html>"), std::string::npos);
}

TEST(Ladder, EveryFogRungKeepsItsToleranceAtAnyThreadCount) {
    const ScratchDirectory scratch;
    std::vector<CsvRow> first;
    for (const std::string threads : {"1", "2"}) {
        const std::string report = scratch / threads;
        const Outcome outcome = run(
            {"ladder", "fog", "--size", "128x64", "--threads", threads, "-o", report, "--json"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        std::vector<CsvRow> rows = read_csv(report + "/fog.csv");
        const nlohmann::json tables = nlohmann::json::parse(outcome.out).at("tables");
        ASSERT_EQ(tables.at("fog").size(), rows.size());

        std::set<std::string> tolerances;
        double sh_error = 10;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const CsvRow& row = rows[i];
            const std::string& rung = row.at("rung");
            EXPECT_EQ(tables["fog"][i]["rung"], rung);
            EXPECT_GT(std::stod(row.at("time_ms")), 0);
            if (rung == "rings") continue;
            const double error = std::stod(row.at("max_relative_error"));
            const double rms = std::stod(row.at("rms_relative_error"));
            EXPECT_NEAR(tables["fog"][i]["max_relative_error"], error, 1e-5 * error);
            EXPECT_GT(error, 0) << rung;
            EXPECT_LE(rms, error) << rung;
            if (rung.rfind("split", 0) == 0) {
                EXPECT_LE(error, std::stod(row.at("tolerance"))) << rung;
                EXPECT_EQ(row.at("negative_pixels"), "0") << rung;
                tolerances.insert(row.at("tolerance"));
            } else if (rung.rfind("sh", 0) == 0) {
                // More bands help the average pixel, but beside a sun all of them ring.
                EXPECT_LT(rms, sh_error) << rung;
                EXPECT_GT(std::stoi(row.at("negative_pixels")), 0) << rung;
                sh_error = rms;
            } else {
                // The factored form is exact at T = 1 only, and the report is for T = 2.
                EXPECT_EQ(rung, "factored psf");
                EXPECT_GT(rms, 0.1);
            }
        }
        EXPECT_EQ(tolerances, (std::set<std::string>{"0.1", "0.01", "0.001", "0.0001", "1e-05"}));
        EXPECT_EQ(rows.back().at("rung"), "rings");
        // Four sizes, each twice as wide as the one before, at five tolerances.
        const std::vector<CsvRow> costs = read_csv(report + "/fog-size.csv");
        ASSERT_EQ(costs.size(), 20u);
        EXPECT_EQ(costs.back().at("width"), "1024");
        EXPECT_EQ(costs.back().at("height"), "512");

        for (CsvRow& row : rows) row.erase("time_ms");
        if (first.empty()) first = rows;
        EXPECT_EQ(rows, first);
        const std::string page = read_bytes(report + "/index.html");
        expect_self_contained(page);
        for (const std::string plot : {"fog.svg", "fog-size.svg"}) {
            const std::string svg = read_bytes(report + "/" + plot);
            EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
            EXPECT_NE(page.find(svg), std::string::npos) << plot;
        }
    }
}

TEST(Ladder, AirlightReportHasEveryMethodOnBothSets) {
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", "airlight", "-o", scratch.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    // As in the tests of medium/airlight_method.h, twice what was measured.
    const std::map<std::string, double> bounds = {
        {"sinh-gl8", 2e-3}, {"sinh-gl24", 8e-11}, {"e1", 5e-13}};
    std::map<std::string, std::set<std::string>> sets;
    for (const CsvRow& row : read_csv(scratch / "airlight.csv")) {
        sets[row.at("method")].insert(row.at("set"));
        EXPECT_GT(std::stod(row.at("ns_per_call")), 0);
        if (row.at("method") == "exact") continue;
        const double error = std::stod(row.at("max_relative_error"));
        EXPECT_GT(error, 0) << row.at("method");
        const auto bound = bounds.find(row.at("method"));
        if (bound != bounds.end()) {
            EXPECT_LE(error, bound->second) << bound->first;
        }
    }
    const std::string plot = read_bytes(scratch / "airlight.svg");
    for (const NamedMethod<AirlightMethod>& info : kAirlightMethods) {
        EXPECT_EQ(sets[std::string(info.name)], (std::set<std::string>{"A", "B"})) << info.name;
        EXPECT_NE(plot.find(">" + std::string(info.name) + "</text>"), std::string::npos);
    }
    expect_self_contained(read_bytes(scratch / "index.html"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "fog.csv"));
}

TEST(Ladder, ClosedFormsHaveARowForEveryMethodAndAnErrorForEveryApproximation) {
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", "slab", "atmosphere", "phase", "-o", scratch.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    // As on the sets of bench/, twice what was measured; no method is as good as the exact one.
    const std::map<std::string, std::map<std::string, double>> bounds = {
        {"slab", {{"thin", 2}, {"panels-gl8", 1e-6}, {"panels-gl12", 2e-10}}},
        {"atmosphere", {{"batch", 7e-5}, {"article", 7}}},
        {"phase", {{"gl8", 2e-2}, {"gl32", 2e-11}}}};
    for (const auto& [effect, methods] : bounds) {
        std::map<std::string, double> errors;
        for (const CsvRow& row : read_csv(scratch / (effect + ".csv"))) {
            EXPECT_GT(std::stod(row.at("ns_per_call")), 0);
            if (row.at("method") == "exact") {
                EXPECT_EQ(row.at("max_relative_error"), "");
                EXPECT_GT(std::stod(row.at("stated_bound")), 0);
                continue;
            }
            double& largest = errors[row.at("method")];
            largest = std::max(largest, std::stod(row.at("max_relative_error")));
        }
        for (const auto& [method, bound] : methods) {
            ASSERT_EQ(errors.count(method), 1u) << effect << ' ' << method;
            EXPECT_LE(errors[method], bound) << effect << ' ' << method;
        }
        for (const auto& [method, error] : errors) EXPECT_GT(error, 1e-13) << method;
        EXPECT_TRUE(std::filesystem::exists(scratch / (effect + ".svg")));
    }
    expect_self_contained(read_bytes(scratch / "index.html"));
}

using Bounds = std::map<std::string, double>;  // of the largest error of a method, by its name

// Bounds are twice what was measured; every row has a time, and an error or a stated bound.
void expect_sh_ladder(const std::string& effect, const std::string& time, const std::string& error,
                      const Bounds& bounds, const std::vector<std::string>& plots) {
    SCOPED_TRACE(effect);
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", effect, "-o", scratch.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    Bounds errors;
    for (const CsvRow& row : read_csv(scratch / (effect + ".csv"))) {
        EXPECT_GT(std::stod(row.at(time)), 0);
        if (!row.at("stated_bound").empty()) {
            EXPECT_GT(std::stod(row.at("stated_bound")), 0);
            EXPECT_EQ(row.at("max_" + error), "");
            continue;
        }
        double& largest = errors[row.at("method") + ' ' + row.at("set")];
        largest = std::max(largest, std::stod(row.at("max_" + error)));
        EXPECT_GT(largest, 0) << row.at("method");
        EXPECT_LE(std::stod(row.at("rms_" + error)), largest);
    }
    for (const auto& [method, bound] : bounds) {
        bool found = false;
        for (const auto& [name, largest] : errors) {
            if (name.rfind(method, 0) != 0) continue;
            found = true;
            EXPECT_LE(largest, bound) << name;
        }
        EXPECT_TRUE(found) << method;
    }
    const std::string page = read_bytes(scratch / "index.html");
    expect_self_contained(page);
    for (const std::string& plot : plots) {
        EXPECT_NE(page.find(read_bytes(scratch / (plot + ".svg"))), std::string::npos) << plot;
    }
}

TEST(Ladder, BasisRungsHoldTheirErrors) {
    expect_sh_ladder("sh-basis", "ns_per_direction", "error",
                     {{"batch-float", 2.1e-6}, {"batch-double", 5e-15}, {"evaluate-float", 1.2e-7}},
                     {"sh-basis"});
}

TEST(Ladder, RotationRungsHoldTheirErrors) {
    expect_sh_ladder("sh-rotation", "ns_per_vector", "error",
                     {{"vectors-float", 5e-7},
                      {"planes-float", 5e-7},
                      {"each-float", 5e-7},
                      {"vectors-double", 7e-15},
                      {"zonal-float", 1.2e-7}},
                     {"sh-rotation"});
}

TEST(Ladder, ProductRungsHoldTheirErrors) {
    expect_sh_ladder("sh-product", "ns_per_product", "error",
                     {{"sparse", 1.2e-7},
                      {"tree", 5e-7},
                      {"rows-planes", 5e-7},
                      {"rows-single", 5e-7},
                      {"grid", 1.5e-6},
                      {"rows-double", 2e-15}},
                     {"sh-product", "sh-product-single"});
    expect_sh_ladder("sh-triple", "ns_per_vertex", "error",
                     {{"matrix", 6e-8}, {"matrix-each", 6e-8}, {"product-dot", 6e-8}},
                     {"sh-triple"});
}

TEST(Ladder, GridsOfFunctionsConvergeAtTheirRates) {
    expect_sh_ladder("sh-function", "ns_per_vector", "error",
                     {{"grid-12 exp", 1e-2},
                      {"grid-24 exp", 4e-6},
                      {"grid-24 log", 3e-4},
                      {"grid-24 clamp", 2e-3}},
                     {"sh-function"});
}

TEST(Ladder, BandRungsHoldTheirErrors) {
    expect_sh_ladder(
        "sh-psf", "ns_per_call", "relative_error",
        {{"cubic16", 8.2e-4}, {"cubic32", 5e-5}, {"chebyshev20", 1e-6}, {"exact", 1.2e-7}},
        {"sh-psf"});
}

// Each rule of projection is right for what it is made for, and as wrong as another elsewhere.
TEST(Ladder, ProjectionRungsHoldTheirErrors) {
    expect_sh_ladder("sh-projection", "ns_per_pixel", "error",
                     {{"pixel-means samples", 1.1e-3},
                      {"centre-samples pixels", 1.3e-3},
                      {"centre-samples samples", 6e-9},
                      {"transform samples", 7e-8},
                      {"batches", 1.3e-3},
                      {"pixels", 1.3e-3}},
                     {"sh-projection", "sh-projection-samples"});
}

TEST(Ladder, TransformRungsHoldTheirErrors) {
    expect_sh_ladder("sh-transform", "ns_per_pixel", "error",
                     {{"double analysis", 2e-13}, {"single", 4e-6}},
                     {"sh-transform", "sh-transform-synthesis"});
}

TEST(Ladder, LeastChangesKeepTheirBoundAndTakeLess) {
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", "sh-window", "-o", scratch.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    std::map<std::string, std::map<std::string, double>> taken;
    for (const CsvRow& row : read_csv(scratch / "sh-window.csv")) {
        const std::string& method = row.at("method");
        const double least = std::stod(row.at("least_over_mean"));
        EXPECT_GT(std::stod(row.at("ms_per_call")), 0);
        taken[row.at("set")][method + row.at("bound")] = std::stod(row.at("norm_taken"));
        if (method == "none") {
            EXPECT_LT(least, -1);
        }
        if (!row.at("bound").empty()) {
            // Six digits are written.
            EXPECT_GE(least, std::stod(row.at("bound")) - 1e-6) << method;
        }
    }
    ASSERT_EQ(taken.size(), 3u);
    for (auto& [order, of] : taken) {
        EXPECT_EQ(of.at("none"), 0) << order;
        EXPECT_LT(of.at("lanczos"), of.at("hann")) << order;
        for (const std::string method : {"smoothing", "bands", "nearest"}) {
            EXPECT_LT(of.at(method + "-0.2"), of.at(method + "0")) << order << ' ' << method;
        }
        for (const std::string bound : {"-0.2", "0"}) {
            EXPECT_LT(of.at("nearest" + bound), of.at("bands" + bound)) << order;
            EXPECT_LT(of.at("bands" + bound), of.at("smoothing" + bound)) << order;
        }
    }
    expect_self_contained(read_bytes(scratch / "index.html"));
}

TEST(Ladder, BrdfRungsHoldTheirErrors) {
    expect_sh_ladder("brdf", "ns_per_lookup", "error", {{"nearest", 0.17}, {"linear", 6.2e-3}},
                     {"brdf"});
    expect_sh_ladder("brdf-fog", "ms_per_table", "error",
                     {{"bands order 16", 0.2}, {"bands order 64", 4e-3}}, {"brdf-fog"});
}

// Relative RMS errors of transfer and visibility at 1024 rays, a half more than measured.
TEST(Ladder, ChoicesOfDirectionsKeepTheirOrder) {
    const std::map<std::string, std::pair<double, double>> bounds = {
        {"fibonacci", {0.0067, 0.0135}},
        {"owen-sobol", {0.009, 0.017}},
        {"stratified", {0.0125, 0.0225}},
        {"random", {0.04, 0.092}}};
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", "transfer", "-o", scratch.path(), "--threads", "1"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    std::map<std::string, double> before;
    for (const CsvRow& row : read_csv(scratch / "transfer.csv")) {
        const std::string& method = row.at("method");
        const double transfer = std::stod(row.at("rms_transfer_error"));
        const double visibility = std::stod(row.at("rms_visibility_error"));
        EXPECT_GT(std::stod(row.at("us_per_vertex")), 0);
        EXPECT_GT(std::stod(row.at("max_transfer_error")), 0);
        // Four times the rays; of the adaptive method, a stricter tolerance.
        if (before.count(method)) {
            EXPECT_LT(transfer, before[method] / (method == "adaptive" ? 1 : 1.6)) << method;
        }
        before[method] = transfer;
        if (row.at("rays") == "1024") {
            EXPECT_LE(transfer, bounds.at(method).first) << method;
            EXPECT_LE(visibility, bounds.at(method).second) << method;
        }
    }
    for (const auto& [method, bound] : bounds) EXPECT_EQ(before.count(method), 1u) << method;
    EXPECT_LT(before["fibonacci"], before["owen-sobol"]);
    EXPECT_LT(before["owen-sobol"], before["stratified"]);
    EXPECT_LT(3 * before["stratified"], before["random"]);
    EXPECT_LT(before["adaptive"], 5e-4);
    for (const char* plot : {"transfer", "transfer-rays", "visibility", "visibility-rays"}) {
        EXPECT_EQ(read_bytes(scratch / (plot + std::string(".svg"))).rfind("<svg ", 0), 0u);
    }
    expect_self_contained(read_bytes(scratch / "index.html"));
}

// Figure 7 of [Sun05] has less than 4 % up to a thickness of 2.
TEST(Ladder, SingleScatteringIsFarFromAllOfIt) {
    const ScratchDirectory scratch;
    const Outcome outcome = run({"ladder", "multiple", "-o", scratch.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    std::map<std::string, std::map<double, double>> exact;  // by albedo and thickness
    int compared = 0;
    for (const CsvRow& row : read_csv(scratch / "multiple.csv")) {
        const double thickness = std::stod(row.at("optical_thickness"));
        const double error = std::stod(row.at("rms_relative_error"));
        EXPECT_LE(std::stod(row.at("rms_relative_error_scaled")), error);
        std::map<double, double>& of_albedo = exact[row.at("albedo")];
        if (row.at("paths_per_ray").empty()) {
            EXPECT_GE(error, of_albedo.empty() ? 0.05 : of_albedo.rbegin()->second) << thickness;
            of_albedo[thickness] = error;
        } else if (row.at("g") == "0") {
            // Two ways to the same; the mean of 22 noisy rays is nearer than one.
            EXPECT_NEAR(error, of_albedo.at(thickness), std::stod(row.at("noise"))) << thickness;
            ++compared;
        }
    }
    EXPECT_EQ(compared, 9);
    EXPECT_NEAR(exact["1"].at(2), 0.715, 1e-3);
    EXPECT_NEAR(exact["0.9"].at(2), 0.515, 1e-3);
    for (const char* plot : {"multiple", "multiple-shape"}) {
        EXPECT_EQ(read_bytes(scratch / (plot + std::string(".svg"))).rfind("<svg ", 0), 0u);
    }
    expect_self_contained(read_bytes(scratch / "index.html"));
}

TEST(Ladder, MistakesAndOldReportsAreRefusedBeforeAnythingIsMeasured) {
    const ScratchDirectory scratch;
    const std::string directory = scratch.path();
    expect_failure({"ladder", "fog"}, 2, "the output is missing: give -o DIR");
    expect_failure({"ladder", "clouds", "-o", directory}, 2,
                   "unknown effect 'clouds'; it can be fog, airlight, ");
    for (const char* size : {"512", "512x512", "16x8", "4096x2048", "512x256x3", "0x0"}) {
        expect_failure({"ladder", "-o", directory, "--size", size}, 2, "--size: ");
    }
    expect_failure({"ladder", "-o", directory, "--optical-thickness", "0"}, 2,
                   "--optical-thickness: '0' is not a number in (0, 50]");
    expect_failure({"ladder", "-o", directory + "/missing/report"}, 1,
                   "cannot be made a directory");

    const std::string old = directory + "/fog.svg";
    write_bytes(old, "old");
    expect_failure({"ladder", "-o", directory}, 1, old);
    expect_failure({"ladder", "-o", old}, 1, "cannot be made a directory");
    EXPECT_EQ(read_bytes(old), "old");
    EXPECT_FALSE(std::filesystem::exists(directory + "/index.html"));
}

}  // namespace
}  // namespace airlight
