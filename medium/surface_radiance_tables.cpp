// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_radiance_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "medium/ray_integral.h"
#include "medium/surface_integral.h"

namespace airlight {
namespace {

constexpr double kHalfPi = 0.5 * kPi;
constexpr int kMostPoints = 4096;

void require(bool holds, const char* what, double value, const char* limits) {
    if (holds) return;
    throw Error(ErrorCode::usage,
                std::string(what) + " = " + std::to_string(value) + " is not in " + limits);
}

detail::LobeRing checked_ring(double exponent) {
    require(exponent >= 1 && exponent <= 1000, "exponent", exponent, "[1, 1000]");
    return detail::LobeRing(exponent);
}

double clamped_angle(double theta) {
    return std::min(theta, kPi);
}

double warped_angle(double exponent, int row, int rows) {
    if (exponent >= WarpedSurfaceTable::kFirstNarrow) {
        const double y = static_cast<double>(row) / (rows - 1);
        return clamped_angle(kPi * y * y);
    }
    const double y = static_cast<double>(2 * row - (rows - 1)) / (rows - 1);
    return clamped_angle(kHalfPi * (1 + y * std::abs(y)));
}

double row_of(double exponent, double theta, int rows) {
    if (exponent >= WarpedSurfaceTable::kFirstNarrow) return std::sqrt(theta / kPi) * (rows - 1);
    const double y = theta / kHalfPi - 1;
    return (1 + std::copysign(std::sqrt(std::abs(y)), y)) * (0.5 * (rows - 1));
}

// Weights of the cubic through -1, 0, 1, 2 at x.
void cubic_weights(double x, double (&w)[4]) {
    const double a = x + 1, b = x - 1, c = x - 2;
    w[0] = x * b * c / -6;
    w[1] = a * b * c / 2;
    w[2] = a * x * c / -2;
    w[3] = a * x * b / 6;
}

template <class Value>
std::vector<double> tabulate(int rows, int columns, const Value& value) {
    std::vector<double> values(static_cast<std::size_t>(rows) * columns);
    parallel_blocks(values.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            values[i] = value(static_cast<int>(i) / columns, static_cast<int>(i) % columns);
        }
    });
    return values;
}

}  // namespace

RawSurfaceTable::RawSurfaceTable(double exponent, int size, double max_t)
    : size_(size), max_t_(max_t) {
    const detail::LobeRing ring = checked_ring(exponent);
    require(size >= 2 && size <= kMostPoints, "size", size, "[2, 4096]");
    require(max_t > 0 && std::isfinite(max_t), "max_t", max_t, "(0, inf)");
    values_ = tabulate(size, size, [&](int row, int column) {
        const double t = max_t * column / (size - 1);
        const double theta = clamped_angle(kPi * row / (size - 1));
        return detail::surface_integral(t, theta, ring) * std::exp(-t);
    });
}

double RawSurfaceTable::radiance(double t, double theta, TableLookup how) const {
    theta = detail::checked_angle(theta);
    if (!(t >= 0 && theta >= 0)) return std::numeric_limits<double>::quiet_NaN();
    const double x = std::min(t / max_t_, 1.0) * (size_ - 1), y = theta / kPi * (size_ - 1);
    if (how == TableLookup::nearest) {
        const auto column = static_cast<std::size_t>(x + 0.5),
                   row = static_cast<std::size_t>(y + 0.5);
        return values_[row * size_ + column];
    }
    const int column = std::min(static_cast<int>(x), size_ - 2);
    const int row = std::min(static_cast<int>(y), size_ - 2);
    const double fx = x - column, fy = y - row;
    const double* low = values_.data() + static_cast<std::size_t>(row) * size_ + column;
    const double* high = low + size_;
    return (1 - fy) * ((1 - fx) * low[0] + fx * low[1]) + fy * ((1 - fx) * high[0] + fx * high[1]);
}

WarpedSurfaceTable::WarpedSurfaceTable(double exponent, int size, SurfaceInterpolation how)
    : ring_(checked_ring(exponent)), size_(size), how_(how) {
    require(size >= 8 && size <= kMostPoints, "size", size, "[8, 4096]");
    values_ = tabulate(rows(), columns(), [&](int row, int column) {
        const double x = static_cast<double>(column) / (size - 1);
        return std::log(detail::surface_integral(kThickest * x * x * x * x,
                                                 warped_angle(exponent, row, rows()), ring_));
    });
}

double WarpedSurfaceTable::lookup(double t, double theta) const {
    const double x = std::sqrt(std::sqrt(t / kThickest)) * (size_ - 1);
    const double y = row_of(exponent(), theta, rows());
    const int column = std::min(static_cast<int>(x), size_ - 2);
    const int row = std::min(static_cast<int>(y), rows() - 2);
    if (how_ == SurfaceInterpolation::linear) {
        const double fx = x - column, fy = y - row;
        const double* low = values_.data() + static_cast<std::size_t>(row) * size_ + column;
        const double* high = low + size_;
        return (1 - fy) * ((1 - fx) * low[0] + fx * low[1]) +
               fy * ((1 - fx) * high[0] + fx * high[1]);
    }
    const int first_column = std::clamp(column - 1, 0, size_ - 4);
    const int middle = (rows() - 1) / 2;
    int lowest = 0, highest = rows() - 1;
    if (exponent() < kFirstNarrow) (row < middle ? highest : lowest) = middle;
    const int first_row = std::clamp(row - 1, lowest, highest - 3);
    double wx[4], wy[4], sum = 0;
    cubic_weights(x - first_column - 1, wx);
    cubic_weights(y - first_row - 1, wy);
    const double* line =
        values_.data() + static_cast<std::size_t>(first_row) * size_ + first_column;
    for (int i = 0; i < 4; ++i, line += size_) {
        sum += wy[i] * (wx[0] * line[0] + wx[1] * line[1] + wx[2] * line[2] + wx[3] * line[3]);
    }
    return sum;
}

double WarpedSurfaceTable::radiance_scaled(double t, double theta) const {
    theta = detail::checked_angle(theta);
    if (!(t >= 0 && theta >= 0)) return std::numeric_limits<double>::quiet_NaN();
    if (t <= kThickest) return std::exp(lookup(t, theta));
    return std::isinf(t) ? 0 : detail::surface_integral(t, theta, ring_);
}

double WarpedSurfaceTable::radiance(double t, double theta) const {
    theta = detail::checked_angle(theta);
    if (!(t >= 0 && theta >= 0)) return std::numeric_limits<double>::quiet_NaN();
    if (t <= kThickest) return std::exp(lookup(t, theta) - t);
    const double half = std::exp(-0.5 * t);
    return half == 0 ? 0 : detail::surface_integral(t, theta, ring_) * half * half;
}

}  // namespace airlight
