// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of the lobes that lighting is made of, in closed form.
//
// Each function gives lambda_l = 2 pi int f P_l(cos gamma) sin(gamma) d gamma, l = 0 ... order-1,
// of a lobe f of the angle gamma to its axis: convolution with the lobe multiplies degree l by
// lambda_l (sh/zonal.h). zonal_coefficients() turns them into the g_l of sh/zonal.h, and
// rotate_zonal() (sh/rotation.h) those into the coefficients of the lobe about any axis.
//
// Every recurrence is of products or of positive terms, so no degree loses digits to another one;
// quadrature would need 2 order nodes and resolve no narrow lobe. All throw Error (data) where an
// argument is outside its domain, NaN included. Cost per degree, one thread
// (bench/zonal_bench.cpp): Phong 1.4 to 2.4 ns, the others 9 to 30 ns.
#pragma once

#include <vector>

namespace airlight {

/// What a lobe is scaled to.
enum class LobeScale {
    peak,      ///< f = 1 on the axis
    integral,  ///< its integral over the sphere is 1, lambda_0 = 1
};

/// The delta function: lambda_l = 1. rotate_zonal() of its g_l gives Y_lm(axis), so does
/// evaluate_basis().
std::vector<double> delta_eigenvalues(int order);

/// max(0, cos gamma): pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64 ...; divided by pi it turns
/// radiance into what a white Lambertian surface sends on. Odd degrees from 3 on are exactly 0.
/// Accuracy: relative 1e-15 sqrt(l + 1), measured to l = 1023 (8e-16).
std::vector<double> clamped_cosine_eigenvalues(int order);

/// The Phong lobe max(0, cos gamma)^exponent for a real exponent in [0, 1e300]; 0 is the
/// hemisphere, 1 the clamped cosine. With I_l = int_0^1 x^n P_l(x) dx,
///     I_0 = 1/(n+1),  I_1 = 1/(n+2),  I_l = I_{l-2} (n-l+2) / (n+l+1),
/// all terms of which are products ([DLMF] 18.17.38, real n). LobeScale::integral is the lobe
/// times (n+1) / (2 pi).
/// Accuracy at the exponent given: relative 1e-15 sqrt(l + 1), measured to l = 1023 (8e-16).
std::vector<double> phong_eigenvalues(double exponent, int order,
                                      LobeScale scale = LobeScale::peak);

/// The cone: 1 for gamma < half_angle, else 0; half_angle in [0, pi] (a sun, a lamp, the sphere
/// that hides part of the sky). An angle that rounding put just above pi, up to the float next
/// above it, is pi.
///     lambda_0 = 4 pi sin^2(a / 2),  lambda_l = 2 pi sin^2(a) P_l'(cos a) / (l (l+1)),
/// without the difference P_{l-1} - P_{l+1} of the usual form, which cancels for small a.
/// LobeScale::integral divides by lambda_0 and tends to the delta function, which a = 0 gives.
/// Accuracy: 1e-15 sqrt(l + 1) of the largest |lambda| of the degrees within 3 of l, measured to
/// l = 1023 (7e-16) for a from 1e-160 to pi.
std::vector<double> cone_eigenvalues(double half_angle, int order,
                                     LobeScale scale = LobeScale::peak);

/// What the cone leaves of the sphere: 1 for gamma > half_angle. lambda_0 = 4 pi cos^2(a / 2), the
/// others are minus those of the cone. Scaled to the integral, a = pi gives the delta function at
/// the far pole, (-1)^l.
std::vector<double> cone_complement_eigenvalues(double half_angle, int order,
                                                LobeScale scale = LobeScale::peak);

/// The spherical Gaussian exp(sharpness (cos gamma - 1)), sharpness in [0, 1e300]; beside the axis
/// it is a Gaussian of variance 1 / sharpness. lambda_l = 4 pi e^-k i_l(k), i_l the modified
/// spherical Bessel function ([DLMF] 10.47(ii)): for k >= order^2 by the finite sum of [DLMF]
/// 10.49.8, else by the ratios i_l / i_{l-1} = 1 / ((2l+1) / k + i_{l+1} / i_l) downwards.
/// All are positive and fall with l. Accuracy: relative 2e-15 sqrt(l + 1), measured to l = 1023
/// (1.4e-15); degrees whose value is under 1e-300 may be 0.
std::vector<double> gaussian_eigenvalues(double sharpness, int order,
                                         LobeScale scale = LobeScale::peak);

}  // namespace airlight
