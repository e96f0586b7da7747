// SPDX-License-Identifier: Apache-2.0
// Sums of shifted rings with symmetric taps, the inner loop of direct convolution.
#pragma once

#include <cstddef>

namespace airlight {

/// One input ring and its taps for two output rows. `source` points at column 0; count-1 further
/// columns must be there to the left, and count-1 + kTapSlack to the right of the last. `taps`
/// holds (count, 2) values: those of either output row side by side.
struct TapRow {
    const float* source;
    const float* taps;
    std::size_t count;
};

/// Columns that sum_taps may read and write past the last.
constexpr std::size_t kTapSlack = 128;

/// For both output rows r, out_r[x] = sum over input rings of
/// taps[0][r] source[x] + sum_{k>0} taps[k][r] (source[x-k] + source[x+k]), in float, for
/// x = 0 … columns-1; writes up to kTapSlack columns more. Two rows at a time, since loads, not
/// multiplications, decide the speed.
void sum_taps(const TapRow* rows, std::size_t row_count, std::size_t columns, float* out_0,
              float* out_1);

}  // namespace airlight
