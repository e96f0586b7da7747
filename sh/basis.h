// SPDX-License-Identifier: Apache-2.0
// The real, orthonormal spherical-harmonic basis without Condon-Shortley sign.
//
//     Y_lm(theta, phi) = P_l|m|(cos theta) { sqrt(2) cos(m phi)    m > 0
//                                          { 1                     m = 0
//                                          { sqrt(2) sin(|m| phi)  m < 0
//     P_lm = sqrt((2l+1)/(4 pi) (l-m)!/(l+m)!) (1-x^2)^{m/2} d^m P_l(x) / dx^m   (P_mm >= 0)
//
// so that the integral of Y_lm Y_l'm' over the sphere is 1 for equal indices and 0 otherwise, and
// Y_1 = sqrt(3/(4 pi)) (y, z, x) = 0.488603 (y, z, x) in the slots m = -1, 0, 1. Slots are l(l+1)+m
// (sh/index.h); order n means l < n.
//
// Frames. The basis is a function of three components: theta is measured from the third, phi from
// the first towards the second. Two frames use it:
//   world frame  (x, y, z) = world (X, Y, Z). A light from world +X, +Y, +Z puts all its degree 1
//                into slot 3, 1, 2. Coefficients that are stored, exported or dotted with a
//                transfer vector are in this frame.
//   map frame    (x, y, z) = world (Z, X, Y), a cyclic turn, hence a rotation. theta is the angle
//                from world up (+Y), as a lat-long map's rows have it, phi the azimuth from world
//                +Z towards +X. Lights from world +X, +Y, +Z go to slots 1, 2, 3. Transforms of
//                maps work in it.
// Zonal convolution is the same in both.
#pragma once

namespace airlight {

/// Y_lm of the direction (x, y, z) for l < order, order >= 0, into out[order^2].
///
/// Only the direction counts: any finite vector will do, denormal or of length 10^308, and is
/// normalised. The zero vector, which has none, counts as (0, 0, 1); if a component is not finite,
/// all of out is NaN. At a pole, out is exactly 0 for m != 0.
///
/// Error, in units of 2^-52 sqrt((2l+1)/(4 pi)), the square root being the root mean square of Y_lm
/// over the sphere and m: under 4 + 1.5 l up to order 4096 (measured at poles and elsewhere: 5.4
/// for order 16, 13 for 64, 30 for 512, 120 for 4096; docs/BASIS_ACCURACY.md has all). What grows
/// with l is the rounding of theta and phi. The float overload computes in double and rounds once.
///
/// Cost, one thread: 18 ns for order 4, 54 ns for 8, 0.19 us for 16, 0.84 us for 32, 1.1 ms for
/// 512, 0.11 s for 4096. Up to order 64 the factors of the recurrence are tabulated. For many
/// directions at once take sh/basis_batch.h.
void evaluate_basis(int order, double x, double y, double z, double* out);
void evaluate_basis(int order, float x, float y, float z, float* out);

/// P_lm(cos theta) for one m, 0 <= m, and l = m ... order-1 into out[order - m] (none if m >=
/// order).
///
/// cos_theta in [-1, 1] and sin_theta in [0, 1] describe the same theta; where |cos_theta| >= 0.7
/// the sine decides, so it must be accurate beside the poles, otherwise the cosine. At that exact
/// input the error, in the units above, is under 4, 9, 20 for l < 64, 512, 4096 (under 4 but for
/// theta < 0.02 from a pole), and the sum over m of the squares is right to 35 eps. Results under
/// 2^-900 = 1e-271 may become 0; those that grow from such values are as accurate as the others, as
/// the recurrence carries its own exponent.
///
/// With delta = 1 - |cos theta|, the recurrence runs on differences,
///     D_l+1 = r ((l-m) D_l - (2l+1) delta P_l) / (l+m+1),  P_l+1 = r P_l + D_l+1,
///     r = sqrt((2l+3) (l+m+1) / ((2l+1) (l-m+1))),
/// which keeps rounding from growing like l^2 at the pole; nearer to the equator than 60 degrees
/// it is the three-term one ([DLMF] 14.10.3, normalised).
void normalized_legendre(int order, double cos_theta, double sin_theta, int m, double* out);

}  // namespace airlight
