// SPDX-License-Identifier: Apache-2.0
// Chords of the unit sphere, which give small angles without cancellation.
#pragma once

#include <algorithm>
#include <cmath>

namespace airlight {

/// 4 sin^2(angle / 2) = 2 - 2 cos(angle), the squared distance of two directions that far apart.
inline double squared_chord(double angle) {
    const double half = std::sin(0.5 * angle);
    return 4 * half * half;
}

/// The angle, in [0, pi], of a squared chord in [0, 4]; larger ones count as 4.
inline double angle_of_squared_chord(double t) {
    return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(t)));
}

}  // namespace airlight
