// SPDX-License-Identifier: Apache-2.0
#include "medium/refraction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace airlight {

SurfaceCrossing surface_crossing(double cosine, double ior_from, double ior_to) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!(cosine >= 0 && cosine <= 1 + 1e-6 && ior_from > 0 && ior_from < infinity && ior_to > 0 &&
          ior_to < infinity)) {
        return {nan, nan, nan, nan, nan, false};
    }
    const double c1 = std::min(cosine, 1.0);
    if (ior_from == ior_to) return {c1, 0, 1, 1, 1, false};
    // Only the ratio matters; a power of two keeps the squares in range.
    const int exponent = -std::ilogb(std::max(ior_from, ior_to));
    const double n1 = std::scalbn(ior_from, exponent), n2 = std::scalbn(ior_to, exponent);
    const double difference = (n2 - n1) * (n2 + n1);
    const double before = n1 * c1;
    const double root = std::sqrt(std::abs(difference));
    if (difference < 0 && before <= root) return {0, 1, 0, 0, 0, true};
    const double beyond =
        difference > 0 ? std::hypot(root, before) : std::sqrt((before - root) * (before + root));
    const double c2 = std::min(beyond / n2, 1.0);
    const double s1 = std::sqrt((1 - c1) * (1 + c1));
    const double across = before + n2 * c2, along = n2 * c1 + n1 * c2;
    const double r_s = difference / across / across;
    const double turned = (n2 * c1 - n1 * s1) / along;
    const double r_p = turned * ((n2 * c1 + n1 * s1) / along) * difference / n2 / n2;
    const double t_s = 4 * (before / across) * (n2 * c2 / across);
    const double t_p = 4 * (n2 * c1 / along) * (n1 * c2 / along);
    const double transmittance = std::min(0.5 * (t_s + t_p), 1.0);
    const double ratio = ior_to / ior_from;
    return {c2,
            std::min(0.5 * (r_s * r_s + r_p * r_p), 1.0),
            transmittance,
            transmittance * ratio * ratio,
            beam_transmittance(c1, c2, ior_from, ior_to),
            false};
}

double beam_transmittance(double cosine_before, double cosine_after, double ior_from,
                          double ior_to) {
    const double across = ior_from * cosine_before + ior_to * cosine_after;
    const double along = ior_to * cosine_before + ior_from * cosine_after;
    const double from = ior_from * cosine_before, to = ior_to * cosine_before;
    return 2 * ((from / across) * (to / across) + (from / along) * (to / along));
}

}  // namespace airlight
