// SPDX-License-Identifier: Apache-2.0
// The one integral behind airlight, point spread function and F(u, v), in its reduced form:
//
//     H(y, theta, X) = int_0^X e^{-y x} / (x^2 + 2 x cos(theta) + 1) dx
//
// y in [0, inf], theta in [0, pi/2], X in [0, inf]; the integrand is positive and at most 1.
#pragma once

#include <limits>

#include "core/constants.h"

namespace airlight {
namespace detail {

/// pi as a double, and the float next above it as a double: an angle in between is the pi of a
/// caller who works in float, or who added up to it.
constexpr double kPiOfFloat = 3.1415927410125732;

/// gamma with the rounded pi brought back to pi; outside [0, kPiOfFloat] and for NaN: NaN.
inline double checked_angle(double gamma) {
    if (!(gamma >= 0 && gamma <= kPiOfFloat)) return std::numeric_limits<double>::quiet_NaN();
    return gamma < kPi ? gamma : kPi;
}

/// An angle theta in [0, pi/2] by its value and both ratios, each to full relative accuracy.
struct RayAngle {
    double theta;
    double cos_theta;
    double sin_theta;
};

/// theta = (pi - gamma) / 2 for gamma in [0, pi], relatively accurate up to the double next to pi;
/// cos(theta) = sin(gamma / 2). H of a ray that leaves the viewer at gamma to the source uses it.
RayAngle ray_angle(double gamma);

/// H(y, theta, inf) = -Im(e^z E1(z)) / sin(theta) with z = y e^{i theta}, by the series of E1 for
/// y < 2 - cos(theta) / 2 and by Gauss-Laguerre rules of 80 and 24 nodes beyond. Relative accuracy
/// 1.2e-14 (measured, worst just under that bound at theta = 0; 2e-15 above it).
double infinite_ray_integral(double y, const RayAngle& angle);

/// H(y, theta, X) / X, in (0, 1]; 1 at X = 0 and 0 at X = inf. A short segment is Gauss-Legendre
/// in x, a long one H(inf) less its tail, which is another infinite ray; neither cancels.
/// Relative accuracy 3e-14 (measured).
double mean_ray_integral(double y, const RayAngle& angle, double x_end);

/// H(y, theta, X), infinite X included.
double finite_ray_integral(double y, const RayAngle& angle, double x_end);

}  // namespace detail
}  // namespace airlight
