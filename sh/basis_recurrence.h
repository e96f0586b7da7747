// SPDX-License-Identifier: Apache-2.0
// What the SIMD kernels of the basis share (sh/basis_kernel-inl.h), for all targets alike.
//
// Y_l,+-m = Q_lm(z) Re, Im (x + i y)^m with polynomials Q_lm of degree l - m:
//     Q_mm = seed_m,  Q_lm = a_lm z Q_l-1,m - b_lm Q_l-2,m,
// the three-term recurrence [DLMF] 14.10.3 normalised, without its factor sin^m(theta).
#pragma once

#include <cstddef>

#include "core/constants.h"

namespace airlight::detail {

/// Orders up to this one are unrolled; all kernels are compiled for each.
inline constexpr int kUnrolledOrder = 8;
/// Orders up to this one run through the recurrence in vectors.
inline constexpr int kVectorOrder = 64;

// Newton's iteration from above falls until rounding stops it.
constexpr double square_root(double value) {
    double root = value > 1 ? value : 1;
    for (double next = 0.5 * (root + value / root); next < root;) {
        root = next;
        next = 0.5 * (root + value / root);
    }
    return root;
}

/// The constants of unrolled kernels, in double until they are final.
struct Recurrence {
    double seed[kUnrolledOrder] = {};               // sqrt(2) for m > 0 included
    double a[kUnrolledOrder][kUnrolledOrder] = {};  // (m, l)
    double b[kUnrolledOrder][kUnrolledOrder] = {};

    constexpr Recurrence() {
        double square = 1 / (4 * kPi);
        for (int m = 0; m < kUnrolledOrder; ++m) {
            if (m > 0) square *= (2.0 * m + 1) / (2.0 * m);
            seed[m] = square_root(m > 0 ? 2 * square : square);
            double previous = 0;
            for (int l = m + 1; l < kUnrolledOrder; ++l) {
                const double scale =
                    square_root((2.0 * l - 1) * (2.0 * l + 1) / ((l - m) * (l + m)));
                a[m][l] = scale;
                b[m][l] = l == m + 1 ? 0 : scale / previous;
                previous = scale;
            }
        }
    }
};

inline constexpr Recurrence kRecurrence;

/// From l - 1 to l: the recurrence above, and for |z| >= 1/2 the one on differences of sh/basis.h,
///     D_l = keep D_l-1 - bend (1 - |z|) Q_l-1,  Q_l = grow Q_l-1 + D_l.
template <class Real>
struct Step {
    Real a, b, grow, keep, bend;
};

/// The table of kernels that loop.
template <class Real>
struct LoopTable {
    Real seed[kVectorOrder];
    Step<Real> steps[kVectorOrder][kVectorOrder];  // (m, l)
};

template <class Real>
const LoopTable<Real>& loop_table();

/// `count` directions as structure of arrays.
template <class Real>
struct Directions {
    std::size_t count;
    const Real *x, *y, *z;

    Directions from(std::size_t first, std::size_t length) const {
        return {length, x + first, y + first, z + first};
    }
};

/// |v|^2 - 1 up to here is made up for by two terms of a series, whose third is under eps / 8.
template <class Real>
inline constexpr Real kNearUnit = static_cast<Real>(sizeof(Real) == 4 ? 3e-3 : 4e-6);

/// Squared lengths in here need no rescaling.
template <class Real>
inline constexpr Real kLeastSquare = static_cast<Real>(sizeof(Real) == 4 ? 1e-20 : 1e-200);
template <class Real>
inline constexpr Real kLargestSquare = static_cast<Real>(sizeof(Real) == 4 ? 1e20 : 1e200);

/// Multiplies directions by powers of 2 until their squared length is in that range; makes the
/// zero vector (0, 0, 1), and vectors that are not finite NaN.
void rescale_directions(std::size_t count, float* x, float* y, float* z);
void rescale_directions(std::size_t count, double* x, double* y, double* z);

}  // namespace airlight::detail
