// SPDX-License-Identifier: Apache-2.0
#include "medium/spherical_density.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/curved_column.h"
#include "medium/depth_inverse.h"
#include "medium/exact_sum.h"
#include "medium/height_density.h"
#include "medium/spherical_path.h"

namespace airlight {
namespace {

using detail::DepthState;
using detail::ExactSum;
using detail::Scaled;
using detail::scaled;
using detail::SphericalPath;
using detail::TwoDoubles;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Shorter segments, in scale heights, have one density.
constexpr double kShort = 1e-17;
constexpr double kLargestZ = 1e300;
// A depth that is the whole ray's but for rounding.
constexpr double kFullDepth = 1e-14;

bool is_cosine(double c) {
    return c >= -1 && c <= 1;
}

bool is_profile(double radius, double scale_height) {
    return radius >= 0 && std::isfinite(radius) && scale_height > 0;
}

SphericalPath path_at_distance(double radius, double r, double c) {
    return detail::spherical_path({r, 0}, detail::two_sum(r, -radius), r == 0 ? 1 : c);
}

TwoDoubles times_power(TwoDoubles a, int exponent) {
    return {std::ldexp(a.hi, exponent), std::ldexp(a.lo, exponent)};
}

TwoDoubles hypotenuse(TwoDoubles a, TwoDoubles b) {
    const double larger = std::max(std::abs(a.hi), std::abs(b.hi));
    if (larger == 0) return {0, 0};
    const int exponent = std::ilogb(larger);
    a = times_power(a, -exponent);
    b = times_power(b, -exponent);
    return times_power(square_root(a * a + b * b), exponent);
}

bool is_ray(const SphericalRay& ray) {
    return ray.center_distance >= 0 && std::isfinite(ray.center_distance) &&
           is_cosine(ray.cos_zenith);
}

// A distance beyond which the ray gathers nothing that a double could show.
double last_distance(const SphericalPath& path, double scale_height) {
    const double climb = 50 * scale_height, along = path.along.hi;
    const double lowest = along < 0 ? path.periapsis.hi : path.r.hi;
    const double chord = std::sqrt(climb) * std::sqrt(2 * lowest + climb);
    const double distance =
        along < 0 ? chord - along : chord * (chord / (std::hypot(along, chord) + along));
    return distance < 1e308 ? distance : 1e308;
}

struct Atmosphere {
    const SphericalComponent* components;
    std::size_t count;
    double radius;

