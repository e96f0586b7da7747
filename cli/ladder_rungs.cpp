// SPDX-License-Identifier: Apache-2.0
#include "cli/ladder_rungs.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "core/threads.h"

namespace airlight {
namespace {

constexpr int kRounds = 2;

struct Measurement {
    RungLadder ladder;
    std::vector<std::vector<RungResult>> results;  ///< of each figure's rungs
};

std::string unit_of(const RungLadder& ladder) {
    return ladder.milliseconds ? "ms" : "ns";
}

double time_of(const RungLadder& ladder, const RungResult& result) {
    return (ladder.milliseconds ? 1e-6 : 1) * result.nanoseconds;
}

Table make_table(const Measurement& measurement) {
    const RungLadder& ladder = measurement.ladder;
    Table table;
    table.columns = {{"method", "method"},
                     {"set", "set"},
                     {unit_of(ladder) + "_per_" + ladder.result,
                      "time per " + ladder.result + " [" + unit_of(ladder) + "]"},
                     {"max_" + ladder.error_key, "largest " + ladder.error},
                     {"rms_" + ladder.error_key, "RMS " + ladder.error},
                     {"stated_bound", "stated bound"}};
    for (std::size_t f = 0; f < ladder.figures.size(); ++f) {
        for (std::size_t i = 0; i < ladder.figures[f].rungs.size(); ++i) {
            const LadderRung& rung = ladder.figures[f].rungs[i];
            const RungResult& result = measurement.results[f][i];
            std::vector<TableCell> row = {rung.method, rung.set, time_of(ladder, result)};
            row.resize(table.columns.size());
            if (rung.bound > 0) {
                row[5] = rung.bound;
            } else {
                row[3] = result.max_error;
                row[4] = result.rms_error;
            }
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

// Dots at the largest error; the bars of points end at the root mean square.
Plot make_plot(const RungLadder& ladder, const RungFigure& figure,
               const std::vector<RungResult>& results) {
    Plot plot;
    plot.title = figure.title + ": error against time";
    plot.subtitle = figure.subtitle + "; down and left is better";
    plot.x.label = "CPU time per " + ladder.result + " [" + unit_of(ladder) + "]";
    plot.y.label = ladder.error + ": largest (dot), RMS (bar end)";
    plot.series = figure.series;
    for (std::size_t i = 0; i < figure.rungs.size(); ++i) {
        const LadderRung& rung = figure.rungs[i];
        const bool truth = rung.bound > 0;
        plot.series[rung.series].points.push_back(
            {time_of(ladder, results[i]), truth ? rung.bound : results[i].max_error, rung.label,
             truth, truth ? 0 : results[i].rms_error});
    }
    plot.series.erase(std::remove_if(plot.series.begin(), plot.series.end(),
                                     [](const auto& series) { return series.points.empty(); }),
                      plot.series.end());
    return plot;
}

double seconds_of(clockid_t clock) {
    timespec time = {};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

double fastest_seconds(int least, TimeKind kind, const std::function<void()>& run, double window) {
    const double start = seconds_of(CLOCK_MONOTONIC);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double fastest = kNever, fastest_alone = kNever;
    for (int i = 0; i < least || seconds_of(CLOCK_MONOTONIC) - start < window; ++i) {
        const double wall_before = seconds_of(CLOCK_MONOTONIC);
        const double cpu_before = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
        run();
        const double cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_before;
        const double wall = seconds_of(CLOCK_MONOTONIC) - wall_before;
        fastest = std::min(fastest, kind == TimeKind::cpu ? cpu : wall);
        // A virtual machine may take time that others stole off a later run, which then looks
        // faster than it was. Runs that had the processor to themselves are free of that.
        if (kind == TimeKind::cpu && cpu > 0.9 * wall) {
            fastest_alone = std::min(fastest_alone, cpu);
        }
    }
    return fastest_alone < kNever ? fastest_alone : fastest;
}

double nanoseconds_each(double results, const std::function<void()>& run) {
    // Reading the clock takes some 0.3 us.
    constexpr double kLeastSeconds = 1e-4, kLongSeconds = 0.05;
    const auto timed = [&] {
        const double before = seconds_of(CLOCK_MONOTONIC);
        run();
        return seconds_of(CLOCK_MONOTONIC) - before;
    };
    double once = timed();
    // The first run also fetches everything into the caches.
    if (once < kLongSeconds) once = timed();
    const int repeats =
        once < kLeastSeconds ? static_cast<int>(kLeastSeconds / std::max(once, 1e-8)) : 1;
    const double seconds = fastest_seconds(
        1, TimeKind::cpu,
        [&] {
            for (int i = 0; i < repeats; ++i) run();
        },
        kRungWindow);
    return 1e9 * seconds / (repeats * results);
}

LadderWork plan_rung_ladder(RungLadder ladder) {
    const auto measurement = std::make_shared<Measurement>();
    measurement->ladder = std::move(ladder);
    const RungLadder& planned = measurement->ladder;
    LadderWork work;
    work.files = {planned.effect + ".csv"};
    for (std::size_t f = 0; f < planned.figures.size(); ++f) {
        const RungFigure& figure = planned.figures[f];
        work.files.push_back(figure.file + ".svg");
        measurement->results.emplace_back(figure.rungs.size());
        // In turns, so that what else the machine does for a while meets no rung alone.
        for (int round = 0; round < kRounds; ++round) {
            for (std::size_t i = 0; i < figure.rungs.size(); ++i) {
                const LadderRung& rung = figure.rungs[i];
                if (round > 0 && rung.long_run) continue;
                work.steps.push_back({rung.weight, [measurement, f, i, round] {
                                          const ThreadLimit one(1);
                                          RungResult& result = measurement->results[f][i];
                                          const double before = result.nanoseconds;
                                          result =
                                              measurement->ladder.figures[f].rungs[i].measure();
                                          if (round == 0) return;
                                          result.nanoseconds = std::min(before, result.nanoseconds);
                                      }});
            }
        }
    }
    work.finish = [measurement] {
        const RungLadder& measured = measurement->ladder;
        LadderEffect effect;
        effect.name = measured.effect;
        effect.title = measured.title;
        for (std::size_t f = 0; f < measured.figures.size(); ++f) {
            const RungFigure& figure = measured.figures[f];
            effect.figures.push_back({figure.file, f == 0 ? measured.text : "",
                                      make_plot(measured, figure, measurement->results[f]),
                                      f == 0 ? make_table(*measurement) : Table()});
        }
        return effect;
    };
    return work;
}

}  // namespace airlight
