// SPDX-License-Identifier: Apache-2.0
#include "sh/sphere_map.h"

#include <array>
#include <cmath>

#include "core/checked.h"
#include "core/constants.h"

namespace airlight {
namespace {

struct Cubic {
    int first;
    std::array<double, 4> weight;
};

Cubic cubic(double position) {
    const double floor = std::floor(position);
    const double t = position - floor;
    return {static_cast<int>(floor) - 1,
            {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
             -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6}};
}

}  // namespace

SphereMap::SphereMap(int order, int rows)
    : rows_(rows),
      transform_(rows, 2 * rows, order - 1),
      map_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows) * 6) {}

std::size_t SphereMap::memory(int rows) {
    const auto side = static_cast<std::size_t>(rows);
    return checked_product({side, side, 2 * 6 * sizeof(double)}, "a map of the sphere");
}

void SphereMap::fill(const double* coefficients) {
    transform_.synthesize(coefficients, 3, map_.data());
}

glm::dvec3 SphereMap::operator()(const glm::dvec3& direction) const {
    const int columns = 2 * rows_;
    const double theta = std::atan2(std::hypot(direction.x, direction.y), direction.z);
    const double phi = std::atan2(direction.y, direction.x);
    const Cubic row = cubic(theta / kPi * rows_ - 0.5);
    // Columns run against the azimuth, from pi at the left edge of column 0.
    const Cubic column = cubic((kPi - phi) / (2 * kPi) * columns - 0.5);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 4; ++i) {
        int r = row.first + i, turn = 0;
        if (r < 0 || r >= rows_) {
            // Beyond a pole the meridian goes on at the opposite azimuth.
            r = r < 0 ? -1 - r : 2 * rows_ - 1 - r;
            turn = rows_;
        }
        const double* line =
            map_.data() + static_cast<std::size_t>(r) * 3 * static_cast<std::size_t>(columns);
        glm::dvec3 across(0.0);
        for (int k = 0; k < 4; ++k) {
            const int c = (column.first + k + turn + columns) % columns;
            const double* value = line + 3 * static_cast<std::size_t>(c);
            across += column.weight[static_cast<std::size_t>(k)] *
                      glm::dvec3(value[0], value[1], value[2]);
        }
        sum += row.weight[static_cast<std::size_t>(i)] * across;
    }
    return sum;
}

}  // namespace airlight
