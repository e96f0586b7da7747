// SPDX-License-Identifier: Apache-2.0
#include "medium/refracted_path.h"

#include <algorithm>
#include <cmath>

#include "medium/refraction.h"

namespace airlight {
namespace {

/// The path through two layers, of thickness `low` and index n_low, `high` and n_high >= n_low,
/// that spans `across` sideways.
struct BentPath {
    double cosine_low, cosine_high;
    bool exists;
};

/// Snell's law for t = tan(theta_low): low t + high tan(theta_high) = across. The left side is
/// concave, so that Newton's steps from below stay below; no cosine is a difference.
BentPath bent_path(double low, double high, double across, double n_low, double n_high) {
    const double r = n_low / n_high, gap = (n_high - n_low) * (n_high + n_low) / n_high / n_high;
    const double most = r / std::sqrt(gap);  // tan(theta_high) of a grazing ray
    if (low == 0) {
        const double tangent = across / high;
        if (!(tangent < most)) return {0, 0, false};
        const double cosine = 1 / std::hypot(1, tangent);
        const double sine = tangent * cosine / r;
        return {std::sqrt((1 - sine) * (1 + sine)), cosine, true};
    }
    double t = std::max(across / (low + high * r), (across - high * most) / low);
    double cosine = 1, cosine_high = 1;
    for (int i = 0; i < 60; ++i) {
        cosine = 1 / std::hypot(1, t);
        const double sine = t * cosine;
        cosine_high = std::hypot(cosine, std::sqrt(gap) * sine);
        const double value = low * t + high * (r * sine / cosine_high) - across;
        const double turn = cosine / cosine_high;
        const double step = value / (low + high * r * turn * turn * turn);
        if (!(std::abs(step) > 2e-16 * t)) break;
        t = std::max(0.0, t - step);
    }
    return {cosine, cosine_high, true};
}

}  // namespace

RefractedPath refracted_path(double height, double depth, double across, double ior_above,
                             double ior_below) {
    const bool denser = ior_below > ior_above;
    const BentPath path = denser ? bent_path(height, depth, across, ior_above, ior_below)
                                 : bent_path(depth, height, across, ior_below, ior_above);
    RefractedPath result;
    if (!path.exists) return result;
    const double c1 = denser ? path.cosine_low : path.cosine_high;
    const double c2 = denser ? path.cosine_high : path.cosine_low;
    result.exists = true;
    result.cosine_above = c1;
    result.cosine_below = c2;
    result.above = height / c1;
    result.below = depth > 0 ? depth / c2 : 0;
    const double r = ior_above / ior_below, turn = c1 / c2;
    const double spread =
        (result.above + r * result.below) * (result.above + r * result.below * turn * turn);
    result.irradiance = beam_transmittance(c1, c2, ior_above, ior_below) / spread;
    return result;
}

}  // namespace airlight
