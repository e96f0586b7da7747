// SPDX-License-Identifier: Apache-2.0
// Windows that quieten the ringing of functions cut off after a few degrees.
//
// A window multiplies degree l by a factor w_l <= 1, w_0 = 1, which is convolution with a zonal
// function: the mean stays, nothing moves, and edges become softer instead of ringing.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// Hann's window, w_l = (1 + cos(pi l / order)) / 2, order >= 0.
std::vector<double> hann_window(int order);

/// Lanczos' window, w_l = sin(pi l / order) / (pi l / order), which is milder. order >= 0.
std::vector<double> lanczos_window(int order);

/// w_l = 1 / (1 + strength l^2 (l+1)^2), strength >= 0: of all functions it gives the one that
/// minimises the squared distance from the original plus `strength` times the integral of the
/// squared Laplacian ([Sloan08]). Infinite strength leaves the mean alone. Throws Error (usage) for
/// other strengths, NaN among them.
std::vector<double> smoothing_window(int order, double strength);

/// The least value over the sphere of the function with these coefficients, order >= 1; NaN if one
/// is not finite. How it is found, and how surely, is told in sh/low_places.h; the result is at
/// most 1e-9 of the range of values above the least. Cost for order 6, one thread: 1 ms.
double least_value(int order, const double* coefficients);

/// The largest order of automatic_window.
inline constexpr int kLargestAutomaticOrder = 16;

struct AutomaticWindow {
    std::vector<double> factors;
    double strength = 0;  ///< of smoothing_window
};

/// The weakest smoothing_window, one for all channels, after which no channel of coefficients
/// (channels, order^2) is anywhere below `least` times its mean, least < 1; strength 0 where none
/// is needed. The strength is right to 1e-6, on the side that keeps the bound. Channels of zeros
/// are left out.
///
/// The least value need not grow with the strength, since the kernel of the window is a little
/// negative in places. The strength is the upper end of an interval over which it crosses the
/// bound, found on steps of 4; among 10^4 random lights none had a weaker one 1, 3, 10 or 30 %
/// below.
///
/// Throws Error: usage if least >= 1 or is NaN or the order is not in [1, kLargestAutomaticOrder];
/// data if a coefficient is not finite, or the mean of a channel is not positive and the channel
/// not zero.
AutomaticWindow automatic_window(int order, std::size_t channels, const double* coefficients,
                                 double least = 0);

/// Multiplies degree l of coefficients (channels, order^2) by factors[l]; order is their number.
void apply_window(const std::vector<double>& factors, std::size_t channels, double* coefficients);

}  // namespace airlight
