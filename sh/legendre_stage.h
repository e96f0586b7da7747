// SPDX-License-Identifier: Apache-2.0
// The Legendre half of a spherical transform: sums over rows and over bands for one azimuthal m.
#pragma once

#include <cstddef>
#include <vector>

#include "sh/aligned.h"
#include "sh/legendre_kernel.h"

namespace airlight {

/// Transforms between values on rows symmetric about the equator and bands l = m … lmax, for one m.
///
///   analyze:     c_l = sum over rows r of P_lm(cos theta_r) f_r
///   synthesize:  f_r = sum over l of P_lm(cos theta_r) c_l
///
/// P_lm is the normalised associated Legendre function of sh/basis.h without Condon-Shortley sign,
/// times sqrt(2) for m > 0. Rows come in pairs (theta, pi - theta), folded by the caller into
/// even = north + south and odd = north - south (analysis; an equator row goes in once, with half
/// of it in no fold: even = row, odd = 0) and unfolded as north = even + odd, south = even - odd
/// (synthesis). P_lm is even in cos theta where l - m is.
///
/// T is double, or float for speed: then functions err by about 1e-7 sqrt(l).
///
/// Method: the recurrence in l, carried by the differences P_l - P_{l-1} so that rows at the poles
/// keep their accuracy, in rows side by side (Highway, run-time dispatch), four bands of each
/// parity at a time, then small matrix products with all components. Seeds sin^m are kept as
/// mantissa * 2^(192 k): a row joins the sums once |P_lm| exceeds about 2^-96, so no order
/// underflows (2^-72 in float), and rows beside the poles where no band of an order does so are
/// left out.
template <class T>
class LegendreStage {
  public:
    /// `colatitude` holds the rows of the northern hemisphere in (0, pi/2], nearest the equator
    /// first, strictly decreasing.
    LegendreStage(const std::vector<double>& colatitude, int lmax);

    int lmax() const { return lmax_; }
    /// Rows of the folded arrays, padded for SIMD; entries past the last row must be 0.
    std::size_t padded_rows() const { return variable_.size(); }
    /// Bands l = m … lmax, padded likewise.
    std::size_t padded_bands(int m) const;

    /// The recurrence of one order and the scratch memory of one thread.
    struct Workspace {
        int m = 0;
        std::size_t rows = 0;  // those where any band counts, padded
        AlignedVector<T> recurrence, seed, seed_exponent;
        AlignedVector<double> reference;
        AlignedVector<T> value, step, exponent, functions;
    };

    /// Chooses the order for the calls that follow with this workspace.
    void prepare(int m, Workspace& work) const;

    /// `even`, `odd`: (components, padded_rows()); `coefficients`: (padded_bands(m), components),
    /// band m first. `components` is even: the real and imaginary parts of each channel.
    void analyze(std::size_t components, const T* even, const T* odd, T* coefficients,
                 Workspace& work) const;
    /// Overwrites even and odd, and the padding of the coefficients with zeros.
    void synthesize(std::size_t components, T* coefficients, T* even, T* odd,
                    Workspace& work) const;

  private:
    LegendreRecurrence<T> recurrence(Workspace& work) const;
    // The rows, from the equator on, where the order is not negligible in every band.
    std::size_t active_rows(int m) const;

    int lmax_;
    std::size_t rows_;
    AlignedVector<T> variable_;      // as LegendreRecurrence has it
    AlignedVector<double> versine_;  // 1 - cos theta
    std::vector<long double> log2_sin_;
    std::vector<long double> root_;  // sqrt(2 l + 1)
    std::vector<double> seed_;       // P_mm / sin^m for m = 0 … lmax
};

extern template class LegendreStage<float>;
extern template class LegendreStage<double>;

}  // namespace airlight
