// SPDX-License-Identifier: Apache-2.0
// The least change after which a function of few degrees is nowhere below a bound.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// What may change; `airlight sh --window auto`, `bands` and `nearest`. Each keeps the mean of
/// every channel, holds the bound as least_value() sees it, and changes nothing where the bound
/// holds already.
///
/// Squared change over the squared norm without the mean, at bound 0, average (and most) over nine
/// maps, Blender's eight worlds and data/lamps.exr, and the time for three channels, one thread of
/// a busy machine:
///
///     order   smoothing             bands                 nearest
///         3   33 % (47)    8 ms     23 % (34)     7 ms    13 % (27)    27 ms
///         4   44 % (74)    7 ms     24 % (38)    13 ms    15 % (33)    31 ms
///         6   60 % (86)   21 ms     26 % (41)    50 ms    16 % (34)   140 ms
///         9   69 % (93)   85 ms     29 % (44)   310 ms    16 % (35)   1.2 s
///
/// At order 16, lamps.exr alone takes 1.3, 2.7 and 16 s.
enum class DeringMethod {
    smoothing,  ///< the weakest automatic_window of sh/window.h, one strength for all channels
    bands,      ///< a factor in [0, 1] per degree, those of the least squared change over all
                ///< channels: the best of all windows; turns with the light and keeps its hue
    nearest,    ///< any coefficient but the mean, each channel for itself: the nearest function
};

const char* name_of(DeringMethod method);

/// The window of DeringMethod::bands for coefficients (channels, order^2): the factors w_l in [0,
/// 1] that minimise sum_lm (1 - w_l)^2 c_lm^2 over all channels while no channel is below `least`
/// times its mean. Unlike the common windows' they need not fall with l.
std::vector<double> least_change_window(int order, std::size_t channels, const double* coefficients,
                                        double least = 0);

/// Coefficients (channels, order^2) after the change; channels of zeros stay.
///
/// The minimum over all functions that keep the bound is a quadratic programme with one
/// constraint per direction. Here it has those of the lowest places of the solution so far, until
/// it violates no other by more than 1e-6 of the mean's distance from the bound; what is left is
/// drawn towards the mean. Tests hold the condition of the minimum to 1e-5.
///
/// Where a coefficient is more than 1e10 times the mean, for which that has no digits, `bands` and
/// `nearest` are `smoothing`.
///
/// Throws Error as automatic_window.
std::vector<double> dering(DeringMethod method, int order, std::size_t channels,
                           const double* coefficients, double least = 0);

}  // namespace airlight
