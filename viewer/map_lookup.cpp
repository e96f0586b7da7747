// SPDX-License-Identifier: Apache-2.0
#include "viewer/map_lookup.h"

#include <cassert>
#include <cmath>

#include "envmap/latlong.h"

namespace airlight {
namespace {

// Rows beyond a pole are those on its other side.
glm::dvec3 pixel(const Image& map, int row, int column) {
    if (row < 0 || row >= map.height) {
        row = row < 0 ? -1 - row : 2 * map.height - 1 - row;
        column += map.width / 2;
    }
    column = (column % map.width + map.width) % map.width;
    const float* const rgb = map.row(row) + 3 * column;
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

glm::vec3 look_up(const Image& map, const glm::dvec3& direction) {
    assert(map.channels == 3);
    const LatLongPoint point = point_of({direction.x, direction.y, direction.z});
    const double x = point.u * map.width - 0.5, y = point.v * map.height - 0.5;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double right = x - column, down = y - row;
    const glm::dvec3 above =
        (1 - right) * pixel(map, row, column) + right * pixel(map, row, column + 1);
    const glm::dvec3 below =
        (1 - right) * pixel(map, row + 1, column) + right * pixel(map, row + 1, column + 1);
    return glm::vec3((1 - down) * above + down * below);
}

}  // namespace airlight
