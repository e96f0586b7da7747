// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>

#include "cli/ladder_effects.h"
#include "medium/airlight_method.h"
#include "medium/airlight_sets.h"

namespace airlight {
namespace {

constexpr int kRays = 20000;
constexpr char kSets[] = {'A', 'B'};
// Of medium/airlight.h, which the others are measured against.
constexpr double kExactBound = 1e-13;

struct Rung {
    AirlightMethodInfo info;
    char set;
    double nanoseconds = 0;
    RelativeErrors errors;
};

void measure_rung(Rung& rung) {
    const std::vector<AirlightCase> cases = airlight_set(rung.set, kRays);
    AirlightOptions options;
    options.method = rung.info.method;
    const AirlightEvaluator evaluator(options);
    rung.errors = airlight_errors(cases, evaluator);
    // The sum keeps the calls from being left out.
    volatile double sink = 0;
    const double seconds = fastest_seconds(5, TimeKind::cpu, [&] {
        double sum = 0;
        for (const AirlightCase& c : cases) sum += evaluator(c.gamma, c.t_sv, c.t_vp);
        sink = sum;
    });
    rung.nanoseconds = 1e9 * seconds / kRays;
}

std::size_t series_of(AirlightMethod method) {
    switch (method) {
        case AirlightMethod::f_table_nearest:
        case AirlightMethod::f_table_bilinear:
        case AirlightMethod::warped_table:
            return 0;
        case AirlightMethod::march64:
            return 1;
        case AirlightMethod::e1:
            return 3;
        case AirlightMethod::exact:
            return 4;
        default:
            return 2;
    }
}

Table make_table(const std::vector<Rung>& rungs) {
    Table table;
    table.columns = {{"method", "method"},
                     {"set", "set"},
                     {"ns_per_call", "time per call [ns]"},
                     {"max_relative_error", "largest relative error"},
                     {"rms_relative_error", "RMS relative error"},
                     {"stated_bound", "stated bound"}};
    for (const Rung& rung : rungs) {
        std::vector<TableCell> row = {std::string(rung.info.name), std::string(1, rung.set),
                                      rung.nanoseconds};
        row.resize(table.columns.size());
        if (rung.info.method == AirlightMethod::exact) {
            row[5] = kExactBound;
        } else {
            row[3] = rung.errors.max;
            row[4] = rung.errors.rms;
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

// Dots at the largest error; the bars of points end at the root mean square.
Plot make_plot(const std::vector<Rung>& rungs, char set) {
    Plot plot;
    plot.title = fmt::format("Airlight of a point light, set {}: error against time", set);
    plot.subtitle = set == 'A'
                        ? "optical thicknesses below 2, angles 0.02 … 2.5; down and left is better"
                        : "optical thicknesses below 10, angles 0 … π; down and left is better";
    plot.x.label = "CPU time per call [ns]";
    plot.y.label = "relative error: largest (dot), RMS (bar end)";
    plot.series = {{"tables, 64²", kPlotColours[3], false, {}},
                   {"ray march", kPlotColours[1], false, {}},
                   {"sinh–Gauss–Legendre", kPlotColours[0], true, {}},
                   {"closed form", kPlotColours[4], false, {}},
                   {"exact (its stated bound)", kPlotColours[2], false, {}}};
    for (const Rung& rung : rungs) {
        if (rung.set != set) continue;
        const bool truth = rung.info.method == AirlightMethod::exact;
        plot.series[series_of(rung.info.method)].points.push_back(
            {rung.nanoseconds, truth ? kExactBound : rung.errors.max, std::string(rung.info.name),
             truth, truth ? 0 : rung.errors.rms});
    }
    return plot;
}

}  // namespace

double fastest_seconds(int least, TimeKind kind, const std::function<void()>& run) {
    const auto now = [](clockid_t clock) {
        timespec time = {};
        clock_gettime(clock, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const clockid_t clock = kind == TimeKind::cpu ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
    const double start = now(CLOCK_MONOTONIC);
    double fastest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < least || now(CLOCK_MONOTONIC) - start < 0.12; ++i) {
        const double before = now(clock);
        run();
        fastest = std::min(fastest, now(clock) - before);
    }
    return fastest;
}

LadderWork plan_airlight_ladder(const LadderOptions&) {
    const auto rungs = std::make_shared<std::vector<Rung>>();
    LadderWork work;
    work.files = {"airlight.csv", "airlight.svg", "airlight-b.svg"};
    for (const AirlightMethodInfo& info : kAirlightMethods) {
        for (const char set : kSets) {
            const std::size_t i = rungs->size();
            rungs->push_back({info, set, 0, {}});
            work.steps.push_back({130, [rungs, i] { measure_rung((*rungs)[i]); }});
        }
    }
    work.finish = [rungs] {
        LadderEffect effect;
        effect.name = "airlight";
        effect.title = "Airlight of a point light";
        const std::string text = fmt::format(
            "<p>Two sets of {} uniform random rays, always the same. <b>A</b> is thin: optical "
            "thicknesses from viewer to light and along the ray below 2, angles 0.02 … 2.5. "
            "<b>B</b>: thicknesses below 10, angles 0 … π. Dots are the largest relative error, "
            "bars "
            "lead down to the root mean square. Errors are relative to the method "
            "<code>exact</code>, whose own error the tests measure against 40 digits and find "
            "below 1e-13. CPU time is per call in double, without building the tables.</p>",
            kRays);
        effect.figures = {{"airlight", text, make_plot(*rungs, 'A'), make_table(*rungs)},
                          {"airlight-b", "", make_plot(*rungs, 'B'), {}}};
        return effect;
    };
    return work;
}

}  // namespace airlight
