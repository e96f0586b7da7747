// SPDX-License-Identifier: Apache-2.0
#include "medium/density_field.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/depth_inverse.h"
#include "medium/height_column.h"
#include "medium/height_density.h"
#include "medium/spherical_path.h"

namespace airlight {
namespace {

using detail::DepthState;
using detail::scaled;
using detail::SphericalPath;
using detail::TwoDoubles;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestZ = 1e300;
// A depth that is the whole ray's but for rounding.
constexpr double kFullDepth = 1e-14;

bool is_finite(const glm::dvec3& x) {
    return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
}

bool is_amount(double x) {
    return x >= 0 && std::isfinite(x);
}

// Normalised; NaN unless it is a direction.
glm::dvec3 unit(const glm::dvec3& direction) {
    const double square = glm::dot(direction, direction);
    if (!(std::abs(square - 1) <= 1e-5)) return glm::dvec3(kNan);
    const glm::dvec3 v = direction / std::sqrt(square);
    return {v.x, std::min(1.0, std::max(-1.0, v.y)), v.z};
}

glm::dvec3 point(const glm::dvec3& origin, const glm::dvec3& direction, double t) {
    return origin + t * direction;
}

bool is_valid(const SphericalExponentialDensity& part) {
    return is_finite(part.center) && is_amount(part.radius) && is_amount(part.density) &&
           part.scale_height > 0;
}

// |x - center| and what it is above the sphere.
TwoDoubles distance_between(const glm::dvec3& x, const glm::dvec3& center) {
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max({largest, std::abs(x[i]), std::abs(center[i])});
    }
    // Squares of what is farther would overflow.
    const double unit = largest < 1e150 ? 1 : std::ldexp(1.0, std::ilogb(largest));
    TwoDoubles sum = {0, 0};
    for (int i = 0; i < 3; ++i) {
        const TwoDoubles part = detail::two_sum(x[i] / unit, -center[i] / unit);
        sum = sum + part * part;
    }
    const TwoDoubles root = square_root(sum);
    return {root.hi * unit, root.lo * unit};
}

SphericalPath path_of(const SphericalExponentialDensity& part, const glm::dvec3& origin,
                      const glm::dvec3& direction) {
    const TwoDoubles r = distance_between(origin, part.center);
    TwoDoubles along = {0, 0};
    for (int i = 0; i < 3; ++i) {
        along = along + detail::two_sum(origin[i], -part.center[i]) * TwoDoubles{direction[i], 0};
    }
    const glm::dvec3 across = glm::cross(origin - part.center, direction);
    const double periapsis = std::hypot(across.x, across.y, across.z);
    return {r, r + TwoDoubles{-part.radius, 0}, along, {periapsis, 0}};
}

double slope_of(double density, double scale_height) {
    return density == 0 ? 0 : -density / scale_height;
}

struct DensityAt {
    glm::dvec3 x;

    double operator()(const UniformDensity& part) const {
        return is_amount(part.density) ? part.density : kNan;
    }
    double operator()(const LinearHeightDensity& part) const {
        if (!std::isfinite(part.slope) || !std::isfinite(part.density)) return kNan;
        return std::max(0.0, std::fma(part.slope, x.y, part.density));
    }
    double operator()(const ExponentialHeightDensity& part) const {
        if (!is_amount(part.density) || !(part.scale_height != 0)) return kNan;
        if (part.density == 0) return 0;
        return value(scaled(part.density) * detail::spherical_density({x.y, 0}, part.scale_height));
    }
    double operator()(const SphericalExponentialDensity& part) const {
        if (!is_valid(part)) return kNan;
        if (part.density == 0) return 0;
        const TwoDoubles altitude = distance_between(x, part.center) + TwoDoubles{-part.radius, 0};
        return value(scaled(part.density) * spherical_density(altitude, part.scale_height));
    }
    double operator()(const GaussianBlob& part) const { return gaussian_density(part, x); }
};

// Of the density along the direction, at x.
struct SlopeAt {
    glm::dvec3 x, direction;
    double density;

    double operator()(const UniformDensity&) const { return 0; }
    double operator()(const LinearHeightDensity& part) const {
        return density > 0 ? part.slope * direction.y : 0;
    }
    double operator()(const ExponentialHeightDensity& part) const {
        return slope_of(density, part.scale_height) * direction.y;
    }
    double operator()(const SphericalExponentialDensity& part) const {
        const glm::dvec3 out = x - part.center;
        const double r = std::hypot(out.x, out.y, out.z);
        return slope_of(density, part.scale_height) * (r > 0 ? glm::dot(out, direction) / r : 1);
    }
    double operator()(const GaussianBlob& part) const {
        return -2 * part.scale * part.scale * glm::dot(x - part.center, direction) * density;
    }
};

struct DepthAlong {
    glm::dvec3 origin, direction;  // unit
    double distance;

