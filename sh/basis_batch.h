// SPDX-License-Identifier: Apache-2.0
// The spherical-harmonic basis at many directions at once, and sums over it that never store it.
//
// Structure of arrays: directions are three arrays x, y, z of `count` numbers of any alignment, in
// either frame of sh/basis.h; several functions of them are (channels, count), several coefficient
// vectors (channels, order^2), slots as in sh/index.h. SIMD lanes hold one direction each, of the
// widest kind that the CPU has. Outputs must not overlap inputs.
//
// Only the direction counts, as in evaluate_basis: any finite vector is normalised; the zero
// vector counts as (0, 0, 1); where a component is not finite, all Y_lm are NaN, whatever the other
// directions are. Directions with |v|^2 beyond 0.3 % of 1 in float, 4e-6 in double, take 1.5 to 1.8
// times as long, and those with |v|^2 outside 1e+-20 or 1e+-200 up to nine times.
//
// Error of a basis function of a direction v of the precision's own, exactly v / |v|, in units of
// eps sqrt((2l+1)/(4 pi)) with eps = 2^-23 or 2^-52: under 3 + 2 l for orders up to 8, under
// 3 + l / 2 for orders up to 64 (measured over the sphere, poles included, with fused multiply-add
// 0.4, 0.8, 3.4, 7.5, 12.9 at l = 0, 1, 3, 5, 7 of order 8 and 3.1, 5.0, 7.1, 10.1 at 7, 15, 29,
// 57 of order 64; without it, up to a third more). Higher orders are those of evaluate_basis.
// Targets with fused multiply-add (AVX2 and up) agree to the bit, and so do those without.
//
// Cost per direction, one thread, AVX2, directions and results in cache (bench/sh_bench.cpp;
// evaluate_basis takes 24, 41 and 240 ns in float, 17, 31 and 182 ns in double):
//     order                      4     6     16
//     evaluate, float           1.2   2.0   37  ns      double  2.0   3.9   72  ns
//     project, one channel      1.3   2.4   42                  2.5   4.5   86
//     reconstruct, one channel  1.1   2.0   43                  2.5   4.0   94
//     project, three channels   2.8   5.4   61                  5.5  10.5  124
//     project, sixteen          8.9  20     -                  17    37     -
// Up to order 8, code unrolled for the order; up to 64, loops that carry sh/basis.h's difference
// recurrence for |z| >= 1/2 and the three-term one, in one block of directions at a time; above,
// evaluate_basis one by one. Once results go to memory its store rate decides: project and
// reconstruct where you can.
#pragma once

#include <cstddef>

namespace airlight {

/// Y_lm of direction i, l < order, order >= 0, into out[slot * stride + i]; stride >= count, and
/// nothing is written between count and stride. A stride of a multiple of 4096 bytes puts all slots
/// of a direction into the same sets of the cache: 64 bytes more make it fast again.
///
/// The values of a direction depend on its three numbers and on the order alone, to the bit.
void evaluate_basis_batch(int order, std::size_t count, const float* x, const float* y,
                          const float* z, float* out, std::size_t stride);
void evaluate_basis_batch(int order, std::size_t count, const double* x, const double* y,
                          const double* z, double* out, std::size_t stride);

/// Adds sum_i values[c * count + i] Y_lm(i) to coefficients[c * order^2 + slot], channels >= 0: a
/// projection when the values carry the weights of a quadrature rule. A value or a direction that
/// is not finite makes its channel, or all of them, NaN or infinite.
///
/// The same inputs give the same bits; split in two calls, they are summed in another order. Per
/// lane, products are summed in Real 64 at a time and those sums in double: the float overload is
/// right to 4e-7 of the largest coefficient over 2048 random directions (order 6 and 16).
void project_basis_batch(int order, std::size_t count, const float* x, const float* y,
                         const float* z, int channels, const float* values, double* coefficients);
void project_basis_batch(int order, std::size_t count, const double* x, const double* y,
                         const double* z, int channels, const double* values, double* coefficients);

/// out[c * count + i] = sum over slots of coefficients[c * order^2 + slot] Y_lm(i), channels >= 0;
/// zeros if order is 0.
///
/// out of a direction depends on its three numbers, the coefficients of its channel, the order and
/// on whether there is one channel or more, to the bit. Sums run in Real: their error is that of
/// the basis and some eps times the sum of all |coefficient Y_lm| (float: 4e-7 of the largest value
/// for random coefficients of order 6, 8e-7 for order 16).
void reconstruct_basis_batch(int order, std::size_t count, const float* x, const float* y,
                             const float* z, int channels, const float* coefficients, float* out);
void reconstruct_basis_batch(int order, std::size_t count, const double* x, const double* y,
                             const double* z, int channels, const double* coefficients,
                             double* out);

}  // namespace airlight