    bool is_valid() const {
        if (!(radius >= 0 && std::isfinite(radius))) return false;
        return std::all_of(components, components + count, [](const SphericalComponent& each) {
            return each.scale_height > 0 && each.extinction >= 0 && std::isfinite(each.extinction);
        });
    }
    bool takes(double r) const {
        return std::all_of(components, components + count, [r](const SphericalComponent& each) {
            return r / each.scale_height <= kLargestZ;
        });
    }
    Scaled depth(const SphericalPath& path, double distance) const {
        Scaled sum = {};
        for (std::size_t i = 0; i < count; ++i) {
            const SphericalComponent& each = components[i];
            if (each.extinction == 0) continue;
            const Scaled term = scaled(each.extinction) *
                                detail::spherical_column(path, radius, each.scale_height, distance);
            sum = std::isinf(term.mantissa) ? term : ExactSum().add(sum).add(term).sum();
        }
        return sum;
    }
    double highest_scale() const {
        double highest = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (components[i].extinction > 0) {
                highest = std::max(highest, components[i].scale_height);
            }
        }
        return highest;
    }
};

double distance_of(const Atmosphere& air, const SphericalPath& path, double max_distance,
                   double depth) {
    if (depth == 0) return 0;
    const Scaled total = air.depth(path, max_distance);
    const double part = value(scaled(depth) / total);
    if (total.mantissa == 0 || part > 1 + kFullDepth) return kInfinity;
    if (part >= 1) return max_distance;
    const double hi = std::min(max_distance, last_distance(path, air.highest_scale()));

    const Scaled sought = scaled(depth);
    const auto state = [&](double t) {
        const double along = path.along.hi + t, there = std::hypot(along, path.periapsis.hi);
        const TwoDoubles rise = {t * ((path.along.hi + along) / (there + path.r.hi)), 0};
        Scaled density = {}, slope = {};
        for (std::size_t i = 0; i < air.count; ++i) {
            const SphericalComponent& each = air.components[i];
            if (each.extinction == 0) continue;
            const Scaled here = scaled(each.extinction) *
                                detail::spherical_density(path.altitude + rise, each.scale_height);
            density = ExactSum().add(density).add(here).sum();
            slope = ExactSum().add(slope).add(here / scaled(each.scale_height)).sum();
        }
        const Scaled reached = air.depth(path, t);
        const Scaled excess =
            ExactSum().add(reached).add({-sought.mantissa, sought.exponent}).sum();
        return DepthState{value(reached / sought), value(excess / density),
                          -value(slope / density) * (there > 0 ? along / there : 1)};
    };
    // As if the atmosphere were flat.
    const DepthState first = state(0);
    const double falloff = -first.slope;
    double guess =
        exponential_height_distance(-first.step, 0.0, falloff < 0 ? -1.0 : 1.0, std::abs(falloff));
    if (!(guess < hi)) guess = hi * part;
    return detail::depth_inverse(state, 0, hi, guess);
}

double checked_distance(const Atmosphere& air, const SphericalRay& ray, double max_distance,
                        double depth) {
    if (!air.is_valid() || !is_ray(ray) || !(max_distance >= 0) || !(depth >= 0) ||
        !air.takes(ray.center_distance))
        return kNan;
    return distance_of(air, path_at_distance(air.radius, ray.center_distance, ray.cos_zenith),
                       max_distance, depth);
}

// The start's altitude and the lengths are exact enough in double where the arguments are floats.
float fast_depth(double radius, double scale_height, double r, double altitude, double c,
                 double distance) {
    if (!is_profile(radius, scale_height) || !(r >= 0) || std::isinf(r) || !is_cosine(c) ||
        !(distance >= 0))
        return std::numeric_limits<float>::quiet_NaN();
    if (distance == 0) return 0;
    if (std::isinf(scale_height)) return static_cast<float>(distance);
    const double per_height = 1 / scale_height;
    double integral = 0;
    if (c >= 0 || r == 0) {
        integral =
            detail::curved_column_fast(r * per_height, r == 0 ? 1 : c, distance * per_height);
    } else {
        const double sine = std::sqrt((1 - c) * (1 + c));
        const double along = r * c, end = along + distance, periapsis = r * sine;
        if (end <= 0) {
            const double low = std::sqrt(end * end + periapsis * periapsis);
            altitude += distance * ((along + end) / (low + r));
            integral = detail::curved_column_fast(low * per_height, low == 0 ? 1 : -end / low,
                                                  distance * per_height);
        } else {
            altitude += along * (-c / (1 + sine));
            const double z = periapsis * per_height;
            integral = detail::curved_column_fast(z, 0, -along * per_height) +
                       detail::curved_column_fast(z, 0, end * per_height);
        }
    }
    return static_cast<float>(scale_height * integral * std::exp(-altitude * per_height));
}

}  // namespace

