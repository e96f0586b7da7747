// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRootPi = 1.7724538509055160273;
constexpr std::uint32_t kLeafBlobs = 4;

double norm(const glm::dvec3& v) {
    return std::hypot(v.x, v.y, v.z);
}

bool within_limits(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= detail::kLargestLength &&
           !std::isnan(v.x + v.y + v.z);
}

void check(const GaussianBlob& blob, std::size_t index) {
    const auto refuse = [&](const char* field, double value, const char* limit) {
        throw Error(ErrorCode::data, "blob " + std::to_string(index) + ": " + field + " is " +
                                         std::to_string(value) + ", the limits are " + limit);
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(blob.center[axis]) <= detail::kLargestLength)) {
            refuse("center", blob.center[axis], "-1e100 and 1e100");
        }
    }
    if (!(blob.amplitude >= 0 && blob.amplitude <= detail::kLargestLength)) {
        refuse("amplitude", blob.amplitude, "0 and 1e100");
    }
    if (!(blob.scale >= 0 && blob.scale <= detail::kLargestLength)) {
        refuse("scale", blob.scale, "0 and 1e100");
    }
    if (blob.scale == 0 && blob.amplitude > 0) refuse("scale", 0, "above 0 and 1e100");
}

/// A, the most that a line through the blob can hold.
double whole_of(const GaussianBlob& blob) {
    return blob.amplitude == 0 ? 0 : blob.amplitude * (kRootPi / blob.scale);
}

double bound(double whole, double scale, double distance) {
    const double x = scale * distance;
    return whole == 0 ? 0 : whole * std::exp(-x * x);
}

/// A node or a blob and the most that it can hold.
struct Candidate {
    double most;
    std::uint32_t index;
    bool blob;

    bool operator<(const Candidate& other) const {
        if (most != other.most) return most < other.most;
        return blob != other.blob ? other.blob : index > other.index;
    }
};

/// Distance from a segment.
struct SegmentDistance {
    glm::dvec3 origin, direction;
    double dist;

    double operator()(const glm::dvec3& point) const {
        const glm::dvec3 to = point - origin;
        const double t = std::clamp(glm::dot(to, direction), 0.0, dist);
        return norm(to - t * direction);
    }
};

/// Distance from a triangle: within its edges that from its plane, else from the nearest edge.
struct TriangleDistance {
    TriangleDistance(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
        : corner{a, b, c}, normal(glm::cross(b - a, c - a)) {
        const double length = norm(normal);
        // A triangle without area is its edges.
        flat = !(length > 0 && length < kInfinity);
        if (!flat) normal /= length;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 along = corner[(i + 1) % 3] - corner[i];
            const double size = norm(along);
            edge[i] = {corner[i], size > 0 ? along / size : glm::dvec3(0), size};
        }
    }

    double operator()(const glm::dvec3& point) const {
        bool inside = !flat;
        for (int i = 0; inside && i < 3; ++i) {
            const glm::dvec3 inward = glm::cross(normal, edge[i].direction);
            inside = glm::dot(point - corner[i], inward) >= 0;
        }
        if (inside) return std::abs(glm::dot(point - corner[0], normal));
        return std::min({edge[0](point), edge[1](point), edge[2](point)});
    }

    glm::dvec3 corner[3], normal;
    bool flat;
    SegmentDistance edge[3];
};

/// The direction with its length made 1, or nothing for one that is not unit.
bool normalise(glm::dvec3& direction) {
    const double square = glm::dot(direction, direction);
    if (!(std::abs(square - 1) <= 1e-5)) return false;
    direction /= std::sqrt(square);
    return true;
}

}  // namespace

