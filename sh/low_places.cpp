// SPDX-License-Identifier: Apache-2.0
#include "sh/low_places.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"

namespace airlight {
namespace {

using Vector = std::array<double, 3>;

Vector unit(const Vector& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

/// Coefficients divided by a power of two so that their largest lies in [0.5, 1).
struct Scaled {
    std::vector<double> coefficients;
    int exponent = 0;
    bool finite = true;
};

Scaled scaled(std::size_t count, const double* coefficients) {
    Scaled out{{coefficients, coefficients + count}};
    double largest = 0;
    for (const double c : out.coefficients) {
        if (!std::isfinite(c)) out.finite = false;
        largest = std::max(largest, std::abs(c));
    }
    if (!out.finite || largest == 0) return out;
    std::frexp(largest, &out.exponent);
    for (double& c : out.coefficients) c = std::ldexp(c, -out.exponent);
    return out;
}

}  // namespace

LowPlaces::LowPlaces(int order) : order_(order), rows_(4 * order + 2), columns_(2 * rows_) {
    assert(order >= 1);
    for (int j = 0; j < rows_; ++j) {
        const double theta = kPi * (j + 0.5) / rows_;
        for (int i = 0; i < columns_; ++i) {
            const double phi = 2 * kPi * i / columns_;
            x_.push_back(std::sin(theta) * std::cos(phi));
            y_.push_back(std::sin(theta) * std::sin(phi));
            z_.push_back(std::cos(theta));
        }
    }
}

std::vector<double> LowPlaces::samples(const double* coefficients) const {
    std::vector<double> values(x_.size());
    reconstruct_basis_batch(order_, x_.size(), x_.data(), y_.data(), z_.data(), 1, coefficients,
                            values.data());
    return values;
}

LowPlace LowPlaces::lowest(const double* coefficients) const {
    const Scaled own = scaled(sh_count(order_), coefficients);
    if (!own.finite) return {{0, 0, 1}, std::numeric_limits<double>::quiet_NaN()};
    const double* c = own.coefficients.data();
    const std::vector<double> values = samples(c);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double range = *high - *low;
    const std::size_t first = static_cast<std::size_t>(low - values.begin());
    LowPlace best{{x_[first], y_[first], z_[first]}, *low};
    if (range > 1e-12 * std::max(std::abs(*low), std::abs(*high))) {
        const double reach = *low + 0.09 * range;
        for (int j = 0; j < rows_; ++j) {
            for (int i = 0; i < columns_; ++i) {
                const double value = values[at(j, i)];
                if (value > reach || !is_low_around(values, j, i)) continue;
                const LowPlace place = descend(c, at(j, i), value);
                if (place.value < best.value) best = place;
            }
        }
    }
    best.value = std::ldexp(best.value, own.exponent);
    return best;
}

std::vector<LowPlace> LowPlaces::below(const double* coefficients, double bound) const {
    const Scaled own = scaled(sh_count(order_), coefficients);
    std::vector<LowPlace> places;
    if (!own.finite) return places;
    const double* c = own.coefficients.data();
    const std::vector<double> values = samples(c);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double reach = std::ldexp(bound, -own.exponent) + 0.09 * (*high - *low);
    for (int j = 0; j < rows_; ++j) {
        for (int i = 0; i < columns_; ++i) {
            const double value = values[at(j, i)];
            if (value > reach || !is_low_around(values, j, i)) continue;
            LowPlace place = descend(c, at(j, i), value);
            place.value = std::ldexp(place.value, own.exponent);
            const auto same = [&](const LowPlace& other) {
                const auto &a = place.direction, &b = other.direction;
                return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 0.02 * kPi / rows_;
            };
            if (place.value < bound && std::none_of(places.begin(), places.end(), same)) {
                places.push_back(place);
            }
        }
    }
    return places;
}

std::size_t LowPlaces::at(int j, int i) const {
    return static_cast<std::size_t>(j) * columns_ + (i + columns_) % columns_;
}

bool LowPlaces::is_low_around(const std::vector<double>& values, int j, int i) const {
    const double value = values[at(j, i)];
    int lower = 0;
    for (int dj = -1; dj <= 1; ++dj) {
        if (j + dj < 0 || j + dj >= rows_) continue;
        for (int di = -1; di <= 1; ++di) lower += values[at(j + dj, i + di)] < value;
    }
    return lower <= 2;
}

double LowPlaces::value_at(const double* coefficients, const Vector& direction,
                           std::vector<double>& basis) const {
    evaluate_basis(order_, direction[0], direction[1], direction[2], basis.data());
    double sum = 0;
    for (std::size_t k = 0; k < basis.size(); ++k) sum += coefficients[k] * basis[k];
    return sum;
}

LowPlace LowPlaces::descend(const double* coefficients, std::size_t sample, double value) const {
    std::vector<double> basis(sh_count(order_));
    Vector place = {x_[sample], y_[sample], z_[sample]};
    double step = kPi / rows_;
    const double widest = step, end = 1e-5 * step;
    // A level valley would take many more, for nothing.
    for (int round = 0; round < 200 && step > end; ++round) {
        const Vector away = std::abs(place[2]) < 0.7 ? Vector{0, 0, 1} : Vector{1, 0, 0};
        const Vector u =
            unit({place[1] * away[2] - place[2] * away[1], place[2] * away[0] - place[0] * away[2],
                  place[0] * away[1] - place[1] * away[0]});
        const Vector v = {place[1] * u[2] - place[2] * u[1], place[2] * u[0] - place[0] * u[2],
                          place[0] * u[1] - place[1] * u[0]};
        const auto beside = [&](double a, double b) {
            return unit({place[0] + a * u[0] + b * v[0], place[1] + a * u[1] + b * v[1],
                         place[2] + a * u[2] + b * v[2]});
        };
        // Eight places around, and the lowest one of the parabola through them.
        double around[8];
        Vector next = place;
        double lowest = value;
        for (int k = 0; k < 8; ++k) {
            const Vector trial = beside(step * std::cos(k * kPi / 4), step * std::sin(k * kPi / 4));
            around[k] = value_at(coefficients, trial, basis);
            if (around[k] < lowest) {
                lowest = around[k];
                next = trial;
            }
        }
        const double diagonal = std::sqrt(0.5);
        const double fa =
            (around[0] - around[4] + diagonal * (around[1] + around[7] - around[3] - around[5])) /
            4;
        const double fb =
            (around[2] - around[6] + diagonal * (around[1] + around[3] - around[5] - around[7])) /
            4;
        const double faa = around[0] + around[4] - 2 * value;
        const double fbb = around[2] + around[6] - 2 * value;
        const double fab = (around[1] + around[5] - around[3] - around[7]) / 2;
        const double damping = 1e-9 * (std::abs(faa) + std::abs(fbb));
        const double determinant = (faa + damping) * (fbb + damping) - fab * fab;
        double reduction = 2;
        if (faa > 0 && determinant > 0) {
            double a = (fab * fb - (fbb + damping) * fa) / determinant;
            double b = (fab * fa - (faa + damping) * fb) / determinant;
            const double length = std::hypot(a, b);
            // Along a valley the parabola sees further than its places.
            const double farthest = std::min(4.0, widest / step);
            if (length > farthest) {
                a *= farthest / length;
                b *= farthest / length;
            }
            const Vector trial = beside(step * a, step * b);
            const double there = value_at(coefficients, trial, basis);
            if (there <= lowest) {
                lowest = there;
                next = trial;
                if (length < 1) reduction = 8;
            }
        }
        const bool moved = next != place;
        step = !moved || reduction > 2 ? step / reduction : std::min(2 * step, widest);
        place = next;
        value = lowest;
    }
    return {place, value};
}

}  // namespace airlight
