// SPDX-License-Identifier: Apache-2.0
#include "viewer/ray_shadows.h"

#include <hwy/base.h>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/axes.h"

namespace airlight {
namespace {

using detail::kShadowLanes;
using detail::Linear;
using detail::ShadowBoxes;
using detail::ShadowQuery;
using detail::ShadowTriangles;
using detail::ShadowWedge;

using Corners = std::array<glm::dvec3, 3>;  // of a triangle

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Marks children that are triangles.
constexpr std::uint32_t kLeaf = 0x80000000u;

// The angle at which the light sees a place of the ray, from that of the point next to it.
struct Turn {
    double cosine, sine;

    Turn(const ShadowQuery& query, double t) {
        const double tangent = (t - query.foot) / query.height;
        if (std::abs(tangent) < 1e100) {
            cosine = 1 / std::sqrt(1 + tangent * tangent);
            sine = cosine * tangent;
        } else {
            cosine = 0;
            sine = tangent < 0 ? -1 : 1;
        }
    }
};

// cos(u) x - sin(u) (h - y) is positive for what shades the ray beyond foot + h tan(u).
Linear beyond(const ShadowQuery& query, const Turn& u) {
    return {u.cosine * query.x.slope + u.sine * query.y.slope,
            u.cosine * query.x.offset + u.sine * (query.y.offset - query.height)};
}

ShadowWedge wedge(const ShadowQuery& query, const Turn& begin, const Turn& end) {
    const Linear last = beyond(query, end);
    return {beyond(query, begin), {-last.slope, -last.offset}};
}

ShadowQuery make_query(const glm::dvec3& light, const glm::dvec3& origin,
                       const glm::dvec3& direction, double distance) {
    ShadowQuery query;
    query.distance = distance;
    query.foot = glm::dot(light - origin, direction);
    const glm::dvec3 across = light - origin - query.foot * direction;
    query.height = glm::length(across);
    const double least = 1e-12 * (1 + std::abs(query.foot));
    glm::dvec3 up = across / query.height, other;
    if (!(query.height > least)) {
        make_axes(direction, up, other);
        query.height = least;
    }
    const glm::dvec3 at = origin + query.foot * direction, normal = glm::cross(direction, up);
    query.x = {direction, -glm::dot(direction, at)};
    query.y = {up, -glm::dot(up, at)};
    query.z = {normal, -glm::dot(normal, at)};
    query.low = glm::min(light, origin);
    query.high = glm::max(light, origin);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const double end = origin[axis] + distance * direction[axis];
        query.low[axis] = std::min(query.low[axis], end);
        query.high[axis] = std::max(query.high[axis], end);
    }
    query.all = wedge(query, Turn(query, 0), Turn(query, distance));
    return query;
}

std::size_t lowest_bit(unsigned bits) {
    return hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
}

// Into ascending ones that are apart; those that touch it become one, which is returned.
RayInterval insert(std::vector<RayInterval>& parts, RayInterval part) {
    std::size_t first = parts.size();
    while (first > 0 && parts[first - 1].end >= part.begin) --first;
    std::size_t last = first;
    while (last < parts.size() && parts[last].begin <= part.end) ++last;
    if (first == last) {
        parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(first), part);
        return part;
    }
    part = {std::min(part.begin, parts[first].begin), std::max(part.end, parts[last - 1].end)};
    parts[first] = part;
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                parts.begin() + static_cast<std::ptrdiff_t>(last));
    return part;
}

// What ascending parts leave of [0, distance].
void invert(double distance, std::vector<RayInterval>& parts) {
    std::size_t count = 0;
    double end = 0;
    const std::size_t shaded = parts.size();
    for (std::size_t i = 0; i < shaded; ++i) {
        const RayInterval part = parts[i];
        if (part.begin > end + (i > 0 ? 1e-12 * (1 + end) : 0)) parts[count++] = {end, part.begin};
        end = part.end;
    }
    parts.resize(count);
    if (end < distance) parts.push_back({end, distance});
}

struct Box {
    glm::dvec3 low{kInfinite}, high{-kInfinite};

    double area() const {
        const glm::dvec3 e = high - low;
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

Box box_of(const Corners* first, const Corners* last) {
    Box box;
    for (; first != last; ++first) {
        for (const glm::dvec3& x : *first) {
            box.low = glm::min(box.low, x);
            box.high = glm::max(box.high, x);
        }
    }
    return box;
}

// Along the axis that leaves the least surface to the boxes of both parts.
void halve(Corners* first, Corners* middle, Corners* last) {
    if (middle == last) return;
    const auto along = [&](int axis) {
        std::nth_element(first, middle, last, [axis](const Corners& s, const Corners& t) {
            return s[0][axis] + s[1][axis] + s[2][axis] < t[0][axis] + t[1][axis] + t[2][axis];
        });
        return box_of(first, middle).area() * double(middle - first) +
               box_of(middle, last).area() * double(last - middle);
    };
    int best = 2;
    double least = kInfinite;
    for (int axis = 0; axis < 3; ++axis) {
        const double area = along(axis);
        if (!(area < least)) continue;
        least = area;
        best = axis;
    }
    if (best != 2) along(best);
}

}  // namespace

RayShadows::RayShadows(const std::vector<Mesh>& meshes, std::size_t max_memory) {
    std::size_t count = 0;
    for (const Mesh& mesh : meshes) count += mesh.triangles.size();
    require_memory(checked_multiply(count, 180, "the shadows"), max_memory, "the shadows");
    std::vector<Corners> corners;
    corners.reserve(count);
    for (const Mesh& mesh : meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            corners.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
        }
    }
    triangles_.reserve((count + kShadowLanes - 1) / kShadowLanes);
    if (count > 0) root_ = build(corners.data(), corners.data() + count);
}

