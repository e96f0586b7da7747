// SPDX-License-Identifier: Apache-2.0
// Light of an isotropic point source that reaches a surface by way of a uniform fog.
#pragma once

namespace airlight {

/// The surface radiance function of [Sun05] eq. 16 with a lobe of any exponent,
///
///     G_n(T, theta) = int_hemisphere T/2 J(gamma', T) cos^n theta_i d omega_i
///                   = 2 pi / T int PSF_T(gamma') max(0, cos theta_i)^n d omega_i,
///
/// where J is the integral of medium/airlight.h for infinite rays, gamma' the angle of omega_i to
/// the source and theta_i its angle to the axis of the lobe.
///
/// t_sp     T, optical thickness from the surface point to the source, in [0, inf]
/// theta_s  angle between the axis of the lobe and the direction to the source [rad], in [0, pi]
/// exponent n, real, in [1, 1000]. A Lambertian surface is n = 1 about its normal: what the paper
///          calls G_0. A Phong lobe has its n about the mirrored direction of view. The hemisphere
///          is always that about the axis of the lobe.
///
/// With G_n, the radiance that the surface sends on is f sigma_s sigma_t I_0 / (2 pi T) G_n, f its
/// reflectance: medium/surface_shading.h.
///
/// Corners: at T = 0 the limit, int (pi - gamma') / (2 sin gamma') cos^n d omega; G_1(0, 0) is
/// pi (pi/2 + 1). At T = inf, 0. theta_s beyond pi/2 is ordinary: the fog lights a surface from
/// all sides. Anything outside the domain, NaN included, gives NaN; a theta_s that rounding put
/// above pi, up to the float next above it, 3.14159274, stands for pi.
///
/// Accuracy: relative 1e-13 in double (measured 6e-14 over the whole domain), one rounding more in
/// float. Cost: 12 us for n = 1, 15 to 34 us for n >= 2, 27 to 62 us for a real n in between.
///
/// Deviates: [Sun05] integrates over the hemisphere about the normal, where the integrand has a
/// pole at the source; about the source it has none. The paper's G_0 is n = 1, not n = 0.
double surface_radiance(double t_sp, double theta_s, double exponent);
float surface_radiance(float t_sp, float theta_s, float exponent);

/// G_n e^T, which does not underflow: for T -> inf it falls like (constant + 2 pi cos^n(theta_s)
/// ln T) / T, the second term only in front, theta_s < pi/2. Same domain, accuracy and cost.
double surface_radiance_scaled(double t_sp, double theta_s, double exponent);
float surface_radiance_scaled(float t_sp, float theta_s, float exponent);

}  // namespace airlight
