// SPDX-License-Identifier: Apache-2.0
// The integral behind airlight with a phase function, in the variables of medium/ray_integral.h.
//
// A point of the ray at the reduced excess path x scatters by the angle alpha, with
//     tan(alpha / 2) = (cos(theta) + x) / sin(theta),
// gamma at the viewer and pi at infinity. The isotropic integral H takes the weight 4 pi p(alpha):
//
//     H_p(y, theta, X) = int_0^X 4 pi p(alpha(x)) e^{-y x} / (x^2 + 2 x cos(theta) + 1) dx.
//
// With cos(theta) + x = K sinh(q) and K the smaller of sin(theta) and sin(theta) (1-g)/(1+g), the
// denominators of Henyey-Greenstein become cosh(q), and every singularity of the integrand stays
// pi/2 or more from the real axis, whatever g and gamma. Panels of 16 nodes are at most 2 long in q
// and 13 in the exponent.
#pragma once

#include "medium/phase_function.h"
#include "medium/ray_integral.h"

namespace airlight {
namespace detail {

/// H_p(y, theta, X), and H_p / X with its limit for X = 0 (which is y = 0 or a vanishing segment).
/// y in [0, inf), X in [0, inf]; g in (-1, 1).
double phase_ray_integral(const PhaseFunction& phase, double y, const RayAngle& angle,
                          double x_end);
double mean_phase_ray_integral(const PhaseFunction& phase, double y, const RayAngle& angle,
                               double x_end);
double hg_ray_integral(double g, double y, const RayAngle& angle, double x_end);
double mean_hg_ray_integral(double g, double y, const RayAngle& angle, double x_end);

/// The Henyey-Greenstein integral on a single panel of `nodes` nodes, 6 ... 32 as gauss_legendre().
double hg_panel_integral(double g, double y, const RayAngle& angle, double x_end, int nodes);

}  // namespace detail
}  // namespace airlight
