// SPDX-License-Identifier: Apache-2.0
// The quadrature behind the near-light integrals of the slab.
#pragma once

#include <optional>

namespace airlight {
namespace detail {

/// The integral [Slab] eq. 7 in units of the light's distance l, y = x / l and T = sigma_t l:
///
///     int_0^S e^{-T (y + f H)} H^{-power} dy,
///     H^2 = y^2 + 2 g y + 1,   f = y / (y + rho)
///
/// H is the distance to the light and f the part of it inside the medium. The exponent grows with y
/// whatever the arguments, for H falls no faster than y grows.
struct SlabRay {
    double thickness;  ///< T, finite
    double g;          ///< w . wl, in [-1, 1]
    double rho;        ///< (wl . n) / (w . n), in [0, inf]
    double end;        ///< S, in [0, inf]
    double beyond;     ///< S - 1 without cancellation, (s - l) / l
    int power;         ///< 2: point light; 0: a light without falloff
};

/// int_0^S dy / H^2 = atan2(q S, 1 + g S) / q with q = sqrt(1 - g^2); +inf for a ray through the
/// light.
double slab_angle(double g, double end, double beyond);

/// The integral by panels of 16-node Gauss-Legendre (or `nodes`, see gauss_legendre()), in
/// ln(y + rho) while the light enters the medium at a grazing angle nearby, and in the w of
/// y + g = q sinh(w) from there, for dy / H^2 = dw / H and H = q cosh(w) has no scale of its own.
/// A panel ends where the singularities of the integrand (the light's image off the real axis, the
/// pole of f at y = -rho) or a growth of the exponent by 6 tell it to; the integral, where its
/// remainder has a bound under 1e-17 of the sum.
double slab_integral(const SlabRay& ray, int nodes);

/// The rule of the exact functions. Largest relative error over the golden rows and corners of
/// tests/reference by nodes per panel: 6: 2e-5, 8: 1.4e-7, 12: 7e-12, 16: 2.4e-14.
inline constexpr int kSlabNodes = 16;

struct SlabCosines {
    double w_dot_n, wl_dot_n, w_dot_wl;
};

/// The cosines brought back to [0, 1] and [-1, 1], nothing where one is NaN or further out than
/// 1e-6.
std::optional<SlabCosines> slab_cosines(double w_dot_n, double wl_dot_n, double w_dot_wl);

/// slab_near() for power 2 and slab_near_flat() for power 0 (medium/slab.h), with a choice of rule.
double slab_near_by(double sigma_t, double s, double l, double w_dot_n, double wl_dot_n,
                    double w_dot_wl, int power, int nodes);

}  // namespace detail
}  // namespace airlight
