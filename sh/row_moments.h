// SPDX-License-Identifier: Apache-2.0
// The lowest Fourier moments of the rows of a lat-long map, straight from its pixels.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// The moments of a row f of `columns` pixels, m = 0 ... orders - 1,
///
///     C_m = sum_k f_k cos(m psi_k),  S_m = sum_k f_k sin(m psi_k),
///     psi_k = 2 pi (k + 1/2) / columns.
///
/// Four pixels that mirror at psi = 0 and pi/2 share their cosines and sines but for signs, so
/// that they are added and subtracted first: 11/4 products per pixel for six orders. Widths that 4
/// does not divide do without, at four times the cost.
///
/// All channels of a pixel lie in one vector of doubles, and no pixel is read twice for orders up
/// to 6. Sums run in double, one after the other: their error is under 2^-53 columns / 4 times
/// sum |f_k|, and in tests under 1e-15 (columns + 40) for |f_k| <= 1. A value that is not finite
/// makes C_0 of its channel not finite.
///
/// For few orders; for many, RowSpectra transforms rows side by side.
class RowMoments {
  public:
    /// columns >= 1, orders >= 1.
    RowMoments(std::size_t columns, std::size_t orders);

    std::size_t orders() const { return orders_; }

    /// `row` is (columns, channels); `readable` >= columns * channels values from there on may be
    /// read, which saves a copy where a few are there behind the row. out: (channels, orders, 2),
    /// C and S.
    void operator()(const float* row, std::size_t channels, std::size_t readable,
                    double* out) const;
    void operator()(const double* row, std::size_t channels, std::size_t readable,
                    double* out) const;

  private:
    template <class T>
    void moments(const T* row, std::size_t channels, std::size_t readable, double* out) const;

    std::size_t columns_, orders_;
    bool folded_;
    std::vector<double> table_;  // (groups of orders, columns or a quarter of them, m, {cos, sin})
};

}  // namespace airlight
