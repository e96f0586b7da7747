// SPDX-License-Identifier: Apache-2.0
// Full spherical-harmonics transforms of lat-long maps.
#pragma once

#include <cstddef>
#include <memory>
#include <variant>

namespace airlight {

/// What a transform computes in, whatever the type of its map.
enum class TransformPrecision {
    full,    ///< double
    single,  ///< float, faster
};

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
/// (channels, (lmax+1)^2) at index l (l+1) + m. Results do not depend on the number of threads.
/// Cost O(lmax^2 rows); memory beyond input and output: the row spectra, 2 (lmax+1) channels
/// numbers per row. NaN or an infinity in a map spreads over its bands.
///
/// Measured for RGB maps at lmax = rows - 1, one thread, AVX-512 (bench/transform_bench), with the
/// largest error over the largest value, of normally distributed bands:
///     precision   512 rows: analysis, synthesis, error    1024 rows
///     full            37 ms   25 ms  3e-14                190 ms  128 ms  5e-14
///     single          24 ms   16 ms  8e-7                 125 ms   85 ms  1.1e-6
class SphericalTransform {
  public:
    /// Requires rows >= 1, 0 <= lmax < rows and 2 lmax < columns (throws Error otherwise).
    SphericalTransform(int rows, int columns, int lmax,
                       TransformPrecision precision = TransformPrecision::full);
    ~SphericalTransform();

    int lmax() const { return lmax_; }

    template <class T>
    void analyze(const T* map, int channels, T* coefficients) const;
    template <class T>
    void synthesize(const T* coefficients, int channels, T* map) const;

    /// Analysis, band l of channel c times eigenvalues[c * (lmax+1) + l], synthesis; `map` and
    /// `out` may be the same. Holds no coefficients beyond one order at a time.
    template <class T>
    void convolve(const T* map, int channels, const double* eigenvalues, T* out) const;

  private:
    template <class R>
    struct Impl;
    int lmax_;
    std::variant<std::unique_ptr<Impl<double>>, std::unique_ptr<Impl<float>>> impl_;
};

}  // namespace airlight
