// SPDX-License-Identifier: Apache-2.0
#include "cli/ladder_closed_forms.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

namespace airlight {
namespace {

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

std::vector<PlotSeries> family_series() {
    std::vector<PlotSeries> series;
    for (const Family& family : kFamilies) {
        series.push_back({family.label, family.colour, family.joined, {}});
    }
    series.push_back({"exact (its bound)", kPlotColours[2], false, {}});
    return series;
}

/// A set with its values by the first method, which the first rung measured makes.
struct MeasuredSet {
    std::vector<EvalArguments> inputs;
    std::vector<double> exact;
};

RungResult measure(const EvalFunction& function, std::size_t method, MeasuredSet& set) {
    if (set.exact.empty()) set.exact = values_of(function, 0, set.inputs);
    const std::vector<double> values = values_of(function, method, set.inputs);
    LadderErrors errors;
    for (std::size_t i = 0; i < values.size(); ++i) {
        errors.add(error_of(function, set.inputs[i], values[i], set.exact[i]));
    }
    const Evaluator evaluator =
        function.make(function.methods[method], EvalPrecision::double_precision);
    std::vector<double> sink(set.inputs.size());
    const double seconds = fastest_seconds(
        3, TimeKind::cpu, [&] { evaluator(set.inputs, sink); }, kRungWindow);
    return {1e9 * seconds / static_cast<double>(set.inputs.size()), errors.largest(), errors.rms()};
}

}  // namespace

RungLadder closed_form_rungs(const ClosedFormLadder& ladder) {
    RungLadder rungs;
    rungs.effect = ladder.effect;
    rungs.title = ladder.title;
    rungs.text = ladder.text;
    rungs.error = "relative error";
    rungs.error_key = "relative_error";
    const EvalFunction& function = function_of(ladder);
    for (ClosedFormSet& set : ladder.sets()) {
        RungFigure figure;
        figure.file = set.file;
        figure.title = ladder.title;
        figure.subtitle = set.subtitle;
        figure.series = family_series();
        const auto measured = std::make_shared<MeasuredSet>();
        measured->inputs = std::move(set.inputs);
        for (std::size_t method = 0; method < function.methods.size(); ++method) {
            const std::string& name = function.methods[method];
            LadderRung rung;
            rung.method = rung.label = name;
            rung.set = set.label;
            rung.series = method == 0 ? figure.series.size() - 1 : family_of(name);
            rung.bound = method == 0 ? ladder.exact_bound : 0;
            rung.measure = [&function, method, measured] {
                return measure(function, method, *measured);
            };
            figure.rungs.push_back(std::move(rung));
        }
        rungs.figures.push_back(std::move(figure));
    }
    return rungs;
}

}  // namespace airlight
