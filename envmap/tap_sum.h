// SPDX-License-Identifier: Apache-2.0
// Sums of shifted rings with symmetric taps, the inner loop of direct convolution.
#pragma once

#include <cstddef>

namespace airlight {

/// One input ring and its taps. `source` points at column 0; count-1 further columns must be there
/// to the left, and count-1 + kTapSlack to the right of the last.
struct TapRow {
    const float* source;
    const float* taps;
    std::size_t count;
};

/// Columns that sum_taps may read and write past the last.
constexpr std::size_t kTapSlack = 128;

/// out[x] = sum over rows of taps[0] source[x] + sum_{k>0} taps[k] (source[x-k] + source[x+k]), in
/// float, for x = 0 … columns-1; writes up to kTapSlack columns more.
void sum_taps(const TapRow* rows, std::size_t row_count, std::size_t columns, float* out);

}  // namespace airlight
