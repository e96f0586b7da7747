// SPDX-License-Identifier: Apache-2.0
// Full spherical-harmonics transforms of lat-long maps.
#pragma once

#include <cstddef>
#include <memory>

namespace airlight {

/// Transforms between a map sampled at pixel centres and its real SH coefficients up to band lmax.
///
///   synthesis:  f(theta_i, phi_k) = sum over l, m of c_lm Y_lm(theta_i, phi_k)
///   analysis:   c_lm = ∫ f Y_lm domega for the band-limited f through the samples
///
/// Rows lie at theta_i = (i + 1/2) pi / rows from the polar axis, columns at
/// phi_k = pi - 2 pi (k + 1/2) / columns. That is the map frame of docs/CONVENTIONS.md: basis
/// direction (x, y, z) = world (Z, X, Y), the polar axis is the world's up.
///
/// Analysis is exact (to rounding) for every f of band limit lmax < rows: the samples determine f
/// on its meridians as a trigonometric polynomial, which is multiplied by |sin theta| and projected
/// back exactly [McEwen11], so plain sums over the rows integrate without error. Weighting
/// samples with sin theta, or with Fejér's rule, would be exact only up to about rows / 2.
///
/// Maps are (rows, columns, channels) with row 0 at the north pole; coefficients are
/// (channels, (lmax+1)^2) at index l (l+1) + m. Sums run in double for float maps too. Results do
/// not depend on the number of threads. Cost O(lmax^2 rows); memory beyond input and output: the
/// row spectra, 16 bytes * rows * (lmax+1) * channels. Round-trip error about 1e-14 * log2(lmax) of
/// the largest value in double.
class SphericalTransform {
  public:
    /// Requires rows >= 1, 0 <= lmax < rows and 2 lmax < columns (throws Error otherwise).
    SphericalTransform(int rows, int columns, int lmax);
    ~SphericalTransform();

    int lmax() const;

    template <class T>
    void analyze(const T* map, int channels, T* coefficients) const;
    template <class T>
    void synthesize(const T* coefficients, int channels, T* map) const;

    /// Analysis, band l of channel c times eigenvalues[c * (lmax+1) + l], synthesis; `map` and
    /// `out` may be the same. Holds no coefficients beyond one order at a time.
    template <class T>
    void convolve(const T* map, int channels, const double* eigenvalues, T* out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace airlight
