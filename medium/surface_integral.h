// SPDX-License-Identifier: Apache-2.0
// The quadrature behind medium/surface_radiance.h.
#pragma once

#include "medium/lobe_ring.h"

namespace airlight {
namespace detail {

/// G_n(T, theta) e^T for theta in [0, pi], T in [0, inf) and n = ring.exponent(). In polar
/// coordinates about the source, with s = sin(gamma/2) and H of medium/ray_integral.h,
///
///     G_n e^T = int_0^pi H(2 T s, s) cos(gamma/2) A_n(gamma, theta) d gamma,
///
/// A_n the integral of the lobe over the circle of directions at gamma from the source. Nothing in
/// it is singular. What is left to mind:
///   the edge of the lobe's hemisphere: A_n has kinks of order n + 1/2 at delta = |pi/2 - theta|
///     and at pi - delta. Up to n = 24 the range is cut there, and tanh-sinh rules, whose nodes
///     know their distance from the ends, take the kinks, any scale next to them (theta near 0,
///     pi/2, pi) and the logarithm at gamma = 0;
///   the scale 1/T at gamma = 0: the variable is ln(1 + gamma max(1, T)), and long ranges of it are
///     cut once more. Beyond T = 10^17 the value is exactly (constant + A_n(0) ln T) / T;
///   a lobe of width 1/sqrt(n): from n = 16 on nothing beyond e^{-43} of its peak is looked at, and
///     from n = 20 on a lobe that stays clear of gamma = 0 and pi is summed by plain trapezoids.
/// 80 to 250 values of H and A_n. `fineness` 1 is what surface_radiance uses, 2 halves every step
/// and is there to test it: they agree to 5e-14.
double surface_integral(double t, double theta, const LobeRing& ring, int fineness = 1);

}  // namespace detail
}  // namespace airlight
