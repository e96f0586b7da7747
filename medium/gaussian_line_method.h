// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the line integral of a Gaussian, by name.
#pragma once

#include "core/method_names.h"

namespace airlight {

/// The rungs, cheapest first. fast-erf and erf are [Zhou07] eq. 31 as printed, a difference of two
/// error functions; exact is gaussian_line() in medium/gaussian_density.h. Nanoseconds and largest
/// absolute error in units of c sqrt(pi) / a, which is what a picture sees, on segments in and
/// beside a blob (bench/gaussian_bench.cpp); and of the 216 rows of tests/reference/gauss_line.csv,
/// 201 of which a double holds, how many are wrong by more than 1e-6 of their value.
///
///     method      double ns, error   float ns, error   wrong rows
///     fast-erf    23   1.2e-4        23   1.2e-4       168
///     erf         39   4e-16         42   1.4e-7       30
///     exact       48   0             53   5e-8         0
enum class GaussianLineMethod { fast_erf, erf, exact };

/// Every method with its name, in the order of the enum.
inline constexpr NamedMethod<GaussianLineMethod> kGaussianLineMethods[] = {
    {GaussianLineMethod::fast_erf, "fast-erf"},
    {GaussianLineMethod::erf, "erf"},
    {GaussianLineMethod::exact, "exact"},
};

/// One rung. Domain and corners as gaussian_line(); a difference that rounding or the fit made
/// negative gives 0. float works in float throughout.
double gaussian_line(GaussianLineMethod method, double a, double c, double rho_perp, double m_proj,
                     double dist);
float gaussian_line(GaussianLineMethod method, float a, float c, float rho_perp, float m_proj,
                    float dist);

/// The error function by a polynomial, the form of [Zhou07] appendix A: x P(z) with
/// z = .289226 x^2 - 1 for |x| <= 2.629639, the sign of x beyond. Absolute error 2.0013e-4, all of
/// it at the switch; 1.3e-4 within. NaN gives NaN.
///
/// Deviates: the paper's coefficients are missing from our copy of the text; these seven are a
/// Chebyshev fit of our own. The paper states an error below 2e-4, but the switch alone costs
/// 1 - erf(2.629639) = 2.0012e-4.
double fast_erf(double x);
float fast_erf(float x);

}  // namespace airlight
