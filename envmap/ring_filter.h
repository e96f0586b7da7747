// SPDX-License-Identifier: Apache-2.0
// Convolution of a lat-long map with a kernel of the angle, ring by ring and pixel by pixel.
#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "envmap/image.h"
#include "envmap/kernel_reach.h"
#include "envmap/remainder_table.h"

namespace airlight {

/// One kernel and the channels it applies to, each with its own factor.
struct RingKernel {
    const RemainderTable* remainder = nullptr;
    std::vector<int> channels;
    std::vector<double> amplitude;  ///< one for each of `channels`
};

/// Adds amplitude * sum_j L_j ∫_{pixel j} f(gamma) domega to every pixel of `out`, with gamma the
/// angle to the output pixel's centre and f the kernel behind each remainder table.
///
/// Exact for the piecewise constant map up to the pixel integrals (about 1e-7). Rows away from the
/// poles sum their neighbours directly, in float (Highway, run-time dispatch); rows near the poles,
/// where a kernel of fixed angle covers many columns, and kernels that cover the sphere, multiply
/// the Fourier coefficients of whole rings in double. Rows i and height-1-i share their taps. The
/// result does not depend on the number of threads.
void add_ring_filter(const Image& map, const std::vector<RingKernel>& kernels, Image& out,
                     Progress* progress);

/// What add_ring_filter costs for `kernels` kernels of that radius on `channels` channels in all,
/// in nanoseconds of one thread: a model for choosing between methods, fitted on one machine.
double ring_filter_cost(const KernelReach& reach, int channels, int kernels, double radius);

}  // namespace airlight
