// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "core/constants.h"
#include "sh/brdf.h"

namespace airlight {

// A function that is neither reciprocal nor the same when mirrored, so that every sign shows.
inline glm::dvec3 skewed(const glm::dvec3& in, const glm::dvec3& out) {
    const double turn = in.x * out.y - in.y * out.x;
    return glm::dvec3(1, 0.5, 0.2) * ((1 + 0.8 * turn + 0.3 * (in.z - out.z)) / kPi);
}

inline BrdfTable tabulate_skewed(const BrdfSize& size) {
    BrdfTable table(size);
    const auto azimuth = static_cast<std::size_t>(size.azimuth);
    for (std::size_t i = 0; i < size.cells(); ++i) {
        const auto row = static_cast<int>(i / azimuth);
        const BrdfDirections at = brdf_directions(brdf_cell_centre(
            size, row / size.difference, row % size.difference, static_cast<int>(i % azimuth)));
        if (at.in.z <= 0 || at.out.z <= 0) continue;
        const glm::dvec3 value = skewed(at.in, at.out);
        for (int c = 0; c < 3; ++c) {
            table.channel(c)[i] = value[c] / kBrdfScale[static_cast<std::size_t>(c)];
        }
    }
    return table;
}

}  // namespace airlight
