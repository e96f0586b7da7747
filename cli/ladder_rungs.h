// SPDX-License-Identifier: Apache-2.0
// Ladders of methods that compute the same thing: each rung's error beside its time.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/ladder_effects.h"

namespace airlight {

/// Errors as they come: the largest, and the root of the mean square.
class LadderErrors {
  public:
    /// A NaN does not pass for a small error.
    void add(double error) {
        if (!(error <= largest_)) largest_ = error;
        squares_ += error * error;
        ++count_;
    }
    double largest() const { return largest_; }
    double rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }

  private:
    double largest_ = 0, squares_ = 0;
    std::size_t count_ = 0;
};

struct RungResult {
    double nanoseconds = 0;  ///< CPU time of one result
    double max_error = 0;
    double rms_error = 0;
};

/// A method on one set of inputs.
struct LadderRung {
    std::string method;
    std::string set;    ///< the inputs in the table: "A", "order 6"
    std::string label;  ///< beside the dot
    std::size_t series = 0;
    std::function<RungResult()> measure;  ///< on one thread
    double bound = 0;  ///< > 0: others are measured against this one, whose own error is under it
    std::uint64_t weight = 70;  ///< expected milliseconds of a call of `measure`
    bool long_run = false;  ///< whether one call of `measure` has to do; otherwise there are two
};

/// A plot: FILE.svg.
struct RungFigure {
    std::string file;
    std::string title;
    std::string subtitle;
    std::vector<PlotSeries> series;  ///< without points; those that stay empty are left out
    std::vector<LadderRung> rungs;
};

/// An effect: all rungs in one table, EFFECT.csv.
struct RungLadder {
    std::string effect;
    std::string title;
    std::string text;                 ///< HTML: what was measured, and what its errors are
    std::string result = "call";      ///< what one result is
    bool milliseconds = false;        ///< times in ms, not ns
    std::string error = "error";      ///< for people
    std::string error_key = "error";  ///< in the columns max_… and rms_…
    std::vector<RungFigure> figures;
};

/// Seconds for which a call of `measure` repeats what it times.
inline constexpr double kRungWindow = 0.06;

LadderWork plan_rung_ladder(RungLadder ladder);

/// Nanoseconds of CPU time for each of the `results` that a run makes, by fastest_seconds();
/// short runs are repeated until the clock's own time is nothing beside theirs.
double nanoseconds_each(double results, const std::function<void()>& run);

}  // namespace airlight
