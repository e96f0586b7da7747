// SPDX-License-Identifier: Apache-2.0
// Spherical-harmonic coefficients of the point spread functions of medium/psf.h.
//
// The integral over the angle g_l = 2 pi int PSF_T Y_l0 sin(gamma) d gamma oscillates l times
// and has a pole at gamma = 0. It is never taken. With y the path beyond the shortest one in units
// of the source's distance,
//     PSF_T(gamma) e^T / T = 1/(2 pi) int_0^inf e^{-T y} / (1 + (1+y)^2 - 2 (1+y) cos gamma) dy,
// and Neumann's integral turns the average of each such kernel over P_l into a Legendre function of
// the second kind ([DLMF] 14.12), 1 + y = e^t:
//     lambda_l = T e^-T int_0^inf e^{-T (e^t - 1)} Q_l(cosh t) dt.
// With Q_l's integral over e^{-(l+1/2) s} it becomes one Laplace transform for all l,
//     lambda_l = T e^-T int_0^inf e^{-(l+1/2) s} M_T(s) ds,
//     M_T(s) = int_0^{pi/2} e^{-2 T q (q + sqrt(1+q^2))} / sqrt(1+q^2) dp,  q = sinh(s/2) sin p.
// Every integrand is smooth and positive, so nothing cancels for any T or l. M_T(0) = pi/2 is the
// singular part 1 / (8 sin(gamma/2)) of PSF_T e^T / T, with lambda_l = pi / (2l+1) exactly.
//
// Deviates: [Zhou07] sec. 4 projects the function of the angle, whose sampled peak limits the
// accuracy and whose oscillation costs time; this transform has neither.
#pragma once

#include <vector>

namespace airlight {

/// Eigenvalues lambda_l / (T e^-T), l = 0 ... order-1, of PSF_T at the optical thickness T >= 0:
/// what convolution with PSF_T e^T / T multiplies degree l by. All are positive and fall with l.
///     T -> 0:    those of (pi - gamma) / (4 pi sin gamma)
///     l -> inf:  pi / (2l+1) - T / (l(l+1)) + O(l^-3)
/// Accuracy: relative 1e-14 for every l, measured to l = 16383 at T = 0 and to l = 4095 for T up to
/// 10^4 (2.3e-15 there).
/// Cost, one thread: 5 ms for order 4096.
/// Throws Error (data) if T is negative or not finite.
std::vector<double> psf_eigenvalues_scaled(double optical_thickness, int order);

/// Zonal coefficients g_l of PSF_T e^T / T: sqrt((2l+1) / (4 pi)) times psf_eigenvalues_scaled.
std::vector<double> psf_zonal_scaled(double optical_thickness, int order);

/// Zonal coefficients g_l of PSF_T, T e^-T psf_zonal_scaled: 0 for T = 0, and from T = 745 on
/// by underflow. The average of PSF_T over the sphere is g_0 / sqrt(4 pi).
std::vector<double> psf_zonal(double optical_thickness, int order);

/// Zonal coefficients g_l of the normalised point spread function NPSF = e PSF_1.
///
/// Deviates: the first six differ from the list in [Zhou07] sec. 4, 0.332818, 0.332488, 0.302428,
/// 0.275773, 0.254051, 0.236333, which is high by 6e-6 ... 2.7e-5; exact are 0.332812364,
/// 0.332478515, 0.302415159, 0.275755963, 0.254028978, 0.236305833.
std::vector<double> npsf_zonal(int order);

}  // namespace airlight
