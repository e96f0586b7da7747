// SPDX-License-Identifier: Apache-2.0
// The effects of `airlight ladder`: what is measured for each, and what came out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/ladder_table.h"
#include "cli/plot.h"

namespace airlight {

struct LadderOptions {
    int width = 512, height = 256;  ///< of the map on which errors of fog are measured
    double optical_thickness = 2;   ///< of its fog; at 1 the factored form would be exact
    /// Take cost to sizes 16 times as wide instead of 8, and 80 times the paths.
    bool full = false;
};

/// A plot and the table of what it shows: NAME.svg and NAME.csv. Without columns there is no CSV,
/// for another figure's table has the numbers.
struct LadderFigure {
    std::string name;
    std::string text;  ///< HTML that says what was measured
    Plot plot;
    Table table;
};

struct LadderEffect {
    std::string name;
    std::string title;
    std::vector<LadderFigure> figures;
};

/// A piece of the measuring, and about how many milliseconds it takes.
struct LadderStep {
    std::uint64_t weight = 1;
    std::function<void()> run;
};

/// An effect to be measured: the steps in order, then `finish` makes what is written to
/// those files.
struct LadderWork {
    std::vector<std::string> files;
    std::vector<LadderStep> steps;
    std::function<LadderEffect()> finish;
};

/// Fog of sun_and_sky() by every method: errors against the rings at one size, cost at several.
LadderWork plan_fog_ladder(const LadderOptions& options);

/// Visibility and transfer of a mesh by every choice of directions.
LadderWork plan_transfer_ladder();

/// Glows by single scattering against all scattering; more paths where `full`.
LadderWork plan_multiple_ladder(const LadderOptions& options);

/// Which time a measurement is of. CPU time hardly depends on what else the machine does, and where
/// one thread does all the work it is the wall time of an idle machine.
enum class TimeKind { wall, cpu };

/// Seconds of the fastest run of several: `least` at least, then until `window` seconds have
/// passed.
double fastest_seconds(int least, TimeKind kind, const std::function<void()>& run,
                       double window = 0.12);

}  // namespace airlight
