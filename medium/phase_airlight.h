// SPDX-License-Identifier: Apache-2.0
// Airlight and point spread function of a uniform medium with any phase function.
//
// [Sun05] sec. 3.1 leaves phase functions other than the isotropic one to its appendix D, which was
// not printed. With alpha the scattering angle at a point of the ray, from gamma at the viewer to
// pi at infinity, t + d = T_sv (cos gamma + sin gamma tan(alpha/2)) and dt/d^2 = d alpha/(T_sv sin
// gamma):
//
//     L_a / (beta^2 I_0) = int_0^{T_vp} p(alpha) e^{-t-d} / d^2 dt
//         = e^{-T_sv} / (T_sv sin gamma)
//           int_gamma^{alpha_end} p(alpha) e^{-T_sv sin gamma (tan(alpha/2) - tan(gamma/2))} d
//           alpha.
#pragma once

#include "medium/phase_function.h"

namespace airlight {

/// Airlight of an isotropic point light, L_a / (beta^2 I_0), in a medium with that phase function.
/// Meaning, domain and corners of gamma, t_sv and t_vp are those of medium/airlight.h: at gamma = 0
/// a ray that ends short of the light has the closed form p(0) e^{-t_sv} t_vp / (t_sv (t_sv -
/// t_vp)), one that reaches it +inf. `scaled` leaves out the e^{-t_sv}.
///
/// Accuracy: relative 2e-15 in double for every g in (-1, 1) and 1e-14 for Rayleigh (measured
/// against 40 digits over the whole domain); 1e-12 for a table over its own interpolation;
/// isotropic as airlight(); float is double rounded once.
///
/// Cost: isotropic as airlight(); Rayleigh and Henyey-Greenstein 0.4 us for segments and 0.9 us for
/// infinite rays (thicknesses up to 10), 3 us in nearly no medium; a table about 0.3 us for each
/// knot passed. Cheaper rungs: medium/phase_airlight_method.h.
double airlight(double gamma, double t_sv, double t_vp, const PhaseFunction& phase);
float airlight(float gamma, float t_sv, float t_vp, const PhaseFunction& phase);
double airlight_scaled(double gamma, double t_sv, double t_vp, const PhaseFunction& phase);
float airlight_scaled(float gamma, float t_sv, float t_vp, const PhaseFunction& phase);

/// The same for Henyey-Greenstein with g in (-1, 1); any other g gives NaN.
double airlight_hg(double gamma, double t_sv, double t_vp, double g);
float airlight_hg(float gamma, float t_sv, float t_vp, float g);

/// Point spread function of single scattering with that phase function [1/sr], albedo 1,
///     PSF_{T,p}(gamma) = T^2 L_a / (beta^2 I_0) of an infinite ray at T_sv = T,
/// and what belongs to it: domain, corners and forms as in medium/psf.h, accuracy as above.
///     psf_scaled    PSF e^T / T; T -> 0: int_gamma^pi p / sin(gamma);
///                   gamma -> 0: int_0^pi p / gamma
///     npsf          e PSF_{1,p}
///     psf_factored  T e^-T npsf, the factorisation of [Sun05] eq. 22 with this phase function
/// Their integral over the sphere is 4 pi T int_0^pi p(alpha) int_0^{alpha/2}
/// e^{-T cos(phi) / cos(alpha/2)} d phi d alpha; over T e^-T that tends to 2 pi int alpha p d
/// alpha.
double psf(double optical_thickness, double gamma, const PhaseFunction& phase);
float psf(float optical_thickness, float gamma, const PhaseFunction& phase);
double psf_scaled(double optical_thickness, double gamma, const PhaseFunction& phase);
float psf_scaled(float optical_thickness, float gamma, const PhaseFunction& phase);
double npsf(double gamma, const PhaseFunction& phase);
float npsf(float gamma, const PhaseFunction& phase);
double psf_factored(double optical_thickness, double gamma, const PhaseFunction& phase);
float psf_factored(float optical_thickness, float gamma, const PhaseFunction& phase);

/// The same for Henyey-Greenstein with g in (-1, 1); any other g gives NaN.
double psf_hg(double optical_thickness, double gamma, double g);
float psf_hg(float optical_thickness, float gamma, float g);

}  // namespace airlight
