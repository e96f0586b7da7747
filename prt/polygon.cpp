// SPDX-License-Identifier: Apache-2.0
// Polygons into triangles.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "prt/raw_mesh.h"

namespace airlight::detail {
namespace {

// Ear cutting takes time in the square of the corners.
constexpr std::size_t kMostCorners = 256;

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon seen along its area vector, counter-clockwise and of size 1 at most; all zero for
/// one without area.
std::vector<glm::dvec2> project(const std::vector<glm::dvec3>& points) {
    std::vector<glm::dvec2> flat(points.size(), glm::dvec2(0.0));
    double scale = 0;
    for (const glm::dvec3& p : points) {
        for (int i = 0; i < 3; ++i) scale = std::max(scale, std::fabs(p[i] - points[0][i]));
    }
    if (scale == 0) return flat;
    glm::dvec3 area(0.0), before = (points.back() - points[0]) / scale;
    for (const glm::dvec3& p : points) {
        const glm::dvec3 here = (p - points[0]) / scale;
        area += glm::cross(before, here);
        before = here;
    }
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(area[i]) > std::fabs(area[axis])) axis = i;
    }
    if (area[axis] == 0) return flat;
    int right = (axis + 1) % 3, up = (axis + 2) % 3;
    if (area[axis] < 0) std::swap(right, up);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 here = (points[i] - points[0]) / scale;
        flat[i] = glm::dvec2(here[right], here[up]);
    }
    return flat;
}

class EarCutter {
  public:
    explicit EarCutter(const std::vector<glm::dvec2>& points)
        : points_(points), next_(points.size()), previous_(points.size()), ear_(points.size()) {
        const std::size_t n = points.size();
        for (std::size_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        for (std::size_t i = 0; i < n; ++i) ear_[i] = is_ear(i);
    }

    /// Calls add(a, b, c) for each triangle; false when the rest had to become a fan.
    template <class Add>
    bool cut(const Add& add) {
        std::size_t at = 0;
        for (std::size_t left = points_.size(); left > 3; --left) {
            std::size_t tried = 0;
            while (tried < left && !ear_[at]) {
                at = next_[at];
                ++tried;
            }
            if (tried == left) {
                const std::size_t first = at;
                for (std::size_t b = next_[at]; next_[b] != first; b = next_[b]) {
                    add(first, b, next_[b]);
                }
                return false;
            }
            const std::size_t before = previous_[at], after = next_[at];
            add(before, at, after);
            next_[before] = after;
            previous_[after] = before;
            ear_[before] = is_ear(before);
            ear_[after] = is_ear(after);
            at = after;
        }
        add(previous_[at], at, next_[at]);
        return true;
    }

  private:
    bool is_ear(std::size_t i) const {
        const glm::dvec2 &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        if (turn(a, b, c) <= 0) return false;
        for (std::size_t j = next_[next_[i]]; j != previous_[i]; j = next_[j]) {
            const glm::dvec2& p = points_[j];
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    const std::vector<glm::dvec2>& points_;
    std::vector<std::size_t> next_, previous_;
    std::vector<char> ear_;
};

}  // namespace

bool triangulate(const std::vector<glm::dvec3>& points, const std::uint32_t* corners,
                 std::vector<glm::uvec3>& triangles) {
    const std::size_t n = points.size();
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.emplace_back(corners[a], corners[b], corners[c]);
    };
    const std::vector<glm::dvec2> flat = project(points);
    // A fan over corners in a line would have triangles without area.
    bool strictly = true, convex = true;
    for (std::size_t i = 0; i < n && convex; ++i) {
        const double angle = turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]);
        strictly = strictly && angle > 0;
        convex = angle >= 0;
    }
    if (!strictly && n <= kMostCorners) return EarCutter(flat).cut(add);
    for (std::size_t i = 1; i + 1 < n; ++i) add(0, i, i + 1);
    return convex;
}

}  // namespace airlight::detail
