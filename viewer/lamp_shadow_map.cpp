// SPDX-License-Identifier: Apache-2.0
#include "viewer/lamp_shadow_map.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "prt/ray_packets.h"

namespace airlight {
namespace {

// Of a side of the cube: its axis and the two across, in cyclic order.
struct Side {
    int axis, u, v;
    double sign;
};

Side side_of(int number) {
    const int axis = number / 2;
    return {axis, (axis + 1) % 3, (axis + 2) % 3, number % 2 == 0 ? 1.0 : -1.0};
}

}  // namespace

LampShadowMap::LampShadowMap(const RayScene& scene, const glm::dvec3& lamp, int size)
    : lamp_(lamp), size_(size) {
    const auto n = static_cast<std::size_t>(size);
    depths_.resize(6 * n * n);
    parallel_blocks(6 * n, 8, [&](std::size_t begin, std::size_t end) {
        std::vector<float> x(n), y(n), z(n);
        std::vector<float>* const columns[] = {&x, &y, &z};
        std::vector<PacketHit> hits(n);
        for (std::size_t line = begin; line < end; ++line) {
            const Side side = side_of(static_cast<int>(line / n));
            const double v = 2 * (double(line % n) + 0.5) / double(n) - 1;
            for (std::size_t i = 0; i < n; ++i) {
                (*columns[side.axis])[i] = static_cast<float>(side.sign);
                (*columns[side.u])[i] = static_cast<float>(2 * (double(i) + 0.5) / double(n) - 1);
                (*columns[side.v])[i] = static_cast<float>(v);
            }
            find_nearest_packets(scene, lamp, n, x.data(), y.data(), z.data(), hits.data());
            for (std::size_t i = 0; i < n; ++i) {
                depths_[line * n + i] = hits[i].distance;
            }
        }
    });
}

bool LampShadowMap::sees(const glm::dvec3& point) const {
    const glm::vec3 v(point - lamp_);
    const float ax = std::abs(v.x), ay = std::abs(v.y), az = std::abs(v.z);
    const int axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    const float along = std::abs(v[axis]), half = 0.5f * static_cast<float>(size_);
    if (!(along > 0)) return true;
    const float to_texel = half / along;
    const int u = axis == 2 ? 0 : axis + 1, w = axis == 0 ? 2 : axis - 1;
    const int column = std::min(static_cast<int>(v[u] * to_texel + half), size_ - 1);
    const int row = std::min(static_cast<int>(v[w] * to_texel + half), size_ - 1);
    const int side = 2 * axis + (v[axis] < 0 ? 1 : 0);
    const float depth = depths_[static_cast<std::size_t>((side * size_ + row) * size_ + column)];
    // The directions of the sides are 1 along their axis, and so depths are along it.
    return !(along > depth * (1 + 1 / half));
}

}  // namespace airlight