namespace detail {

SphericalPath spherical_path(TwoDoubles r, TwoDoubles altitude, double c) {
    // Rays that rise are done without their periapsis.
    const TwoDoubles sine = c >= 0 ? TwoDoubles{std::sqrt((1 - c) * (1 + c)), 0}
                                   : square_root(two_sum(1, -c) * two_sum(1, c));
    return {r, altitude, r * TwoDoubles{c, 0}, r * sine};
}

Scaled spherical_density(TwoDoubles altitude, double scale_height) {
    if (std::isinf(scale_height)) return scaled(1);
    const double hi = altitude.hi / scale_height;
    if (!std::isfinite(hi)) return scaled_exp(-hi);
    const double rest = std::fma(-hi, scale_height, altitude.hi) + altitude.lo;
    return scaled_exp(-hi, -rest / scale_height);
}

// From whichever point of the segment is densest.
Scaled spherical_column(const SphericalPath& path, double radius, double scale_height,
                        double distance) {
    if (distance == 0) return {};
    if (std::isinf(scale_height)) return scaled(distance);
    const double t = distance / scale_height;
    const auto from = [&](TwoDoubles altitude, double integral) {
        const Scaled length =
            t < kShort ? scaled(distance) : scaled(scale_height) * scaled(integral);
        return length * spherical_density(altitude, scale_height);
    };
    if (path.along.hi >= 0) {
        const double c = path.r.hi == 0 ? 1 : std::min(1.0, path.along.hi / path.r.hi);
        return from(path.altitude, curved_column(path.r.hi / scale_height, c, t));
    }
    const TwoDoubles end =
        std::isinf(distance) ? TwoDoubles{distance, 0} : path.along + TwoDoubles{distance, 0};
    if (end.hi <= 0) {
        const TwoDoubles low = hypotenuse(end, path.periapsis);
        const double c = low.hi == 0 ? 1 : std::min(1.0, -end.hi / low.hi);
        return from(low + TwoDoubles{-radius, 0}, curved_column(low.hi / scale_height, c, t));
    }
    const double z = path.periapsis.hi / scale_height;
    return from(path.periapsis + TwoDoubles{-radius, 0},
                curved_column(z, 0, -path.along.hi / scale_height) +
                    curved_column(z, 0, end.hi / scale_height));
}

double spherical_distance(const SphericalPath& path, const SphericalComponent* components,
                          std::size_t count, double radius, double max_distance, double depth) {
    return distance_of({components, count, radius}, path, max_distance, depth);
}

}  // namespace detail

double spherical_depth(const SphericalProfile& profile, const SphericalRay& ray, double distance) {
    if (!is_profile(profile.radius, profile.scale_height) || !is_ray(ray) || !(distance >= 0) ||
        ray.center_distance / profile.scale_height > kLargestZ)
        return kNan;
    return value(detail::spherical_column(
        path_at_distance(profile.radius, ray.center_distance, ray.cos_zenith), profile.radius,
        profile.scale_height, distance));
}

double spherical_depth_at_altitude(const SphericalProfile& profile, double altitude,
                                   double cos_zenith, double distance) {
    const TwoDoubles r = detail::two_sum(profile.radius, altitude);
    if (!is_profile(profile.radius, profile.scale_height) || !is_ray({r.hi, cos_zenith}) ||
        !(distance >= 0) || r.hi / profile.scale_height > kLargestZ)
        return kNan;
    const SphericalPath path = detail::spherical_path(r, {altitude, 0}, r.hi == 0 ? 1 : cos_zenith);
    return value(detail::spherical_column(path, profile.radius, profile.scale_height, distance));
}

float spherical_depth(float radius, float scale_height, float center_distance, float cos_zenith,
                      float distance) {
    return fast_depth(radius, scale_height, center_distance,
                      double{center_distance} - double{radius}, cos_zenith, distance);
}

float spherical_depth_at_altitude(float radius, float scale_height, float altitude,
                                  float cos_zenith, float distance) {
    return fast_depth(radius, scale_height, double{radius} + double{altitude}, altitude, cos_zenith,
                      distance);
}

double spherical_depth(const SphericalComponent* components, std::size_t count, double radius,
                       const SphericalRay& ray, double distance) {
    const Atmosphere air = {components, count, radius};
    if (!air.is_valid() || !is_ray(ray) || !(distance >= 0) || !air.takes(ray.center_distance))
        return kNan;
    return value(
        air.depth(path_at_distance(radius, ray.center_distance, ray.cos_zenith), distance));
}

double spherical_distance(const SphericalProfile& profile, const SphericalRay& ray,
                          double max_distance, double depth) {
    const SphericalComponent component = {1, profile.scale_height};
    return checked_distance({&component, 1, profile.radius}, ray, max_distance, depth);
}

double spherical_distance(const SphericalComponent* components, std::size_t count, double radius,
                          const SphericalRay& ray, double max_distance, double depth) {
    return checked_distance({components, count, radius}, ray, max_distance, depth);
}

float spherical_distance(float radius, float scale_height, float center_distance, float cos_zenith,
                         float max_distance, float depth) {
    return static_cast<float>(spherical_distance(SphericalProfile{radius, scale_height},
                                                 SphericalRay{center_distance, cos_zenith},
                                                 double{max_distance}, double{depth}));
}

}  // namespace airlight
