// SPDX-License-Identifier: Apache-2.0
#include "viewer/lamp_shadow_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/constants.h"
#include "core/parallel.h"
#include "prt/ray_packets.h"

namespace airlight {
namespace {

constexpr int kHalvings = 5;

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

// Of the point from_lamp / scale, in the frame of the lamp.
bool LampShadowMap::sees(const glm::vec3& v, float scale) const {
    const float ax = std::abs(v.x), ay = std::abs(v.y), az = std::abs(v.z);
    const int axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    const float along = std::abs(v[axis]), half = 0.5f * static_cast<float>(size_);
    const float to_texel = half / along;
    const int u = axis == 2 ? 0 : axis + 1, w = axis == 0 ? 2 : axis - 1;
    const int column = std::min(static_cast<int>(v[u] * to_texel + half), size_ - 1);
    const int row = std::min(static_cast<int>(v[w] * to_texel + half), size_ - 1);
    const int side = 2 * axis + (v[axis] < 0 ? 1 : 0);
    const float depth = depths_[static_cast<std::size_t>((side * size_ + row) * size_ + column)];
    // The directions of the sides are 1 along their axis, and so depths are along it.
    return !(along > depth * scale * (1 + 1 / half));
}

bool LampShadowMap::sees(const glm::dvec3& point) const {
    return sees(glm::vec3(point - lamp_), 1);
}

// With u the angle at which the lamp sees a point of the ray, that point is height tan(u) along
// from the foot: in the lamp's frame cos(u) times it is cos(u) foot + sin(u) height direction.
void LampShadowMap::lit(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
                        int points, std::vector<RayInterval>& parts) const {
    parts.clear();
    const double foot = glm::dot(lamp_ - origin, direction);
    const glm::dvec3 across = origin + foot * direction - lamp_;
    const double height = std::max(glm::length(across), 1e-9 * (1 + std::abs(foot)));
    const double first = std::atan(-foot / height);
    const double last = std::isfinite(distance) ? std::atan((distance - foot) / height) : kPi / 2;
    const glm::vec3 at_foot(across), ahead(height * direction);
    const auto sees_at = [&](float cosine, float sine) {
        return sees(cosine * at_foot + sine * ahead, cosine);
    };
    const auto place = [&](double u) {
        return std::clamp(foot + height * std::tan(u), 0.0, distance);
    };
    const double step = (last - first) / points;
    const auto border = [&](double seen, double unseen) {
        for (int i = 0; i < kHalvings; ++i) {
            const double u = 0.5 * (seen + unseen);
            const bool there =
                sees_at(static_cast<float>(std::cos(u)), static_cast<float>(std::sin(u)));
            (there ? seen : unseen) = u;
        }
        return place(0.5 * (seen + unseen));
    };
    const double turn_cosine = std::cos(step), turn_sine = std::sin(step);
    double cosine = std::cos(first + 0.5 * step), sine = std::sin(first + 0.5 * step);
    bool before = false;
    for (int i = 0; i < points; ++i) {
        const double u = first + (i + 0.5) * step;
        const bool here = sees_at(static_cast<float>(cosine), static_cast<float>(sine));
        if (here && !before) parts.push_back({i == 0 ? 0 : border(u, u - step), distance});
        if (!here && before) parts.back().end = border(u - step, u);
        before = here;
        const double next = cosine * turn_cosine - sine * turn_sine;
        sine = sine * turn_cosine + cosine * turn_sine;
        cosine = next;
    }
}

}  // namespace airlight
