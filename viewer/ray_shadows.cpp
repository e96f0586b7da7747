// SPDX-License-Identifier: Apache-2.0
#include "viewer/ray_shadows.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/axes.h"

namespace airlight {
namespace {

constexpr std::uint32_t kLeaf = 4;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// slope . x + offset.
struct Linear {
    glm::dvec3 slope;
    double offset;

    double operator()(const glm::dvec3& x) const { return glm::dot(slope, x) + offset; }
    double spread(const glm::dvec3& half) const { return glm::dot(glm::abs(slope), half); }
};

// What shades [begin, end] of the ray lies between two planes through the light.
struct Wedge {
    Linear after, before;  // positive inside
};

// The plane of ray and light: x along the ray from the point next to the light, y towards the
// light, z off the plane. The light is at (0, h, 0).
class Plane {
  public:
    Plane(const glm::dvec3& light, const glm::dvec3& origin, const glm::dvec3& direction)
        : foot_(glm::dot(light - origin, direction)) {
        const glm::dvec3 across = light - origin - foot_ * direction;
        height_ = glm::length(across);
        const double least = 1e-12 * (1 + std::abs(foot_));
        glm::dvec3 up = across / height_, other;
        if (!(height_ > least)) {
            make_axes(direction, up, other);
            height_ = least;
        }
        const glm::dvec3 at = origin + foot_ * direction;
        x = {direction, -glm::dot(direction, at)};
        y = {up, -glm::dot(up, at)};
        const glm::dvec3 normal = glm::cross(direction, up);
        z = {normal, -glm::dot(normal, at)};
    }

    double height() const { return height_; }
    double foot() const { return foot_; }

    /// cos(u) x - sin(u) (h - y) is positive for what shades the ray beyond foot + h tan(u).
    Linear beyond(double t) const {
        const double u = std::atan((t - foot_) / height_);
        const double cosine = std::isfinite(t) ? std::cos(u) : 0, sine = std::sin(u);
        return {cosine * x.slope + sine * y.slope, cosine * x.offset + sine * (y.offset - height_)};
    }
    Wedge wedge(double begin, double end) const {
        const Linear end_plane = beyond(end);
        return {beyond(begin), {-end_plane.slope, -end_plane.offset}};
    }

    Linear x, y, z;

  private:
    double foot_, height_;
};

// Ascending, those that touch joined.
void merge(std::vector<RayInterval>& intervals) {
    std::sort(intervals.begin(), intervals.end(),
              [](const RayInterval& a, const RayInterval& b) { return a.begin < b.begin; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < intervals.size(); ++i) {
        RayInterval& before = intervals[last];
        if (intervals[i].begin <= before.end + 1e-12 * (1 + std::abs(before.end))) {
            before.end = std::max(before.end, intervals[i].end);
        } else {
            intervals[++last] = intervals[i];
        }
    }
    if (!intervals.empty()) intervals.resize(last + 1);
}

// Where on the ray a cut of a triangle throws its shadow; empty where begin >= end.
RayInterval shadow_of(const Plane& plane, const std::array<glm::dvec3, 3>& corners) {
    double side[3];
    for (std::size_t i = 0; i < 3; ++i) side[i] = plane.z(corners[i]);
    const bool above[3] = {side[0] >= 0, side[1] >= 0, side[2] >= 0};
    if (above[0] == above[1] && above[1] == above[2]) return {};
    double x[2], y[2];
    int cuts = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t from = i, to = (i + 1) % 3;
        if (above[from] == above[to]) continue;
        // Both triangles of an edge cut it at the same place, to the bit.
        if (above[from]) std::swap(from, to);
        const double part = side[from] / (side[from] - side[to]);
        const glm::dvec3 cut = corners[from] + part * (corners[to] - corners[from]);
        x[cuts] = plane.x(cut);
        y[cuts] = plane.y(cut);
        ++cuts;
    }
    const double h = plane.height();
    if (y[0] > y[1]) {
        std::swap(x[0], x[1]);
        std::swap(y[0], y[1]);
    }
    if (!(y[1] > 0 && y[0] < h)) return {};
    const double slope = (x[1] - x[0]) / (y[1] - y[0]), at_light = x[1] - slope * (y[1] - h);
    if (y[0] < 0) {
        x[0] -= slope * y[0];
        y[0] = 0;
    }
    const double a = plane.foot() + h * x[0] / (h - y[0]);
    double b = 0;
    if (y[1] < h) {
        b = plane.foot() + h * x[1] / (h - y[1]);
    } else {
        b = at_light < 0 ? -kInfinite : kInfinite;
    }
    return {std::min(a, b), std::max(a, b)};
}

}  // namespace

RayShadows::RayShadows(const std::vector<Mesh>& meshes, std::size_t max_memory) {
    std::size_t count = 0;
    for (const Mesh& mesh : meshes) count += mesh.triangles.size();
    require_memory(checked_multiply(count, sizeof(triangles_[0]) + sizeof(Node), "the shadows"),
                   max_memory, "the shadows");
    triangles_.reserve(count);
    for (const Mesh& mesh : meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            triangles_.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
        }
    }
    if (count > 0) build(0, static_cast<std::uint32_t>(count));
}

