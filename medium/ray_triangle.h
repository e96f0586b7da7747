// SPDX-License-Identifier: Apache-2.0
// The triangle of viewer, light and end of the ray, reduced to the variables of the ray integral.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/ray_integral.h"

namespace airlight {
namespace detail {

/// With theta = (pi - gamma) / 2, J e^{T_sv} = 2 H(y, theta, X) / y (see ray_integral.h), where y
/// is the distance from the light to the point of the ray that is as far from the viewer as the
/// light and X = P / y, with P = T_vp + d(T_vp) - T_sv the excess path of the whole ray.
template <class Real>
struct RayTriangle {
    Real gamma;
    Real cos_theta;  ///< sin(gamma / 2)
    Real sin_theta;  ///< cos(gamma / 2)
    Real rho;        ///< 2 sin(gamma / 2), at full precision down to denormals
    Real y;          ///< rho T_sv
    Real x_end;      ///< X, infinite rays included
    Real x_per_rho;  ///< X / rho where ends_near, finite where both vanish
    bool ends_near;  ///< the ray ends on the viewer's side of the light
};

/// gamma in [0, pi], 0 < t_sv < inf, 0 < t_vp <= inf. X is good to a few units in the last place:
/// no difference of nearly equal numbers is taken but t_vp - t_sv itself.
template <class Real>
RayTriangle<Real> ray_triangle(Real gamma, Real t_sv, Real t_vp) {
    RayTriangle<Real> r;
    r.gamma = gamma;
    r.cos_theta = std::sin(gamma / 2);
    r.sin_theta = std::cos(gamma / 2);
    // Halving a denormal gamma would round it away.
    r.rho = gamma < Real(1e-10) ? gamma : 2 * r.cos_theta;
    // An infinite y would meet X = 0.
    r.y = std::min(r.rho * t_sv, std::numeric_limits<Real>::max());
    r.ends_near = false;
    r.x_per_rho = 0;
    r.x_end = std::numeric_limits<Real>::infinity();
    // All lengths in units of t_sv.
    const Real end = t_vp / t_sv;
    if (end > Real(1e20)) return r;
    const Real beyond = (t_vp - t_sv) / t_sv;
    const Real chord = r.rho * std::sqrt(end);
    const bool squares_underflow = r.rho < std::numeric_limits<Real>::min() * Real(1e20) ||
                                   chord < std::sqrt(std::numeric_limits<Real>::min()) * 1024;
    const Real distance =
        squares_underflow ? std::hypot(beyond, chord) : std::sqrt(beyond * beyond + chord * chord);
    const Real projected = beyond + r.rho * r.rho / 2;
    const Real perimeter = end + distance + 1;
    if (projected < 0) {
        r.ends_near = true;
        r.x_per_rho = 2 * end * r.sin_theta * r.sin_theta / ((distance - projected) * perimeter);
        r.x_end = r.rho * r.x_per_rho;
    } else {
        r.x_end = 2 * end * (projected + distance) / (r.rho * perimeter);
    }
    return r;
}

/// airlight(gamma, t_sv, t_vp) e^{t_sv} transmittance^2, corners included, through
/// integral(triangle), which returns H / X for a ray that ends_near and H for any other. The
/// transmittance comes as two equal factors, neither denormal while their product is not.
template <class Real, class Integral>
Real airlight_by(Real gamma, Real t_sv, Real t_vp, Real transmittance, const Integral& integral) {
    gamma = static_cast<Real>(checked_angle(gamma));
    if (!(gamma >= 0 && t_sv >= 0 && t_vp >= 0)) return std::numeric_limits<Real>::quiet_NaN();
    if (t_vp == 0) return 0;
    if (t_sv == 0 || (gamma == 0 && t_vp >= t_sv)) return std::numeric_limits<Real>::infinity();
    if (std::isinf(t_sv)) return 0;
    const RayTriangle<Real> r = ray_triangle(gamma, t_sv, t_vp);
    const Real value = integral(r) * (transmittance / static_cast<Real>(2 * kPi));
    // The order of the divisions keeps every intermediate value in range when the result is.
    if (r.ends_near) return value * r.x_per_rho * transmittance / t_sv;
    if (t_sv < 1) return value / r.rho * transmittance / t_sv;
    const Real result = value / r.y * transmittance;
    // A peaked phase function lifts what a denormal angle has lifted already.
    return std::isinf(result) ? value * transmittance / r.y : result;
}

}  // namespace detail
}  // namespace airlight
