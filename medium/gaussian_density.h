// SPDX-License-Identifier: Apache-2.0
// A Gaussian blob of fog: its density and the optical depth of a ray through it.
#pragma once

#include <glm/vec3.hpp>

namespace airlight {

/// One Gaussian of a medium, [Zhou07] eq. 7: the extinction coefficient at x [1/m] is
///     beta(x) = amplitude exp(-scale^2 |x - center|^2).
/// center [m] finite, scale [1/m] and amplitude [1/m] in [0, inf); scale 0 is a uniform medium.
struct GaussianBlob {
    glm::dvec3 center{0};
    double scale = 1;
    double amplitude = 0;
};

/// beta(x) [1/m]; x finite. Anything outside the domain gives NaN. Relative 3e-13.
double gaussian_density(const GaussianBlob& blob, const glm::dvec3& x);

/// Where a ray passes a blob: the distance of the center from the line, and the signed distance
/// from the origin to the point of the line next to the center.
struct GaussianPass {
    double rho_perp;
    double m_proj;
};

/// The direction must be unit: |direction|^2 within 1e-5 of 1 is accepted and normalised, anything
/// else gives two NaN. rho_perp is a cross product, so its error is a rounding of |center - origin|
/// and not the square root of one.
GaussianPass gaussian_pass(const glm::dvec3& center, const glm::dvec3& origin,
                           const glm::dvec3& direction);

/// Optical depth of a segment through one Gaussian, [Zhou07] eq. 31:
///     c exp(-a^2 rho_perp^2) int_0^dist exp(-a^2 (t - m_proj)^2) dt.
///
/// a, c, rho_perp  in [0, inf)
/// m_proj          finite, either sign
/// dist            in [0, inf]; inf is a ray that meets nothing
///
/// Corners: a = 0 gives c dist, inf included; c = 0 or dist = 0 give 0. Anything outside the
/// domain, NaN included, gives NaN. Over- and underflow happen to the result, never on the way.
/// Accuracy: relative 3e-15 in double (measured against 60 digits, a, c, rho_perp and dist from
/// 1e-300 to 1e300, values down to 1e-307), one rounding in float. 50 ns.
///
/// Deviates: eq. 31 is a difference of two error functions, 0 or noise wherever the segment lies
/// outside the blob. Here a segment beyond the peak is
/// exp(-lo^2) (erfcx(lo) - exp(-w (2 lo + w)) erfcx(lo + w)) sqrt(pi) / (2 a) with lo and w its
/// start and length in units of 1 / a, and a short one a Gauss-Legendre rule; the exponents are
/// summed with their rounding errors before the one exp.
double gaussian_line(double a, double c, double rho_perp, double m_proj, double dist);
float gaussian_line(float a, float c, float rho_perp, float m_proj, float dist);

/// The distance at which gaussian_line reaches `tau`, for the same a, c, rho_perp, m_proj and a
/// tau in [0, inf]: inf where the whole ray holds no more than tau > 0, and 0 for tau = 0. Judged
/// in optical depth, line(inverse(tau)) = tau to relative 1e-13 (float: to a rounding of the
/// distance), wherever neighbouring distances are that close; 700 ns.
double gaussian_line_inverse(double a, double c, double rho_perp, double m_proj, double tau);
float gaussian_line_inverse(float a, float c, float rho_perp, float m_proj, float tau);

/// Optical depth through `blob` from `origin` over `dist` in [0, inf] metres along the unit
/// direction (as in gaussian_pass).
double gaussian_optical_depth(const GaussianBlob& blob, const glm::dvec3& origin,
                              const glm::dvec3& direction, double dist);

/// The same between two points; the same value from either end.
double gaussian_optical_depth(const GaussianBlob& blob, const glm::dvec3& from,
                              const glm::dvec3& to);

}  // namespace airlight
