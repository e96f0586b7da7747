// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight_tables.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "medium/airlight.h"
#include "medium/airlight_rungs.h"
#include "medium/ray_integral.h"
#include "medium/ray_triangle.h"
#include "medium/special_f.h"

namespace airlight {
namespace {

constexpr double kThickest = 50;
constexpr int kFallbackNodes = 8;

double cube(double x) {
    return x * x * x;
}

// Bilinear interpolation in a row-major table with size columns; x and y in [0, size - 1].
double bilinear(const std::vector<double>& values, int size, double x, double y) {
    const int column = std::min(static_cast<int>(x), size - 2);
    const int row = std::min(static_cast<int>(y), size - 2);
    const double fx = x - column, fy = y - row;
    const double* low = values.data() + static_cast<std::size_t>(row) * size + column;
    const double* high = low + size;
    return (1 - fy) * ((1 - fx) * low[0] + fx * low[1]) + fy * ((1 - fx) * high[0] + fx * high[1]);
}

}  // namespace

SpecialFTable::SpecialFTable(int size, double max_u)
    : size_(size), max_u_(max_u), values_(static_cast<std::size_t>(size) * size) {
    assert(size >= 2 && max_u > 0 && std::isfinite(max_u));
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            values_[static_cast<std::size_t>(row) * size + column] =
                special_f(max_u * column / (size - 1), 0.5 * kPi * row / (size - 1));
        }
    }
}

double SpecialFTable::lookup(double u, double v, TableLookup how) const {
    if (!(u >= 0 && v >= 0)) return std::numeric_limits<double>::quiet_NaN();
    const double last = size_ - 1;
    const double x = std::clamp(u / max_u_, 0.0, 1.0) * last;
    const double y = std::clamp(v / (0.5 * kPi), 0.0, 1.0) * last;
    if (how == TableLookup::bilinear) return bilinear(values_, size_, x, y);
    const auto column = static_cast<std::size_t>(x + 0.5), row = static_cast<std::size_t>(y + 0.5);
    return values_[row * size_ + column];
}

double SpecialFTable::airlight(double gamma, double t_sv, double t_vp, TableLookup how) const {
    const bool inside = gamma > 0 && gamma <= kPi && t_sv > 0 && std::isfinite(t_sv) && t_vp > 0;
    if (!inside) return ::airlight::airlight(gamma, t_sv, t_vp);
    const double a1 = t_sv * std::sin(gamma);
    const double along = t_sv * std::cos(gamma);
    if (a1 == 0) return ::airlight::airlight(gamma, t_sv, t_vp);
    const double a0 = std::exp(-along) / (2 * kPi * a1);
    const double v = 0.25 * kPi + 0.5 * std::atan((t_vp - along) / a1);
    const double value = a0 * (lookup(a1, v, how) - lookup(a1, 0.5 * gamma, how));
    return std::isfinite(value) ? std::max(0.0, value) : ::airlight::airlight(gamma, t_sv, t_vp);
}

WarpedAirlightTable::WarpedAirlightTable(int size, double least_part)
    : size_(size), least_part_(least_part), values_(static_cast<std::size_t>(size) * size) {
    assert(size >= 2 && least_part >= 0 && least_part <= 1);
    for (int row = 0; row < size; ++row) {
        const detail::RayAngle angle =
            detail::ray_angle(std::min(kPi, kPi * cube(static_cast<double>(row) / (size - 1))));
        for (int column = 0; column < size; ++column) {
            const double t = kThickest * cube(static_cast<double>(column) / (size - 1));
            values_[static_cast<std::size_t>(row) * size + column] =
                detail::infinite_ray_integral(2 * t * angle.cos_theta, angle) * angle.sin_theta /
                angle.theta;
        }
    }
}

double WarpedAirlightTable::lookup(double t, double gamma) const {
    if (!(t >= 0 && gamma >= 0)) return std::numeric_limits<double>::quiet_NaN();
    const double last = size_ - 1;
    const double x = std::cbrt(std::clamp(t / kThickest, 0.0, 1.0)) * last;
    const double y = std::cbrt(std::clamp(gamma / kPi, 0.0, 1.0)) * last;
    return bilinear(values_, size_, x, y);
}

double WarpedAirlightTable::airlight(double gamma, double t_sv, double t_vp) const {
    bool served = true;
    const auto integral = [&](const detail::RayTriangle<double>& r) {
        // H(y, theta, inf) = R theta / sin(theta)
        const detail::RayAngle angle = detail::ray_angle(r.gamma);
        const double whole = lookup(t_sv, r.gamma) * angle.theta / angle.sin_theta;
        if (std::isinf(r.x_end)) return whole;
        const double along = r.x_end + angle.cos_theta;
        const double distance = std::sqrt(along * along + angle.sin_theta * angle.sin_theta);
        const double theta = std::atan2(angle.sin_theta, along);
        const double sine = angle.sin_theta / distance;
        const double t_end = r.y * distance * distance / (2 * along);
        const double tail =
            std::exp(-r.y * r.x_end) / distance * lookup(t_end, kPi - 2 * theta) * theta / sine;
        const double h = whole - tail;
        served = t_end <= kThickest && h > least_part_ * whole && std::isfinite(h);
        return r.ends_near ? h / r.x_end : h;
    };
    if (t_sv > kThickest) return airlight_sinh_gl(gamma, t_sv, t_vp, kFallbackNodes);
    const double value = detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), integral);
    return served ? value : airlight_sinh_gl(gamma, t_sv, t_vp, kFallbackNodes);
}

}  // namespace airlight
