// SPDX-License-Identifier: Apache-2.0
#include "medium/height_density.h"

#include <cmath>
#include <limits>

#include "medium/height_column.h"

namespace airlight {
namespace {

using detail::ExactSum;
using detail::Scaled;
using detail::scaled;
using detail::TwoDoubles;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-15;

bool is_direction(double up) {
    return up >= -1 && up <= 1;
}

// n (x.hi + x.lo).
TwoDoubles times(double n, TwoDoubles x) {
    const TwoDoubles product = detail::two_product(n, x.hi);
    if (!std::isfinite(product.hi)) return {product.hi, 0};
    return {product.hi, product.lo + n * x.lo};
}

// e^{-n h} at the distance d along the ray. Halves cannot overflow.
Scaled exponential_at(double height, double up, double distance, double falloff) {
    TwoDoubles half = {0.5 * height, 0};
    if (distance > 0) {
        const TwoDoubles rise = detail::two_product(up, 0.5 * distance);
        half = detail::two_sum(half.hi, rise.hi);
        half.lo += rise.lo;
    }
    const TwoDoubles exponent = times(falloff, half);
    return detail::scaled_exp(-2 * exponent.hi, -2 * exponent.lo);
}

struct LinearRay {
    Scaled slope, density, height, up;

    Scaled gradient() const { return slope * up; }
    Scaled density_at_start() const {
        return ExactSum().add(density).add_product(slope, height).sum();
    }
    Scaled density_at(double distance) const {
        return ExactSum()
            .add(density)
            .add_product(slope, height)
            .add_product(slope, up, scaled(distance))
            .sum();
    }
};

// The triangle that a density falling from `density` to 0 encloses.
double triangle(Scaled density, Scaled gradient) {
    return std::abs(value(density * density / gradient * scaled(0.5)));
}

}  // namespace

namespace detail {

Scaled exponential_height_column(double height, double up, double distance, double falloff) {
    if (distance == 0) return {};
    const Scaled rate = scaled(falloff) * scaled(up);
    if (std::isinf(distance)) {
        if (!(rate.mantissa > 0)) return {kInfinity, 0};
        return exponential_at(height, up, 0, falloff) / rate;
    }
    const double decay = value(rate * scaled(distance));
    const Scaled densest = exponential_at(height, up, decay < 0 ? distance : 0, falloff);
    const double y = std::abs(decay);
    if (y < 1) {
        const double phi = y == 0 ? 1 : -std::expm1(-y) / y;
        return densest * scaled(distance) * scaled(phi);
    }
    const Scaled column = densest * scaled(std::expm1(-y)) / rate;
    return {std::abs(column.mantissa), column.exponent};
}

}  // namespace detail

double exponential_height_depth(double height, double up, double distance, double falloff) {
    if (!std::isfinite(height) || !std::isfinite(falloff) || !is_direction(up) || !(distance >= 0))
        return kNan;
    return value(detail::exponential_height_column(height, up, distance, falloff));
}

double exponential_height_distance(double depth, double height, double up, double falloff) {
    if (!std::isfinite(height) || !std::isfinite(falloff) || !is_direction(up) || !(depth >= 0))
        return kNan;
    if (depth == 0 || std::isinf(depth)) return std::abs(depth);
    const Scaled rate = scaled(falloff) * scaled(up);
    const Scaled straight = scaled(depth) * exponential_at(height, up, 0, -falloff);
    const Scaled scaled_w = rate * straight;
    const double w = value(scaled_w);
    if (w >= 1) return kInfinity;
    if (std::abs(w) < 0.5) {
        const double stretch = w == 0 ? 1 : -std::log1p(-w) / w;
        return value(straight * scaled(stretch));
    }
    if (std::isinf(w)) {
        // ln(-w) = ln(-rate depth) + n h, whose exponential no number may hold; by the rate, n h is
        // a plain height.
        const Scaled thin = rate * scaled(depth);
        const double rest = std::log(-thin.mantissa) + thin.exponent * 0.69314718055994530942;
        return std::max(0.0, -height / up - value(scaled(rest) / rate));
    }
    return std::abs(value(scaled(std::log1p(-w)) / rate));
}

double linear_height_depth(double slope, double density, double height, double up,
                           double distance) {
    if (!std::isfinite(slope) || !std::isfinite(density) || !std::isfinite(height) ||
        !is_direction(up) || !(distance >= 0))
        return kNan;
    if (distance == 0) return 0;
    const LinearRay ray = {scaled(slope), scaled(density), scaled(height), scaled(up)};
    const Scaled gradient = ray.gradient();
    const Scaled first = ray.density_at_start();
    if (std::isinf(distance)) {
        if (gradient.mantissa > 0) return kInfinity;
        if (!(first.mantissa > 0)) return 0;
        return gradient.mantissa < 0 ? triangle(first, gradient) : kInfinity;
    }
    const Scaled last = ray.density_at(distance);
    if (first.mantissa >= 0 && last.mantissa >= 0) {
        return value(ExactSum().add(first).add(last).sum() * scaled(0.5) * scaled(distance));
    }
    if (first.mantissa > 0) return triangle(first, gradient);
    if (last.mantissa > 0) return triangle(last, gradient);
    return 0;
}

double linear_height_distance(double depth, double slope, double density, double height,
                              double up) {
    if (!std::isfinite(slope) || !std::isfinite(density) || !std::isfinite(height) ||
        !is_direction(up) || !(depth >= 0))
        return kNan;
    if (depth == 0 || std::isinf(depth)) return std::abs(depth);
    const LinearRay ray = {scaled(slope), scaled(density), scaled(height), scaled(up)};
    const Scaled gradient = ray.gradient();
    const Scaled first = ray.density_at_start();
    const Scaled tau = scaled(depth);
    if (first.mantissa < 0) {
        if (!(gradient.mantissa > 0)) return kInfinity;
        const Scaled empty = {-first.mantissa, first.exponent};
        const Scaled within = square_root(scaled(2) * tau / gradient);
        return value(ExactSum().add(empty / gradient).add(within).sum());
    }
    if (first.mantissa == 0 && !(gradient.mantissa > 0)) return kInfinity;
    Scaled discriminant =
        ExactSum().add_product(first, first).add_product(ray.slope, ray.up, scaled(2) * tau).sum();
    if (discriminant.mantissa < 0) {
        if (std::abs(value(discriminant / (first * first))) > kRounding) return kInfinity;
        discriminant = {0, 0};
    }
    const Scaled sum = ExactSum().add(first).add(square_root(discriminant)).sum();
    return value(scaled(2) * tau / sum);
}

float exponential_height_depth(float height, float up, float distance, float falloff) {
    return static_cast<float>(
        exponential_height_depth(double{height}, double{up}, double{distance}, double{falloff}));
}

float exponential_height_distance(float depth, float height, float up, float falloff) {
    return static_cast<float>(
        exponential_height_distance(double{depth}, double{height}, double{up}, double{falloff}));
}

float linear_height_depth(float slope, float density, float height, float up, float distance) {
    return static_cast<float>(linear_height_depth(double{slope}, double{density}, double{height},
                                                  double{up}, double{distance}));
}

float linear_height_distance(float depth, float slope, float density, float height, float up) {
    return static_cast<float>(linear_height_distance(double{depth}, double{slope}, double{density},
                                                     double{height}, double{up}));
}

}  // namespace airlight
