// SPDX-License-Identifier: Apache-2.0
// What the directions of a bake cost: error of visibility and of transfer, rays and time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "cli/ladder_effects.h"
#include "cli/ladder_rungs.h"
#include "cli/ladder_sphere.h"
#include "core/threads.h"
#include "prt/bake.h"
#include "prt/morton.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr int kOrder = 6, kTruthRays = 65536, kLongestRun = 16384, kRounds = 2;
constexpr std::size_t kVertices = 256, kNeighbours = 32;

struct Rows {
    std::vector<float> visibility, transfer;
    BakeReport report;
};

struct Rung {
    std::size_t method;  ///< in kBakeMethods
    BakeOptions options;
    double nanoseconds = 0;                        ///< per vertex
    double rays = 0;                               ///< per vertex
    std::array<double, 2> rms = {}, largest = {};  ///< errors of visibility, of transfer
};

struct Measurement {
    std::vector<Rung> rungs;
    Mesh mesh;
    std::unique_ptr<RayScene> scene;
    std::vector<std::uint32_t> vertices;
    Rows truth;
    std::array<double, 2> open = {};  ///< norms of the rows of an open vertex
};

// Rungs of the same method lie on a line.
std::vector<Rung> plan_rungs() {
    std::vector<Rung> rungs;
    for (std::size_t m = 0; m < std::size(kBakeMethods); ++m) {
        if (kBakeMethods[m].method == BakeMethod::adaptive) {
            // Below that the truth is not exact enough.
            for (const double tolerance : {1e-2, 5e-3, 2e-3, 1e-3}) {
                BakeOptions options;
                options.order = kOrder;
                options.method = BakeMethod::adaptive;
                options.rays = kAdaptiveBakeRays;
                options.tolerance = tolerance;
                rungs.push_back({m, options});
            }
            continue;
        }
        for (const int rays : {64, 256, 1024, 4096, kLongestRun}) {
            BakeOptions options;
            options.order = kOrder;
            options.method = kBakeMethods[m].method;
            options.rays = rays;
            rungs.push_back({m, options});
        }
    }
    return rungs;
}

Rows bake(const Measurement& m, const BakeOptions& options) {
    Rows rows;
    rows.visibility.resize(m.vertices.size() * sh_count(options.order));
    rows.transfer.resize(rows.visibility.size());
    BakeRows out;
    out.visibility = rows.visibility.data();
    out.transfer = rows.transfer.data();
    rows.report =
        bake_vertices(m.mesh, *m.scene, options, m.vertices.data(), m.vertices.size(), out);
    return rows;
}

double square(double x) {
    return x * x;
}

void prepare(Measurement& m) {
    m.mesh = bumpy_sphere(72, 0.09);
    m.scene = std::make_unique<RayScene>(m.mesh);
    // Runs of neighbours, as a whole bake has them, spread over the mesh.
    const std::vector<std::uint32_t> order = morton_order(m.mesh);
    const std::size_t step = order.size() / (kVertices / kNeighbours);
    for (std::size_t k = 0; k < kVertices; ++k) {
        m.vertices.push_back(order[k / kNeighbours * step + k % kNeighbours]);
    }
    BakeOptions options;
    options.order = kOrder;
    options.rays = kTruthRays;
    m.truth = bake(m, options);

    const Mesh point = {{{0, 0, 0}}, {{0, 0, 1}}, {}};
    const Bake alone = bake_mesh(point, RayScene(point), {kOrder, 1});
    for (const float value : alone.visibility) m.open[0] += square(value);
    for (const float value : alone.transfer) m.open[1] += square(value);
    for (double& norm : m.open) norm = std::sqrt(norm);
}

void measure(Measurement& m, Rung& rung) {
    const ThreadLimit one(1);
    if (!m.scene) prepare(m);
    Rows rows;
    const double nanoseconds = nanoseconds_each(static_cast<double>(m.vertices.size()),
                                                [&] { rows = bake(m, rung.options); });
    rung.nanoseconds = rung.nanoseconds > 0 ? std::min(rung.nanoseconds, nanoseconds) : nanoseconds;
    rung.rays = static_cast<double>(rows.report.rays) / static_cast<double>(m.vertices.size());
    const std::size_t size = sh_count(kOrder);
    for (std::size_t kind = 0; kind < 2; ++kind) {
        const std::vector<float>& values = kind == 0 ? rows.visibility : rows.transfer;
        const std::vector<float>& exact = kind == 0 ? m.truth.visibility : m.truth.transfer;
        double errors = 0, all = 0, largest = 0;
        for (std::size_t begin = 0; begin < exact.size(); begin += size) {
            double error = 0;
            for (std::size_t i = begin; i < begin + size; ++i) {
                error += square(double(values[i]) - exact[i]);
                all += square(exact[i]);
            }
            errors += error;
            largest = std::max(largest, std::sqrt(error));
        }
        rung.rms[kind] = std::sqrt(errors / all);
        rung.largest[kind] = largest / m.open[kind];
    }
}

