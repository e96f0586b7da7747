// SPDX-License-Identifier: Apache-2.0
// What windows take away against the ringing that they leave.
#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <utility>

#include "cli/ladder_map.h"
#include "cli/ladder_sh.h"
#include "core/threads.h"
#include "sh/dering.h"
#include "sh/index.h"
#include "sh/project.h"
#include "sh/window.h"

namespace airlight {
namespace {

constexpr int kOrders[] = {3, 6, 9};
// Where functions that are nowhere below zero are drawn.
constexpr double kNoUndershoot = 1e-4;

using Change = void (*)(int order, double least, std::vector<double>& coefficients);

void take_nothing(int, double, std::vector<double>&) {}

void take_hann(int order, double, std::vector<double>& coefficients) {
    apply_window(hann_window(order), 1, coefficients.data());
}

void take_lanczos(int order, double, std::vector<double>& coefficients) {
    apply_window(lanczos_window(order), 1, coefficients.data());
}

template <DeringMethod kMethod>
void take_least(int order, double least, std::vector<double>& coefficients) {
    coefficients = dering(kMethod, order, 1, coefficients.data(), least);
}

struct Method {
    const char* name;
    const char* colour;
    Change change;
    bool bounded;  ///< whether it keeps a bound that is asked for
};

const Method kMethods[] = {
    {"none", kPlotColours[5], take_nothing, false},
    {"hann", kPlotColours[3], take_hann, false},
    {"lanczos", kPlotColours[4], take_lanczos, false},
    {"smoothing", kPlotColours[1], take_least<DeringMethod::smoothing>, true},
    {"bands", kPlotColours[0], take_least<DeringMethod::bands>, true},
    {"nearest", kPlotColours[2], take_least<DeringMethod::nearest>, true}};

struct Rung {
    const Method* method;
    int order;
    double bound;  ///< asked for, over the mean
    double nanoseconds = 0;
    double taken = 0;  ///< norm of the difference over the norm without the mean
    double least = 0;  ///< over the mean
};

std::vector<double> light(int order) {
    const Image map = sun_and_sky(512, 256);
    std::vector<double> all = project_latlong(map.pixels.data(), map.height, map.width,
                                              static_cast<int>(map.channels), order);
    all.resize(sh_count(order));
    return all;
}

void measure(Rung& rung) {
    const ThreadLimit one(1);
    const std::vector<double> before = light(rung.order);
    std::vector<double> after;
    rung.nanoseconds = nanoseconds_each(1, [&] {
        after = before;
        rung.method->change(rung.order, rung.bound, after);
    });
    double taken = 0, all = 0;
    for (std::size_t k = 1; k < before.size(); ++k) {
        taken += (after[k] - before[k]) * (after[k] - before[k]);
        all += before[k] * before[k];
    }
    rung.taken = std::sqrt(taken / all);
    rung.least = least_value(rung.order, after.data()) * std::sqrt(4 * kPi) / after[0];
}

Plot make_plot(const std::vector<Rung>& rungs) {
    Plot plot;
    plot.title = "Windows: what they take away against the ringing they leave";
    plot.subtitle = "sky with a one-pixel sun; labels are orders; down and left is better";
    plot.x.label = "norm taken away over the norm without the mean";
    plot.y.label = "depth below zero over the mean";
    for (const Method& method : kMethods) {
        PlotSeries series = {method.name, method.colour, false, {}};
        for (const Rung& rung : rungs) {
            if (rung.method != &method) continue;
            const bool none = -rung.least < kNoUndershoot;
            series.points.push_back(
                {rung.taken, none ? kNoUndershoot : -rung.least, std::to_string(rung.order), none});
        }
        // On a logarithmic axis there is no place for nothing.
        if (method.change != take_nothing) plot.series.push_back(std::move(series));
    }
    return plot;
}

Table make_table(const std::vector<Rung>& rungs) {
    Table table;
    table.columns = {{"method", "method"},
                     {"set", "set"},
                     {"ms_per_call", "time per call [ms]"},
                     {"bound", "bound asked for, over the mean"},
                     {"norm_taken", "norm taken away over the norm without the mean"},
                     {"least_over_mean", "least value over the mean"}};
    for (const Rung& rung : rungs) {
        table.rows.push_back(
            {std::string(rung.method->name), order_name(rung.order), 1e-6 * rung.nanoseconds,
             rung.method->bounded ? TableCell(rung.bound) : TableCell(), rung.taken, rung.least});
    }
    return table;
}

}  // namespace

LadderWork plan_sh_window_ladder() {
    const auto rungs = std::make_shared<std::vector<Rung>>();
    LadderWork work;
    work.files = {"sh-window.csv", "sh-window.svg"};
    for (const Method& method : kMethods) {
        for (const int order : kOrders) {
            for (const double bound : {-0.2, 0.0}) {
                if (!method.bounded && bound != 0) continue;
                const std::size_t i = rungs->size();
                rungs->push_back({&method, order, bound});
                work.steps.push_back({200, [rungs, i] { measure((*rungs)[i]); }});
            }
        }
    }
    work.finish = [rungs] {
        LadderFigure figure;
        figure.name = "sh-window";
        figure.text = fmt::format(
            "<p>The red channel of the sky with a one-pixel sun that the ladder of fog has, cut "
            "off after a few degrees, rings "
            "below zero. Windows multiply its degrees by factors that quieten it: Hann's and "
            "Lanczos' are fixed, <code>smoothing</code> is the weakest of its family that keeps "
            "the least value above a bound, here −0.2 and 0 of the mean, and <code>bands</code> "
            "the window of the least change that does. <code>nearest</code> changes single "
            "coefficients. What is taken away is the norm of the change over the norm of all "
            "degrees but the first, the mean, which nothing here moves; functions that stay above "
            "−{} of the mean are drawn there, hollow. <code>none</code> takes nothing and is in "
            "the table alone.</p>",
            kNoUndershoot);
        figure.plot = make_plot(*rungs);
        figure.table = make_table(*rungs);
        LadderEffect effect;
        effect.name = figure.name;
        effect.title = "Windows against ringing";
        effect.figures = {std::move(figure)};
        return effect;
    };
    return work;
}

}  // namespace airlight
