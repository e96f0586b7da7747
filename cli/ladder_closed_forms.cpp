// SPDX-License-Identifier: Apache-2.0
#include "cli/ladder_closed_forms.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "cli/ladder_effects.h"
#include "core/threads.h"

namespace airlight {
namespace {

struct Rung {
    std::size_t method;
    std::size_t set;
    double nanoseconds = 0;
    double max_error = 0;
    double rms_error = 0;
};

/// All of a ladder's state between its steps.
struct Measurement {
    const EvalFunction* function = nullptr;
    std::vector<ClosedFormSet> sets;
    std::vector<std::vector<double>> exact;  ///< of each set
    std::vector<Rung> rungs;
};

const EvalFunction& function_of(const ClosedFormLadder& ladder) {
    const std::vector<EvalFunction>& all = eval_functions();
    const auto found = std::find_if(all.begin(), all.end(), [&](const EvalFunction& function) {
        return function.name == ladder.function;
    });
    assert(found != all.end());
    return *found;
}

std::vector<double> values_of(const EvalFunction& function, std::size_t method,
                              const std::vector<EvalArguments>& inputs) {
    std::vector<double> values(inputs.size());
    function.make(function.methods[method], EvalPrecision::double_precision)(inputs, values);
    return values;
}

double error_of(const EvalFunction& function, const EvalArguments& arguments, double value,
                double exact) {
    if (value == exact) return 0;
    if (function.logarithm) return std::abs(value - exact) / std::max(1.0, std::abs(exact));
    if (function.forward) {
        value = function.forward(arguments, value);
        exact = function.forward(arguments, exact);
    }
    return std::abs(value / exact - 1);
}

void measure_rung(Measurement& measurement, Rung& rung) {
    const EvalFunction& function = *measurement.function;
    const std::vector<EvalArguments>& inputs = measurement.sets[rung.set].inputs;
    const ThreadLimit one(1);
    std::vector<double>& exact = measurement.exact[rung.set];
    if (exact.empty()) exact = values_of(function, 0, inputs);
    const std::vector<double> values = values_of(function, rung.method, inputs);
    double squares = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double error = error_of(function, inputs[i], values[i], exact[i]);
        // A NaN must not pass for a small error.
        if (!(error <= rung.max_error)) rung.max_error = error;
        squares += error * error;
    }
    rung.rms_error = std::sqrt(squares / static_cast<double>(values.size()));
    const Evaluator evaluator =
        function.make(function.methods[rung.method], EvalPrecision::double_precision);
    std::vector<double> sink(inputs.size());
    const double seconds = fastest_seconds(5, TimeKind::cpu, [&] { evaluator(inputs, sink); });
    rung.nanoseconds = 1e9 * seconds / static_cast<double>(inputs.size());
}

struct Family {
    const char* part;  ///< of the methods' names
    const char* label;
    const char* colour;
    bool joined;
};

// The first whose part occurs in a method's name has it; the last has the rest.
const Family kFamilies[] = {{"batch", "SIMD, float", kPlotColours[5], false},
                            {"table", "tables", kPlotColours[3], false},
                            {"march", "ray march", kPlotColours[1], false},
                            {"gl", "Gauss–Legendre", kPlotColours[0], true},
                            {"", "closed forms", kPlotColours[4], false}};

std::size_t family_of(const std::string& method) {
    for (std::size_t i = 0;; ++i) {
        if (method.find(kFamilies[i].part) != std::string::npos) return i;
    }
}

Table make_table(const ClosedFormLadder& ladder, const Measurement& measurement) {
    Table table;
    table.columns = {{"method", "method"},
                     {"set", "set"},
                     {"ns_per_call", "time per call [ns]"},
                     {"max_relative_error", "largest relative error"},
                     {"rms_relative_error", "RMS relative error"},
                     {"stated_bound", "stated bound"}};
    for (const Rung& rung : measurement.rungs) {
        std::vector<TableCell> row = {measurement.function->methods[rung.method],
                                      measurement.sets[rung.set].label, rung.nanoseconds};
        row.resize(table.columns.size());
        if (rung.method == 0) {
            row[5] = ladder.exact_bound;
        } else {
            row[3] = rung.max_error;
            row[4] = rung.rms_error;
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

// Dots at the largest error; the bars of points end at the root mean square.
Plot make_plot(const ClosedFormLadder& ladder, const Measurement& measurement, std::size_t set) {
    Plot plot;
    plot.title = ladder.title + ": error against time";
    plot.subtitle = measurement.sets[set].subtitle + "; down and left is better";
    plot.x.label = "CPU time per call [ns]";
    plot.y.label = "relative error: largest (dot), RMS (bar end)";
    for (const Family& family : kFamilies) {
        plot.series.push_back({family.label, family.colour, family.joined, {}});
    }
    plot.series.push_back({"exact (its bound)", kPlotColours[2], false, {}});
    for (const Rung& rung : measurement.rungs) {
        if (rung.set != set) continue;
        const std::string& method = measurement.function->methods[rung.method];
        const bool truth = rung.method == 0;
        const std::size_t series = truth ? plot.series.size() - 1 : family_of(method);
        plot.series[series].points.push_back({rung.nanoseconds,
                                              truth ? ladder.exact_bound : rung.max_error, method,
                                              truth, truth ? 0 : rung.rms_error});
    }
    plot.series.erase(std::remove_if(plot.series.begin(), plot.series.end(),
                                     [](const auto& series) { return series.points.empty(); }),
                      plot.series.end());
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

LadderWork plan_closed_form_ladder(const ClosedFormLadder& ladder) {
    const auto measurement = std::make_shared<Measurement>();
    measurement->function = &function_of(ladder);
    measurement->sets = ladder.sets();
    measurement->exact.resize(measurement->sets.size());
    LadderWork work;
    work.files = {ladder.effect + ".csv"};
    for (const ClosedFormSet& set : measurement->sets) work.files.push_back(set.file + ".svg");
    for (std::size_t method = 0; method < measurement->function->methods.size(); ++method) {
        for (std::size_t set = 0; set < measurement->sets.size(); ++set) {
            const std::size_t i = measurement->rungs.size();
            measurement->rungs.push_back({method, set});
            work.steps.push_back(
                {130, [measurement, i] { measure_rung(*measurement, measurement->rungs[i]); }});
        }
    }
    work.finish = [&ladder, measurement] {
        LadderEffect effect;
        effect.name = ladder.effect;
        effect.title = ladder.title;
        for (std::size_t set = 0; set < measurement->sets.size(); ++set) {
            effect.figures.push_back({measurement->sets[set].file, set == 0 ? ladder.text : "",
                                      make_plot(ladder, *measurement, set),
                                      set == 0 ? make_table(ladder, *measurement) : Table()});
        }
        return effect;
    };
    return work;
}

}  // namespace airlight
