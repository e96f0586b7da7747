// SPDX-License-Identifier: Apache-2.0
// The scaled complementary error function.
#pragma once

#include "core/method_names.h"

namespace airlight {

/// erfcx(x) = e^{x^2} erfc(x) = 2 / sqrt(pi) int_0^inf e^{-t^2 - 2 x t} dt, for any x.
///
/// erfcx(0) = 1, erfcx(x) x -> 1 / sqrt(pi) for x -> inf, and +inf below x = -26.63, where the
/// value leaves the range of a double (a float: below -9.37). NaN gives NaN.
///
/// Accuracy: relative 9e-16 in double against 50 digits, denormals and x = -26 included; one more
/// rounding in float. 7 ns.
double erfcx(double x);
float erfcx(float x);

/// The rational approximation of [Golubev], "Exp2Erfc": t times a polynomial of degree 9 in
/// t - 1/2, t = c / (c + x). x in [0, inf], anything else gives NaN. Measured: absolute
/// error 9.5e-7, relative 1.10e-6 for x <= 1000 and 1.74e-6 beyond, and 1.0000006 at x = 0 (with
/// fused multiply-adds 1.16e-6, 1.16e-6 and 1.76e-6), where the article states 9.7e-7 and 1.09e-6.
/// 4 ns.
float erfcx_rational9(float x);

/// The rungs, by name: `exact` and `rational9`, the two above.
enum class ErfcxMethod { exact, rational9 };

inline constexpr NamedMethod<ErfcxMethod> kErfcxMethods[] = {
    {ErfcxMethod::exact, "exact"},
    {ErfcxMethod::rational9, "rational9"},
};

}  // namespace airlight
