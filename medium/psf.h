// SPDX-License-Identifier: Apache-2.0
// The point spread function of a uniform, isotropically scattering medium.
#pragma once

namespace airlight {

/// Which point spread function a caller uses.
enum class PsfForm {
    exact,     ///< the single-scattering integral at that optical thickness
    factored,  ///< T e^-T NPSF(gamma), [Sun05] eq. 22
};

/// Point spread function of single scattering [1/sr], albedo 1:
///     PSF_T(gamma) = T^2 / (4 pi) J(gamma, T),  J = int_0^inf e^{-t-d} / d^2 dt,
///     d^2 = t^2 + T^2 - 2 t T cos gamma,
/// the radiance seen at the angle `gamma` from a source at optical thickness T, divided by the
/// source's radiant intensity over its squared distance ([Sun05] sec. 6.1, D_sv^2 L_a / I_0).
///
/// Domain: optical_thickness in [0, inf], gamma in [0, pi] radians; a gamma that rounding put
/// above pi, up to the float next above it, 3.14159274, stands for pi. Anything else, NaN included,
/// gives NaN. gamma = 0 gives +inf, the
/// value, except that PSF_0 = 0. Underflow is gradual: for T > 745 the result is 0.
/// Accuracy: relative 1e-13 in double, 1e-6 in float.
double psf(double optical_thickness, double gamma);
float psf(float optical_thickness, float gamma);

/// PSF_T(gamma) e^T / T, which neither underflows for a large T nor vanishes for a small one:
///     T -> 0:      (pi - gamma) / (4 pi sin gamma)
///     T -> inf:    1 / (8 pi T sin^2(gamma / 2))
///     gamma -> 0:  1 / (4 gamma)
///     gamma = pi:  finite
/// Same domain and accuracy as psf; T = 0 gives the limit, gamma = 0 gives +inf.
double psf_scaled(double optical_thickness, double gamma);
float psf_scaled(float optical_thickness, float gamma);

/// The normalised point spread function, e PSF_1(gamma) [1/sr].
double npsf(double gamma);
float npsf(float gamma);

/// T e^-T NPSF(gamma) [1/sr], the paper's factorisation ([Sun05] eq. 22). It is exact at T = 1 and
/// an approximation elsewhere: averaged over T = 0.1, 0.4 ... 3.1 the absolute error is .0061,
/// .022, .047, .081, .113 at gamma = 1, .3, .1, .03, .01, its maximum .010, .030, .068, .121, .172.
double psf_factored(double optical_thickness, double gamma);
float psf_factored(float optical_thickness, float gamma);

}  // namespace airlight