    double operator()(const UniformDensity& part) const {
        if (!is_amount(part.density)) return kNan;
        return part.density == 0 || distance == 0 ? 0 : part.density * distance;
    }
    double operator()(const LinearHeightDensity& part) const {
        return linear_height_depth(part.slope, part.density, origin.y, direction.y, distance);
    }
    double operator()(const ExponentialHeightDensity& part) const {
        if (!is_amount(part.density) || !(part.scale_height != 0)) return kNan;
        const double falloff = 1 / part.scale_height;
        if (!std::isfinite(falloff)) return kNan;
        if (part.density == 0) return 0;
        return value(scaled(part.density) *
                     detail::exponential_height_column(origin.y, direction.y, distance, falloff));
    }
    double operator()(const SphericalExponentialDensity& part) const {
        if (!is_valid(part)) return kNan;
        if (part.density == 0) return 0;
        const SphericalPath path = path_of(part, origin, direction);
        if (!(path.r.hi / part.scale_height <= kLargestZ)) return kNan;
        return value(scaled(part.density) *
                     spherical_column(path, part.radius, part.scale_height, distance));
    }
    double operator()(const GaussianBlob& part) const {
        const GaussianPass pass = gaussian_pass(part.center, origin, direction);
        return gaussian_line(part.scale, part.amplitude, pass.rho_perp, pass.m_proj, distance);
    }
};

// At most max_distance; beyond it, that or more.
struct DistanceAtDepth {
    glm::dvec3 origin, direction;
    double depth, max_distance;

    double operator()(const UniformDensity& part) const {
        return is_amount(part.density) ? depth / part.density : kNan;
    }
    double operator()(const LinearHeightDensity& part) const {
        return linear_height_distance(depth, part.slope, part.density, origin.y, direction.y);
    }
    double operator()(const ExponentialHeightDensity& part) const {
        if (!is_amount(part.density) || !(part.scale_height != 0)) return kNan;
        return exponential_height_distance(depth / part.density, origin.y, direction.y,
                                           1 / part.scale_height);
    }
    double operator()(const SphericalExponentialDensity& part) const {
        if (!is_valid(part)) return kNan;
        const SphericalPath path = path_of(part, origin, direction);
        if (!(path.r.hi / part.scale_height <= kLargestZ)) return kNan;
        const SphericalComponent component = {part.density, part.scale_height};
        return spherical_distance(path, &component, 1, part.radius, max_distance, depth);
    }
    double operator()(const GaussianBlob& part) const {
        const GaussianPass pass = gaussian_pass(part.center, origin, direction);
        return gaussian_line_inverse(part.scale, part.amplitude, pass.rho_perp, pass.m_proj, depth);
    }
};

double depth_along(const DensityField& field, const glm::dvec3& origin, const glm::dvec3& direction,
                   double distance) {
    double sum = 0;
    for (const Density& part : field.parts) {
        sum += std::visit(DepthAlong{origin, direction, distance}, part);
    }
    return sum;
}

// A distance at which the field has at least `depth`, +inf if there is none.
double reaching_distance(const DensityField& field, const glm::dvec3& origin,
                         const glm::dvec3& direction, double max_distance, double depth) {
    // What one part gathers all of them do.
    double nearest = max_distance;
    for (const Density& part : field.parts) {
        const double alone =
            std::visit(DistanceAtDepth{origin, direction, depth, max_distance}, part);
        if (alone < nearest) nearest = alone;
    }
    if (std::isfinite(nearest)) return nearest;
    for (double t = 1; t < 1e300; t *= 16) {
        if (depth_along(field, origin, direction, t) >= depth) return t;
    }
    return kInfinity;
}

}  // namespace

double density_at(const Density& density, const glm::dvec3& x) {
    return is_finite(x) ? std::visit(DensityAt{x}, density) : kNan;
}

double density_at(const DensityField& field, const glm::dvec3& x) {
    if (!is_finite(x)) return kNan;
    double sum = 0;
    for (const Density& part : field.parts) sum += std::visit(DensityAt{x}, part);
    return sum;
}

double optical_depth(const Density& density, const glm::dvec3& origin, const glm::dvec3& direction,
                     double distance) {
    const glm::dvec3 v = unit(direction);
    if (!is_finite(origin) || std::isnan(v.x) || !(distance >= 0)) return kNan;
    return std::visit(DepthAlong{origin, v, distance}, density);
}

double optical_depth(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double distance) {
    const glm::dvec3 v = unit(direction);
    if (!is_finite(origin) || std::isnan(v.x) || !(distance >= 0)) return kNan;
    return depth_along(field, origin, v, distance);
}

double transmittance(double depth) {
    return depth >= 0 ? std::exp(-depth) : kNan;
}

double opacity(double depth) {
    return depth >= 0 ? std::abs(std::expm1(-depth)) : kNan;
}

