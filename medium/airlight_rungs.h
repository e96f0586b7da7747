// SPDX-License-Identifier: Apache-2.0
// Airlight by quadrature and closed form: the rungs of the ladder that need no table.
//
// All have the meaning, the domain and the corners of airlight() in medium/airlight.h. Errors are
// the largest relative ones on the sets of bench/airlight_bench.cpp,
//     A: t_sv, t_vp < 2, gamma in [.02, 2.5];   B: t_sv, t_vp < 10, gamma in (0, pi).
#pragma once

namespace airlight {

/// Gauss-Legendre with `nodes` nodes (6, 8, 12, 16, 24 or 32) on one panel in t, where the excess
/// path is p = y (sinh t + 2 cos(theta) sinh^2(t/2)): the integrand is then analytic in a strip of
/// half-width pi/2 whatever the triangle, and a long ray costs no more than a short one. The panel
/// grows like the logarithm of its range: with t_sv down to 1e-8 and gamma down to 1e-30 the errors
/// of 6 ... 32 nodes are 9e-2, 7e-2, 4e-3, 4e-4, 7e-6 and 1.3e-7.
double airlight_sinh_gl(double gamma, double t_sv, double t_vp, int nodes);

/// The same in float arithmetic throughout, 7e-7 with 32 nodes over the whole domain and 6e-7 with
/// 16 on A and B.
float airlight_sinh_gl(float gamma, float t_sv, float t_vp, int nodes);

/// The closed form with G(z) = e^z E1(z) [DLMF 6.2.1],
///     J = 2 / (T_sv sin gamma) Im{e^{-T_sv} G(T_sv (1 - e^{i gamma}))
///                                 - e^{-T_vp - d} G(T_vp + d - T_sv e^{i gamma})},
/// by the series of E1 for |z| < 2.5 and Lentz's continued fraction beyond. Where the imaginary
/// part keeps less than a twentieth of the first term it would lose digits: airlight() answers.
/// Relative error 5e-13.
double airlight_e1(double gamma, double t_sv, double t_vp);

/// Midpoint rule with `steps` >= 1 equal steps along the ray, the method of a ray marcher. The ray
/// is cut where the excess path reaches 40, 4e-18 of the transmittance.
double airlight_march(double gamma, double t_sv, double t_vp, int steps);

}  // namespace airlight