const char* const kKinds[] = {"visibility", "transfer"};

Plot make_plot(const Measurement& m, std::size_t kind, bool against_rays) {
    Plot plot;
    plot.title =
        fmt::format("Baked {}: error against {}", kKinds[kind], against_rays ? "rays" : "time");
    plot.subtitle =
        fmt::format("order {}, pitted sphere, {:.0f} % of the rays are blocked{}", kOrder,
                    100.0 * static_cast<double>(m.truth.report.blocked) /
                        static_cast<double>(m.truth.report.rays),
                    against_rays ? "" : "; labels are rays of a vertex");
    plot.x.label = against_rays ? "rays of a vertex" : "CPU time of a vertex [µs]";
    plot.y.label = "relative RMS error over the vertices";
    for (std::size_t i = 0; i < std::size(kBakeMethods); ++i) {
        PlotSeries series = {std::string(kBakeMethods[i].name), kPlotColours[i], true, {}};
        for (const Rung& rung : m.rungs) {
            if (rung.method != i) continue;
            series.points.push_back(
                {against_rays ? rung.rays : 1e-3 * rung.nanoseconds, rung.rms[kind],
                 against_rays ? std::string() : fmt::format("{:.0f}", rung.rays)});
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

Table make_table(const Measurement& m) {
    Table table;
    table.columns = {
        {"method", "method"},
        {"rays", "rays of a vertex"},
        {"us_per_vertex", "time per vertex [µs]"},
        {"rms_transfer_error", "relative RMS error of transfer"},
        {"max_transfer_error", "largest error of transfer over the open vertex's"},
        {"rms_visibility_error", "relative RMS error of visibility"},
        {"max_visibility_error", "largest error of visibility over the open vertex's"}};
    for (const Rung& rung : m.rungs) {
        table.rows.push_back({std::string(kBakeMethods[rung.method].name), rung.rays,
                              1e-3 * rung.nanoseconds, rung.rms[1], rung.largest[1], rung.rms[0],
                              rung.largest[0]});
    }
    return table;
}

LadderEffect make_effect(const Measurement& m) {
    LadderEffect effect;
    effect.name = "transfer";
    effect.title = "Visibility and transfer of a mesh";
    for (const std::size_t kind : {std::size_t{1}, std::size_t{0}}) {
        for (const bool against_rays : {false, true}) {
            LadderFigure figure;
            figure.name = kKinds[kind] + std::string(against_rays ? "-rays" : "");
            figure.plot = make_plot(m, kind, against_rays);
            effect.figures.push_back(std::move(figure));
        }
    }
    effect.figures[0].text = fmt::format(
        "<p>Order {} of {} vertices of a sphere with hollows, {} triangles, by the directions of "
        "<code>airlight bake --method</code>, against {} Fibonacci points. Relative RMS errors are "
        "those of all rows together over the rows themselves; the largest of a vertex, in the "
        "table, is over the norm of the row of a vertex that sees everything. Only blocked "
        "directions are summed and taken off the row of the open hemisphere, which is exact, so "
        "that even random directions do better than their number says. Points of Fibonacci's are "
        "made once for all vertices, others for each, and their time counts.</p>",
        kOrder, kVertices, m.mesh.triangles.size(), kTruthRays);
    effect.figures[0].table = make_table(m);
    return effect;
}

}  // namespace

LadderWork plan_transfer_ladder() {
    const auto measurement = std::make_shared<Measurement>();
    measurement->rungs = plan_rungs();
    LadderWork work;
    work.files = {"transfer.csv", "transfer.svg", "transfer-rays.svg", "visibility.svg",
                  "visibility-rays.svg"};
    // In turns, so that what else the machine does for a while meets no rung alone.
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < measurement->rungs.size(); ++i) {
            const int rays = measurement->rungs[i].options.rays;
            // One run of the longest has to do.
            if (round > 0 && rays == kLongestRun) continue;
            work.steps.push_back({static_cast<std::uint64_t>(100 + rays / 16), [measurement, i] {
                                      measure(*measurement, measurement->rungs[i]);
                                  }});
        }
    }
    work.finish = [measurement] { return make_effect(*measurement); };
    return work;
}

}  // namespace airlight
