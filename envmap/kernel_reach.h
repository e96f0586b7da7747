// SPDX-License-Identifier: Apache-2.0
// Which pixels of a lat-long map lie within an angle of a pixel centre.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

struct RowRange {
    int first, last;
};

/// Bounds, never too small, on the pixels that a kernel of a given radius reaches from the centre
/// of a pixel in row i of a map. The radius is a chord length, 2 sin(angle / 2); from 2 on it
/// covers the sphere.
class KernelReach {
  public:
    KernelReach(int rows, int columns);

    int row_count() const { return rows_; }
    int column_count() const { return columns_; }

    /// The rows that hold such pixels.
    RowRange rows(double radius, int i) const;
    /// How many columns on one side, the own one included, hold them in row j: at most
    /// column_count() / 2 + 1.
    std::size_t columns(double radius, int i, int j) const;

  private:
    int rows_, columns_;
    std::vector<double> centre_sine_;    // sine of the colatitude of each row's centre
    std::vector<double> smallest_sine_;  // the smaller of the sines at a row's edges
    std::vector<double> across_;         // squared chord from a centre to a row n rows away
};

}  // namespace airlight
