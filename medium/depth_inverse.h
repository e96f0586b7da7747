// SPDX-License-Identifier: Apache-2.0
// The distance at which an optical depth is reached, for any density along a ray.
#pragma once

#include <cmath>

namespace airlight {
namespace detail {

/// A depth tau(t) beside the one that is sought.
struct DepthState {
    double ratio;  ///< tau(t) / sought
    double step;   ///< (tau(t) - sought) / density(t), a length
    double slope;  ///< d ln density / dt
};

/// Halley's method within a bracket. `state(t)` gives the DepthState at t; tau does not fall, is 0
/// at `lo` and reaches the sought depth before `hi`, which is finite. Starts at `guess` and ends
/// when the ratio is 1 to 2e-15 or when lo and hi are neighbours; whenever three steps have not
/// halved the error, it bisects. Gives the best t that it saw.
template <class State>
double depth_inverse(const State& state, double lo, double hi, double guess) {
    constexpr double kEnough = 2e-15;
    constexpr int kMostSteps = 400;
    double t = guess > lo && guess < hi ? guess : lo + (hi - lo) / 2;
    double best = hi, best_error = HUGE_VAL, earlier_error = HUGE_VAL;
    for (int i = 0; i < kMostSteps; ++i) {
        const DepthState here = state(t);
        const double error = std::abs(here.ratio - 1);
        if (error < best_error) {
            best_error = error;
            best = t;
        }
        if (error <= kEnough) break;
        (here.ratio < 1 ? lo : hi) = t;
        const double bend = 1 - 0.5 * here.step * here.slope;
        double next = t - here.step / (bend > 0.25 && bend < 4 ? bend : 1);
        const bool slow = i % 3 == 2 && best_error > 0.5 * earlier_error;
        if (i % 3 == 2) earlier_error = best_error;
        if (slow || !(next > lo && next < hi)) {
            // Distances of all sizes: halve the exponent while it is far off.
            next = hi > 16 * lo && lo > 0 ? std::sqrt(lo) * std::sqrt(hi)
                   : lo == 0 && i > 4     ? hi * 0x1p-10
                                          : lo + (hi - lo) / 2;
            if (!(next > lo && next < hi)) break;
        }
        t = next;
    }
    return best;
}

}  // namespace detail
}  // namespace airlight
