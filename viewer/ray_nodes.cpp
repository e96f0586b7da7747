// SPDX-License-Identifier: Apache-2.0
#include "viewer/ray_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "medium/quadrature.h"

namespace airlight {
namespace {

constexpr double kFar = 20, kLeastDepth = 1e-8, kBlobReach = 3.6;
constexpr double kDeepest = 20, kAsFar = 1e3;
// Of the variable: what the integral errs by in proportion.
constexpr double kInverse = 1e-6;

// Along which a layer is over the least depth: up to the height y at which its column is.
RaySpan span_of_layer(const ExponentialHeightDensity& layer, double density,
                      const glm::dvec3& origin, const glm::dvec3& direction, double distance) {
    const double sign = layer.scale_height < 0 ? -1 : 1;
    const double height = std::abs(layer.scale_height);
    const double y = sign * origin.y, up = sign * direction.y;
    if (std::abs(up) < 1e-12) return {0, distance};
    const double column = density * height / std::abs(up);
    const double top = column > 0 ? height * std::log(column / kLeastDepth) : y;
    const double at = (top - y) / up;
    return up > 0 ? RaySpan{0, std::clamp(at, 0.0, distance)}
                  : RaySpan{std::clamp(at, 0.0, distance), distance};
}

RaySpan span_of_atmosphere(const SphericalExponentialDensity& air, double density,
                           const glm::dvec3& origin, const glm::dvec3& direction, double distance) {
    const double column = density * std::sqrt(2 * kPi * air.radius * air.scale_height);
    const double top =
        air.radius + air.scale_height * std::max(1.0, std::log(column / kLeastDepth));
    const double middle = glm::dot(air.center - origin, direction);
    const glm::dvec3 off = air.center - origin - middle * direction;
    const double square = top * top - glm::dot(off, off);
    if (!(square > 0)) return {0, 0};
    const double half = std::sqrt(square);
    return {std::clamp(middle - half, 0.0, distance), std::clamp(middle + half, 0.0, distance)};
}

// On that side of the border of a layer on which there is something of it.
RaySpan span_of_linear(const LinearHeightDensity& layer, const glm::dvec3& origin,
                       const glm::dvec3& direction, double distance) {
    const double here = layer.slope * origin.y + layer.density, slope = layer.slope * direction.y;
    if (slope == 0) return {0, here > 0 ? distance : 0};
    const double border = std::clamp(-here / slope, 0.0, distance);
    return slope > 0 ? RaySpan{border, distance} : RaySpan{0, border};
}

// Of the first layer or atmosphere; nothing without one.
std::optional<double> densest(const SceneMedia& media, const glm::dvec3& origin,
                              const glm::dvec3& direction, const RaySpan& part) {
    for (const MediumPart& medium : media.parts()) {
        const Density* const shape = medium.single_shape();
        if (!shape) continue;
        if (const auto* layer = std::get_if<ExponentialHeightDensity>(shape)) {
            return direction.y * layer->scale_height > 0 ? part.near : part.far;
        }
        if (const auto* air = std::get_if<SphericalExponentialDensity>(shape)) {
            return std::clamp(glm::dot(air->center - origin, direction), part.near, part.far);
        }
    }
    return {};
}

// Calls take(x, w) for nodes on [0, 1], ascending.
template <class Take>
void each_node(int count, const Take& take) {
    const detail::QuadratureRule rule = detail::gauss_legendre(count);
    for (int i = rule.count - 1; i >= 0; --i) {
        take(0.5 - 0.5 * rule.nodes[i].x, 0.5 * rule.nodes[i].w);
    }
    for (int i = 0; i < rule.count; ++i) {
        take(0.5 + 0.5 * rule.nodes[i].x, 0.5 * rule.nodes[i].w);
    }
}

// Half the one angle, half the other. The inverse by Newton's method from the node before: what it
// misses is in the weight's derivative only.
void mixed_nodes(const glm::dvec3& lamp, const glm::dvec3& origin, const glm::dvec3& direction,
                 const RaySpan& part, const RaySpan& dense, int count,
                 std::vector<RayNode>& nodes) {
    struct Angle {
        double middle, width, first = 0, all = 1;
        double at(double t) const { return 0.5 * (std::atan((t - middle) / width) - first) / all; }
        double slope(double t) const {
            const double off = t - middle;
            return 0.5 * width / ((off * off + width * width) * all);
        }
    };
    const double foot = glm::dot(lamp - origin, direction);
    Angle angles[2] = {
        {foot, std::max(glm::length(lamp - origin - foot * direction),
                        kLeastHeight * (1 + std::abs(foot)))},
        {0.5 * (dense.near + dense.far), std::max(0.5 * (dense.far - dense.near), 1e-9)}};
    for (Angle& angle : angles) {
        angle.first = std::atan((part.near - angle.middle) / angle.width);
        angle.all = std::atan((part.far - angle.middle) / angle.width) - angle.first;
        if (!(angle.all > 0)) return;
    }
    const auto slope = [&](double at) { return angles[0].slope(at) + angles[1].slope(at); };
    double t = part.near, before = 0;
    each_node(count, [&](double x, double w) {
        double low = t, high = part.far;
        double next = std::min(high, t + (x - before) / slope(t));
        for (int i = 0; i < 40; ++i) {
            const double u = angles[0].at(next) + angles[1].at(next);
            if (std::abs(x - u) < kInverse) break;
            (u < x ? low : high) = next;
            const double step = next + (x - u) / slope(next);
            next = step > low && step < high ? step : 0.5 * (low + high);
        }
        t = next;
        before = x;
        nodes.push_back({t, w / slope(t)});
    });
}

}  // namespace

std::optional<RaySpan> span_of_media(const SceneMedia& media, MediumExtent extent,
                                     const glm::dvec3& origin, const glm::dvec3& direction,
                                     double distance) {
    RaySpan all{distance, 0};
    for (const MediumPart& part : media.parts()) {
        if (!part.is_of(extent)) continue;
        RaySpan span{0, distance};
        if (part.everywhere()) {
            if (largest(*part.everywhere()) > 0) return span;
            continue;
        }
        if (part.bounds()) {
            const auto within = clip_to_box(*part.bounds(), origin, direction, distance);
            if (!within) continue;
            span = *within;
        }
        const auto join = [&](double near, double far) {
            near = std::max(near, span.near);
            far = std::min(far, span.far);
            if (!(near < far)) return;
            all.near = std::min(all.near, near);
            all.far = std::max(all.far, far);
        };
        if (part.is_gaussian()) {
            for (const GaussianBlob& blob : part.blobs()) {
                if (!(blob.amplitude > 0 && blob.scale > 0)) continue;
                const double middle = glm::dot(blob.center - origin, direction);
                const double reach = kBlobReach / blob.scale;
                const glm::dvec3 off = blob.center - origin - middle * direction;
                const double square = reach * reach - glm::dot(off, off);
                if (square > 0) join(middle - std::sqrt(square), middle + std::sqrt(square));
            }
            continue;
        }
        if (const auto* const channels = part.linear_shapes()) {
            for (const LinearHeightDensity& channel : *channels) {
                const RaySpan own = span_of_linear(channel, origin, direction, distance);
                join(own.near, own.far);
            }
            continue;
        }
        const Density* const shape = part.single_shape();
        const double most = largest(part.colour());
        RaySpan own{0, distance};
        if (shape && std::holds_alternative<ExponentialHeightDensity>(*shape)) {
            own = span_of_layer(std::get<ExponentialHeightDensity>(*shape), most, origin, direction,
                                distance);
        } else if (shape && std::holds_alternative<SphericalExponentialDensity>(*shape)) {
            own = span_of_atmosphere(std::get<SphericalExponentialDensity>(*shape), most, origin,
                                     direction, distance);
        }
        join(own.near, own.far);
    }
    if (!(all.near < all.far)) return {};
    return all;
}

bool end_of_light(const MediumDepths& depths, const glm::dvec3& lamp, const glm::dvec3& origin,
                  const glm::dvec3& direction, RaySpan& part) {
    if (!std::isfinite(part.far)) {
        part.far = part.near + kAsFar * (1 + glm::length(lamp - origin));
    }
    const auto over = [](const glm::dvec3& depth) {
        return std::min({depth.x, depth.y, depth.z}) > kDeepest;
    };
    if (!over(depths(origin, direction, part.far))) return false;
    // The first of sixteen places beyond `near` that is that deep; those before it are not.
    const double near = part.near;
    double low = near, high = part.far;
    const auto narrow = [&](bool logarithmic) {
        constexpr int kSteps = 16;
        glm::dvec3 origins[kSteps], directions[kSteps], found[kSteps];
        double ends[kSteps];
        for (int i = 0; i < kSteps; ++i) {
            origins[i] = origin;
            directions[i] = direction;
            ends[i] = logarithmic ? near + std::ldexp(high - near, i - kSteps + 1)
                                  : low + (i + 1) * (high - low) / kSteps;
        }
        depths(kSteps, origins, directions, ends, found);
        int first = 0;
        while (first < kSteps - 1 && !over(found[first])) ++first;
        if (first > 0) low = ends[first - 1];
        high = ends[first];
        return first > 0;
    };
    // A layer may be thin beside the way on.
    for (int i = 0; i < 4 && !narrow(true); ++i) {
    }
    narrow(false);
    part.far = std::max(high, part.near);
    return true;
}

void ray_nodes(const SceneMedia& media, const glm::dvec3& lamp, const glm::dvec3& origin,
               const glm::dvec3& direction, const RaySpan& part, const RaySpan& dense, bool dims,
               int count, std::vector<RayNode>& nodes) {
    nodes.clear();
    const double length = part.far - part.near;
    const glm::dvec3 middle = origin + (part.near + 0.5 * length) * direction;
    if (glm::length(lamp - middle) < kFar * length) {
        mixed_nodes(lamp, origin, direction, part, dense, count, nodes);
        return;
    }
    const std::optional<double> deepest = densest(media, origin, direction, part);
    if (dims || !deepest) {
        each_node(count, [&](double x, double w) {
            nodes.push_back({part.near + x * length, w * length});
        });
        return;
    }
    const double before = *deepest - part.near, after = part.far - *deepest;
    const bool both = before > 1e-6 * length && after > 1e-6 * length;
    const int each = both ? std::max(6, count / 2) : count;
    if (before > 1e-6 * length) {
        each_node(each, [&](double x, double w) {
            const double back = 1 - x;
            nodes.push_back({*deepest - before * back * back, w * 2 * before * back});
        });
    }
    if (after > 1e-6 * length) {
        each_node(each, [&](double x, double w) {
            nodes.push_back({*deepest + after * x * x, w * 2 * after * x});
        });
    }
}

}  // namespace airlight