GaussianTree::GaussianTree(std::vector<GaussianBlob> blobs) : blobs_(std::move(blobs)) {
    if (blobs_.size() > std::size_t{1} << 31) {
        throw Error(ErrorCode::data,
                    std::to_string(blobs_.size()) + " blobs: no more than 2147483648 fit");
    }
    for (std::size_t i = 0; i < blobs_.size(); ++i) check(blobs_[i], i);
    order_.resize(blobs_.size());
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t GaussianTree::build(std::uint32_t begin, std::uint32_t count) {
    const auto first = order_.begin() + begin;
    glm::dvec3 low(kInfinity), high(-kInfinity);
    Node node{};
    node.min_scale = kInfinity;
    for (auto it = first; it != first + count; ++it) {
        const GaussianBlob& blob = blobs_[*it];
        low = glm::min(low, blob.center);
        high = glm::max(high, blob.center);
        if (blob.amplitude == 0) continue;
        node.min_scale = std::min(node.min_scale, blob.scale);
        node.whole += whole_of(blob);
        node.peaks += blob.amplitude;
    }
    node.center = 0.5 * low + 0.5 * high;
    for (auto it = first; it != first + count; ++it) {
        node.radius = std::max(node.radius, norm(blobs_[*it].center - node.center));
    }
    node.log_whole = std::log(node.whole / count);
    node.log_peaks = std::log(node.peaks / count);
    node.begin = begin;
    node.count = count;
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    if (count > kLeafBlobs) {
        const glm::dvec3 span = high - low;
        const int axis = span.x >= span.y && span.x >= span.z ? 0 : span.y >= span.z ? 1 : 2;
        const std::uint32_t half = count / 2;
        std::nth_element(first, first + half, first + count, [&](std::uint32_t i, std::uint32_t j) {
            const double x = blobs_[i].center[axis], y = blobs_[j].center[axis];
            return x != y ? x < y : i < j;
        });
        build(begin, half);
        const std::uint32_t second = build(begin + half, count - half);
        nodes_[index].second = second;
    }
    return index;
}

template <class Distance, class Take>
void GaussianTree::visit(const Distance& distance, double tolerance, const Take& take,
                         GaussianTreeVisits* visits) const {
    GaussianTreeVisits seen;
    // What is neither taken nor opened yet, the largest bound on top.
    std::vector<Candidate> open;
    double left = 0;
    const auto add = [&](double most, std::uint32_t index, bool blob) {
        if (most == 0) return;
        open.push_back({most, index, blob});
        std::push_heap(open.begin(), open.end());
        left += most;
    };
    const auto add_node = [&](std::uint32_t index) {
        const Node& node = nodes_[index];
        ++seen.nodes;
        if (node.whole == 0) return;
        const double gap = std::max(distance(node.center) - node.radius, 0.0);
        add(bound(node.whole, node.min_scale, gap), index, false);
    };
    if (!nodes_.empty()) add_node(0);
    while (!open.empty()) {
        if (!(left > tolerance)) {
            // The running sum has rounded, the other way maybe.
            left = 0;
            for (const Candidate& each : open) left += each.most;
            if (left <= tolerance) break;
        }
        std::pop_heap(open.begin(), open.end());
        const Candidate top = open.back();
        open.pop_back();
        left -= top.most;
        if (top.blob) {
            ++seen.taken;
            take(top.index);
            continue;
        }
        const Node& node = nodes_[top.index];
        if (node.second != 0) {
            add_node(top.index + 1);
            add_node(node.second);
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) {
            const GaussianBlob& blob = blobs_[order_[i]];
            ++seen.blobs;
            add(bound(whole_of(blob), blob.scale, distance(blob.center)), order_[i], true);
        }
    }
    if (visits != nullptr) *visits = seen;
}

template <class Distance, class Most, class Take>
void GaussianTree::descend(const Distance& distance, const Most& most, double tolerance,
                           const Take& take, GaussianTreeVisits* visits) const {
    const double share = blobs_.empty() ? 0 : tolerance / static_cast<double>(blobs_.size());
    const double log_share = std::log(share);
    GaussianTreeVisits seen;
    // Medians halve: no path is longer than the bits of a count.
    std::uint32_t open[40];
    int last = -1;
    if (!nodes_.empty()) open[++last] = 0;
    while (last >= 0) {
        const std::uint32_t index = open[last--];
        const Node& node = nodes_[index];
        ++seen.nodes;
        const double gap = std::max(distance(node.center) - node.radius, 0.0);
        const double x = node.min_scale * gap;
        if (most.log_mean(node) - x * x <= log_share || node.whole == 0) continue;
        if (node.second != 0) {
            open[++last] = node.second;
            open[++last] = index + 1;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) {
            const GaussianBlob& blob = blobs_[order_[i]];
            ++seen.blobs;
            if (bound(most.of(blob), blob.scale, distance(blob.center)) <= share) continue;
            ++seen.taken;
            take(blob);
        }
    }
    if (visits != nullptr) *visits = seen;
}

double GaussianTree::quick_optical_depth(const glm::dvec3& origin, const glm::dvec3& direction,
                                         double dist, double tolerance,
                                         GaussianTreeVisits* visits) const {
    glm::dvec3 unit = direction;
    if (!within_limits(origin) || !normalise(unit) || !(dist >= 0 && tolerance >= 0)) return kNan;
    struct Most {
        double log_mean(const Node& node) const { return node.log_whole; }
        double of(const GaussianBlob& blob) const { return whole_of(blob); }
    };
    // Limits of coordinates are far from where squares overflow.
    const auto distance = [&](const glm::dvec3& point) {
        const glm::dvec3 to = point - origin;
        const double t = std::clamp(glm::dot(to, unit), 0.0, dist);
        const glm::dvec3 off = to - t * unit;
        return std::sqrt(glm::dot(off, off));
    };
    double sum = 0;
    const auto take = [&](const GaussianBlob& blob) {
        sum += gaussian_optical_depth(blob, origin, unit, dist);
    };
    descend(distance, Most(), tolerance, take, visits);
    return sum;
}

double GaussianTree::density(const glm::dvec3& x, double tolerance,
                             GaussianTreeVisits* visits) const {
    if (!within_limits(x) || !(tolerance >= 0)) return kNan;
    struct Most {
        double log_mean(const Node& node) const { return node.log_peaks; }
        double of(const GaussianBlob& blob) const { return blob.amplitude; }
    };
    const auto distance = [&](const glm::dvec3& point) {
        const glm::dvec3 to = point - x;
        return std::sqrt(glm::dot(to, to));
    };
    double sum = 0;
    const auto take = [&](const GaussianBlob& blob) { sum += gaussian_density(blob, x); };
    descend(distance, Most(), tolerance, take, visits);
    return sum;
}

double GaussianTree::last_distance(const glm::dvec3& origin, double tolerance) const {
    if (nodes_.empty() || nodes_[0].whole == 0) return 0;
    const Node& root = nodes_[0];
    // Beyond, all blobs together hold less than the tolerance.
    const double log_ratio =
        std::log(std::min(root.whole, 1e300)) - std::log(std::max(tolerance, 1e-323));
    return norm(root.center - origin) + root.radius +
           std::sqrt(std::max(log_ratio, 1.0)) / root.min_scale;
}

double GaussianTree::optical_depth(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double dist, double tolerance,
                                   GaussianTreeVisits* visits) const {
    glm::dvec3 unit = direction;
    if (!within_limits(origin) || !normalise(unit) || !(dist >= 0 && tolerance >= 0)) return kNan;
    double sum = 0;
    const auto take = [&](std::uint32_t index) {
        sum += gaussian_optical_depth(blobs_[index], origin, unit, dist);
    };
    visit(SegmentDistance{origin, unit, dist}, tolerance, take, visits);
    return sum;
}

std::vector<std::uint32_t> GaussianTree::along(const glm::dvec3& origin,
                                               const glm::dvec3& direction, double dist,
                                               double tolerance, GaussianTreeVisits* visits) const {
    std::vector<std::uint32_t> taken;
    glm::dvec3 unit = direction;
    if (!within_limits(origin) || !normalise(unit) || !(dist >= 0 && tolerance >= 0)) return taken;
    visit(
        SegmentDistance{origin, unit, dist}, tolerance,
        [&](std::uint32_t index) { taken.push_back(index); }, visits);
    std::sort(taken.begin(), taken.end());
    return taken;
}

std::vector<std::uint32_t> GaussianTree::around(const AirlightRay& ray, double tolerance,
                                                GaussianTreeVisits* visits) const {
    std::vector<std::uint32_t> taken;
    glm::dvec3 unit = ray.direction;
    if (!within_limits(ray.viewer) || !within_limits(ray.light) || !normalise(unit) ||
        !(ray.dist >= 0 && tolerance >= 0)) {
        return taken;
    }
    const double dist = std::min(ray.dist, last_distance(ray.viewer, tolerance));
    visit(
        TriangleDistance(ray.viewer, ray.viewer + dist * unit, ray.light), tolerance,
        [&](std::uint32_t index) { taken.push_back(index); }, visits);
    std::sort(taken.begin(), taken.end());
    return taken;
}

}  // namespace airlight