void RayShadows::build(std::uint32_t first, std::uint32_t last) {
    glm::dvec3 low(kInfinite), high(-kInfinite), low_middle(kInfinite), high_middle(-kInfinite);
    for (std::uint32_t i = first; i < last; ++i) {
        const auto& [a, b, c] = triangles_[i];
        low = glm::min(low, glm::min(a, glm::min(b, c)));
        high = glm::max(high, glm::max(a, glm::max(b, c)));
        low_middle = glm::min(low_middle, a + b + c);
        high_middle = glm::max(high_middle, a + b + c);
    }
    const std::size_t here = nodes_.size();
    nodes_.emplace_back();
    constexpr float kMost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        nodes_[here].low[i] = std::nextafter(static_cast<float>(low[axis]), -kMost);
        nodes_[here].high[i] = std::nextafter(static_cast<float>(high[axis]), kMost);
    }
    if (last - first <= kLeaf) {
        nodes_[here].first = first;
        nodes_[here].count = last - first;
        return;
    }
    const glm::dvec3 extent = high_middle - low_middle;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle,
                     triangles_.begin() + last, [axis](const auto& s, const auto& t) {
                         return s[0][axis] + s[1][axis] + s[2][axis] <
                                t[0][axis] + t[1][axis] + t[2][axis];
                     });
    build(first, middle);
    nodes_[here].first = static_cast<std::uint32_t>(nodes_.size());
    build(middle, last);
}

std::vector<RayInterval> RayShadows::lit(const glm::dvec3& light, const glm::dvec3& origin,
                                         const glm::dvec3& direction, double distance) const {
    if (nodes_.empty()) return {{0, distance}};
    const Plane plane(light, origin, direction);
    const Wedge all = plane.wedge(0, distance);
    Wedge shadow{};
    double widest = 0;
    std::vector<RayInterval> shaded;
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        const glm::dvec3 low(node.low[0], node.low[1], node.low[2]);
        const glm::dvec3 high(node.high[0], node.high[1], node.high[2]);
        const glm::dvec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
        if (!(std::abs(plane.z(middle)) <= plane.z.spread(half))) continue;
        const double y = plane.y(middle), spread = plane.y.spread(half);
        if (!(y + spread >= 0 && y - spread <= plane.height())) continue;
        if (!(all.after(middle) + all.after.spread(half) >= 0 &&
              all.before(middle) + all.before.spread(half) >= 0)) {
            continue;
        }
        if (widest > 0 && shadow.after(middle) > shadow.after.spread(half) &&
            shadow.before(middle) > shadow.before.spread(half)) {
            continue;
        }
        if (node.count == 0) {
            stack[depth++] = node.first;
            stack[depth++] = index + 1;
            continue;
        }
        bool more = false;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const RayInterval found = shadow_of(plane, triangles_[i]);
            const RayInterval cut = {std::max(found.begin, 0.0), std::min(found.end, distance)};
            if (!(cut.begin < cut.end)) continue;
            shaded.push_back(cut);
            more = true;
        }
        if (!more || shaded.size() < 4) continue;
        merge(shaded);
        for (const RayInterval& s : shaded) {
            const double width = std::atan((s.end - plane.foot()) / plane.height()) -
                                 std::atan((s.begin - plane.foot()) / plane.height());
            if (!(width > 1.2 * widest)) continue;
            widest = width;
            shadow = plane.wedge(s.begin, s.end);
        }
    }
    merge(shaded);
    std::vector<RayInterval> lit;
    double end = 0;
    for (const RayInterval& s : shaded) {
        if (s.begin > end) lit.push_back({end, s.begin});
        end = s.end;
    }
    if (end < distance) lit.push_back({end, distance});
    return lit;
}

}  // namespace airlight
