// SPDX-License-Identifier: Apache-2.0
// The Chapman function: the column of an infinite ray through an exponential atmosphere.
#pragma once

#include "core/method_names.h"

namespace airlight {

/// Chapman's grazing incidence integral, the column of an infinite ray over that of the vertical
/// one
/// ([Golubev] eq. 42):
///     C(z, theta) = int_0^inf e^{z - sqrt(z^2 + 2 z s cos(theta) + s^2)} ds.
///
/// z           distance of the start from the center in scale heights, in [0, inf]
/// cos_theta   cosine of the zenith angle of the ray, in [-1, 1]
///
/// C(z, 0) = 1; at the horizon z e^z K_1(z); downwards 2 C(z sin, pi/2) e^{z - z sin} - C(z, pi -
/// theta), which overflows to +inf: ln_chapman does not. z = 0 gives 1, z = inf 1 / cos, and +inf
/// where cos <= 0. Arguments outside the domain, NaN included, give NaN.
///
/// Accuracy: ln C to relative 1e-15, logarithms near 0 (small z, steep rays) and of 1e20 included,
/// measured against 40 digits; C to 3e-15 where ln C < 1, and to 1e-15 ln C beyond. 230 ns,
/// downwards 450 ns; float is that of double, rounded.
///
/// Deviates: [Golubev] eq. 46 expands in 1 / z. This is
///     C = 1 + z (1 - cos) int_0^inf e^{-z (cos sinh y + cosh y - 1) - y} dy
/// by one quadrature rule, exact for every z (medium/curved_column.h).
double chapman(double z, double cos_theta);
float chapman(float z, float cos_theta);
double ln_chapman(double z, double cos_theta);
float ln_chapman(float z, float cos_theta);

/// The distance along that ray, in scale heights, at which the column is `depth`, in units of the
/// vertical column above the start. +inf if the infinite ray has less, or no more. Judged in the
/// column to 3e-15, by bracketed Halley steps (medium/spherical_density.h).
double chapman_distance(double z, double cos_theta, double depth);

/// Ways to the function, cheapest first. ns per ln C and relative error of C at z = 800 ... 5400
/// and cos_theta in [0, 1]; the errors of the rays that go down are those of the horizontal one,
/// plus, in single precision, 6e-8 of the exponent:
///
///     method         ns    error    with
///     secant         6     inf      1 / cos, a flat world: +inf at the horizon and below
///     schueler       13    .16      [Golubev] eq. 49, C_h / ((C_h - 1) cos + 1)
///     huestis-fp32   23    1.4e-6   [Golubev] eq. 46-48 and its code, in single precision
///     huestis        33    5.2e-7   [Golubev] eq. 46-48 with erfcx; the error falls like 1 / z^2
///     exact          225   1e-15    the above
///
/// huestis at z = 10, 50, 100, 1000: 2.5e-3, 1.2e-4, 3.2e-5, 3.3e-7. Its C_h has one term more than
/// its C_u at the horizon, so that C jumps there by sqrt(pi z / 2) 15 / (128 z^2).
enum class ChapmanMethod { secant, schueler, huestis_fp32, huestis, exact };

inline constexpr NamedMethod<ChapmanMethod> kChapmanMethods[] = {
    {ChapmanMethod::exact, "exact"},
    {ChapmanMethod::huestis, "huestis"},
    {ChapmanMethod::huestis_fp32, "huestis-fp32"},
    {ChapmanMethod::schueler, "schueler"},
    {ChapmanMethod::secant, "secant"},
};

/// ln C by one of the methods. Domain as ln_chapman. Where a method has no positive value (their
/// series at z near 0) it gives NaN.
double ln_chapman(double z, double cos_theta, ChapmanMethod method);

}  // namespace airlight
