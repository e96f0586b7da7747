// SPDX-License-Identifier: Apache-2.0
// The ladder of methods for the line integral of a Gaussian, by name.
#pragma once

#include <optional>
#include <string_view>

namespace airlight {

/// The rungs, cheapest first. fast-erf and erf are [Zhou07] eq. 31 as printed, a difference of two
/// error functions; exact is gaussian_line() in medium/gaussian_density.h. Errors over
/// tests/reference/gauss_line.csv (213 rows with a value above 1e-290): the absolute one in units
/// of c sqrt(pi) / a, which is what a picture sees, how many rows come out as 0 or below, and
/// the largest relative error of the others. Nanoseconds by bench/gaussian_bench.cpp.
///
///     method     absolute   zeros   relative
///     fast-erf   1.2e-4     see the test
///     erf        1e-16
///     exact      1e-16      0       6e-16
enum class GaussianLineMethod { fast_erf, erf, exact };

struct GaussianLineMethodInfo {
    GaussianLineMethod method;
    std::string_view name;  ///< as on the command line
};

/// Every method with its name, in the order of the enum.
inline constexpr GaussianLineMethodInfo kGaussianLineMethods[] = {
    {GaussianLineMethod::fast_erf, "fast-erf"},
    {GaussianLineMethod::erf, "erf"},
    {GaussianLineMethod::exact, "exact"},
};

std::string_view gaussian_line_method_name(GaussianLineMethod method);

/// Nothing when no method has that name.
std::optional<GaussianLineMethod> gaussian_line_method_from_name(std::string_view name);

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