// By halves, down to eight parts of at most `unit` triangles, the least 8^k that is enough: boxes
// and leaves are full but for the last.
std::uint32_t RayShadows::build(Corners* first, Corners* last) {
    const std::ptrdiff_t count = last - first;
    if (count <= kShadowLanes) {
        ShadowTriangles& eight = triangles_.emplace_back();
        for (int lane = 0; lane < kShadowLanes; ++lane) {
            for (std::size_t i = 0; i < 3; ++i) {
                // Lanes that are left over have one corner of the first three times.
                const glm::dvec3& x = lane < count ? first[lane][i] : first[0][0];
                for (int axis = 0; axis < 3; ++axis) eight.corner[i][axis][lane] = x[axis];
            }
        }
        return kLeaf | static_cast<std::uint32_t>(triangles_.size() - 1);
    }
    std::ptrdiff_t unit = kShadowLanes;
    while (unit * kShadowLanes < count) unit *= kShadowLanes;
    Corners* borders[kShadowLanes + 1] = {first};
    borders[kShadowLanes] = last;
    for (int step = kShadowLanes; step > 1; step /= 2) {
        for (int i = 0; i < kShadowLanes; i += step) {
            const std::ptrdiff_t units = (borders[i + step] - borders[i] + unit - 1) / unit;
            const std::ptrdiff_t before = (units + 1) / 2 * unit;
            borders[i + step / 2] = std::min(borders[i] + before, borders[i + step]);
            halve(borders[i], borders[i + step / 2], borders[i + step]);
        }
    }
    const std::size_t here = boxes_.size();
    boxes_.emplace_back();
    for (int lane = 0; lane < kShadowLanes; ++lane) {
        const Box box = box_of(borders[lane], borders[lane + 1]);
        for (int axis = 0; axis < 3; ++axis) {
            if (borders[lane] == borders[lane + 1]) {
                boxes_[here].half[axis][lane] = -1;
                continue;
            }
            const auto middle = static_cast<float>(0.5 * box.low[axis] + 0.5 * box.high[axis]);
            const double half =
                std::max(box.high[axis] - double(middle), double(middle) - box.low[axis]);
            boxes_[here].middle[axis][lane] = middle;
            boxes_[here].half[axis][lane] =
                std::nextafter(static_cast<float>(half), std::numeric_limits<float>::infinity());
        }
        if (borders[lane] == borders[lane + 1]) continue;
        const std::uint32_t child = build(borders[lane], borders[lane + 1]);
        boxes_[here].child[lane] = child;
    }
    return static_cast<std::uint32_t>(here);
}

void RayShadows::lit(const glm::dvec3& light, const glm::dvec3& origin, const glm::dvec3& direction,
                     double distance, std::vector<RayInterval>& parts) const {
    parts.clear();
    if (triangles_.empty()) {
        parts.push_back({0, distance});
        return;
    }
    ShadowQuery query = make_query(light, origin, direction, distance);
    double widest = 0;
    // Seven are left behind on each of the levels, of which 2^31 triangles have 11.
    std::uint32_t stack[96];
    int depth = 0;
    stack[depth++] = root_;
    while (depth > 0) {
        const std::uint32_t node = stack[--depth];
        if ((node & kLeaf) == 0) {
            const ShadowBoxes& boxes = boxes_[node];
            const unsigned bits = detail::boxes_in_question(boxes, query);
            for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
                stack[depth++] = boxes.child[lowest_bit(rest)];
            }
            continue;
        }
        double begin[kShadowLanes], end[kShadowLanes];
        const unsigned bits = detail::shadows_of(triangles_[node & ~kLeaf], query, begin, end);
        if (bits == 0) continue;
        RayInterval found;
        for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
            const std::size_t lane = lowest_bit(rest);
            found = insert(parts, {begin[lane], end[lane]});
        }
        const Turn first(query, found.begin), last(query, found.end);
        // 1 - cos of the angle, for a comparison
        const double width = 1 - (first.cosine * last.cosine + first.sine * last.sine);
        if (!(width > 1.4 * widest)) continue;
        widest = width;
        query.covered = wedge(query, first, last);
        query.any_covered = true;
    }
    invert(distance, parts);
}

}  // namespace airlight
