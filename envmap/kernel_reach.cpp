// SPDX-License-Identifier: Apache-2.0
#include "envmap/kernel_reach.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "envmap/chord.h"

namespace airlight {
KernelReach::KernelReach(int rows, int columns) : rows_(rows), columns_(columns) {
    const double height = kPi / rows;
    double upper = 0;
    for (int row = 0; row < rows; ++row) {
        const double lower = row + 1 == rows ? 0 : std::sin(height * (row + 1));
        centre_sine_.push_back(std::sin(height * (row + 0.5)));
        smallest_sine_.push_back(std::min(upper, lower));
        across_.push_back(row == 0 ? 0 : squared_chord(height * (row - 0.5)));
        upper = lower;
    }
}

RowRange KernelReach::rows(double radius, int i) const {
    if (radius >= 2) return {0, rows_ - 1};
    const double angle = 2 * std::asin(0.5 * radius);
    const int distance = static_cast<int>(std::floor(angle * rows_ / kPi + 0.5));
    return {std::max(0, i - distance), std::min(rows_ - 1, i + distance)};
}

std::size_t KernelReach::columns(double radius, int i, int j) const {
    const std::size_t all = static_cast<std::size_t>(columns_) / 2 + 1;
    // The nearest colatitude of row j decides how much of the chord is left for the azimuth; the
    // smallest sine in the row makes the estimate generous.
    const double left = radius * radius - across_[std::abs(i - j)];
    if (left <= 0) return 0;
    const double sine_squared = left / (4 * smallest_sine_[j] * centre_sine_[i]);
    if (!(sine_squared < 1)) return all;
    const double phi = 2 * std::asin(std::sqrt(sine_squared));
    return std::min(all, static_cast<std::size_t>(phi * columns_ / (2 * kPi) + 0.5) + 1);
}

}  // namespace airlight
