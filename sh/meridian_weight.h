// SPDX-License-Identifier: Apache-2.0
// Exact quadrature over the pixel-centre rows of a lat-long map.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "sh/lane_fft.h"
#include "sh/row_spectra.h"

namespace airlight {

/// Multiplies functions of the colatitude, sampled on `rows` pixel-centre rows, by |sin theta| and
/// projects the product onto trigonometric polynomials of degree < rows [McEwen11]. Then a plain
/// sum over the rows against P_lm, l < rows, is the integral over the meridian of the function's
/// interpolant times P_lm sin theta: exact, where weights per row would be so for l < rows / 2
/// only.
///
/// The interpolant lives on the whole meridian circle of n = 2 rows samples, going on past a pole
/// with (-1)^m: orders m and m+1, one even and one odd, share a circle as u + v, which is u - v on
/// its other half. With S the shift by half a sample, exact in Fourier coefficients, and w the
/// values of |sin theta|'s series to the degree 2 rows - 2 on the samples and half-way between, the
/// projected product is
///     (w_0 x + S^-1 w_1 S x) / 2,
/// four transforms of n, of several orders side by side.
template <class T>
class MeridianWeight {
  public:
    explicit MeridianWeight(std::size_t rows);

    /// Replaces all rows of all orders by their weighted values, those of order m times turn[m].
    void apply(RowSpectra<T>& spectra, const std::vector<std::complex<T>>& turn) const;

  private:
    struct Workspace {
        AlignedVector<T> a, b;
    };
    static constexpr std::size_t kOrders = LaneFft<T>::kStride;

    // Orders m0 … m0 + kOrders - 1 of one channel; m0 is even.
    void apply(RowSpectra<T>& spectra, std::size_t m0, std::size_t channel,
               const std::vector<std::complex<T>>& turn, Workspace& work) const;
    void shift(T* spectrum, bool back) const;

    std::size_t rows_;
    LaneFft<T> fft_;
    std::vector<T> on_, between_;        // w_0 / 2 and w_1 / (2 n^2)
    std::vector<std::complex<T>> half_;  // exp(i pi k / n), k < rows
};

extern template class MeridianWeight<float>;
extern template class MeridianWeight<double>;

}  // namespace airlight