double distance_at_depth(const Density& density, const glm::dvec3& origin,
                         const glm::dvec3& direction, double max_distance, double depth) {
    const glm::dvec3 v = unit(direction);
    if (!is_finite(origin) || std::isnan(v.x) || !(max_distance >= 0) || !(depth >= 0)) return kNan;
    const double whole = std::visit(DepthAlong{origin, v, max_distance}, density);
    if (std::isnan(whole)) return kNan;
    if (depth == 0) return 0;
    if (depth > whole) return depth > whole * (1 + kFullDepth) ? kInfinity : max_distance;
    return std::min(max_distance,
                    std::visit(DistanceAtDepth{origin, v, depth, max_distance}, density));
}

double distance_at_depth(const DensityField& field, const glm::dvec3& origin,
                         const glm::dvec3& direction, double max_distance, double depth) {
    if (field.parts.size() == 1) {
        return distance_at_depth(field.parts[0], origin, direction, max_distance, depth);
    }
    const glm::dvec3 v = unit(direction);
    if (!is_finite(origin) || std::isnan(v.x) || !(max_distance >= 0) || !(depth >= 0)) return kNan;
    const double whole = depth_along(field, origin, v, max_distance);
    if (std::isnan(whole)) return kNan;
    if (depth == 0) return 0;
    if (depth > whole) return depth > whole * (1 + kFullDepth) ? kInfinity : max_distance;
    if (std::isinf(depth)) return max_distance;
    const double hi = reaching_distance(field, origin, v, max_distance, depth);
    if (std::isinf(hi)) return hi;
    const double there = depth_along(field, origin, v, hi);
    if (!(there > depth)) return hi;
    const auto state = [&](double t) {
        const glm::dvec3 x = point(origin, v, t);
        double density = 0, slope = 0;
        for (const Density& part : field.parts) {
            const double here = std::visit(DensityAt{x}, part);
            density += here;
            slope += std::visit(SlopeAt{x, v, here}, part);
        }
        const double reached = depth_along(field, origin, v, t);
        return DepthState{reached / depth, (reached - depth) / density,
                          density > 0 ? slope / density : 0};
    };
    return detail::depth_inverse(state, 0, hi, hi * (depth / there));
}

double density_of_opacity(double opacity, double distance) {
    if (!(opacity >= 0 && opacity <= 1) || !(distance > 0) || std::isinf(distance)) return kNan;
    return std::abs(std::log1p(-opacity)) / distance;
}

double opacity_of_density(double density, double distance) {
    if (!is_amount(density) || !(distance >= 0)) return kNan;
    return density == 0 ? 0 : opacity(density * distance);
}

FreePath sample_free_path(const DensityField& field, const glm::dvec3& origin,
                          const glm::dvec3& direction, double max_distance, double xi) {
    if (!(xi >= 0 && xi <= 1)) return {kNan, kNan};
    const double distance =
        distance_at_depth(field, origin, direction, max_distance, std::abs(std::log1p(-xi)));
    if (distance < kInfinity) return {distance, free_path_pdf(field, origin, direction, distance)};
    return {distance, transmittance(optical_depth(field, origin, direction, max_distance))};
}

FreePath sample_collision(const DensityField& field, const glm::dvec3& origin,
                          const glm::dvec3& direction, double max_distance, double xi) {
    const double whole = optical_depth(field, origin, direction, max_distance);
    if (!(xi >= 0 && xi <= 1) || !(whole > 0)) return {kNan, kNan};
    const double depth = std::min(whole, std::abs(std::log1p(-xi * opacity(whole))));
    const double distance = distance_at_depth(field, origin, direction, max_distance, depth);
    return {distance, collision_pdf(field, origin, direction, max_distance, distance)};
}

double free_path_pdf(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double distance) {
    const double depth = optical_depth(field, origin, direction, distance);
    if (std::isinf(distance)) return std::isnan(depth) ? kNan : 0;
    const double passed = transmittance(depth);
    const double density = density_at(field, point(origin, unit(direction), distance));
    return passed == 0 ? 0 : passed * density;
}

double collision_pdf(const DensityField& field, const glm::dvec3& origin,
                     const glm::dvec3& direction, double max_distance, double distance) {
    const double whole = opacity(optical_depth(field, origin, direction, max_distance));
    if (!(distance <= max_distance)) return std::isnan(distance) || std::isnan(whole) ? kNan : 0;
    return whole == 0 ? kNan : free_path_pdf(field, origin, direction, distance) / whole;
}

std::size_t sample_part(const DensityField& field, const glm::dvec3& x, double xi) {
    const std::size_t none = field.parts.size();
    const double whole = density_at(field, x);
    if (!(whole > 0) || !(xi >= 0 && xi <= 1)) return none;
    double left = xi * whole;
    std::size_t last = none;
    for (std::size_t i = 0; i < none; ++i) {
        const double density = density_at(field.parts[i], x);
        if (!(density > 0)) continue;
        last = i;
        if (left < density) break;
        left -= density;
    }
    return last;
}

}  // namespace airlight
