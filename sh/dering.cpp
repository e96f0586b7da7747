// SPDX-License-Identifier: Apache-2.0
#include "sh/dering.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/least_norm.h"
#include "sh/low_places.h"
#include "sh/window.h"

namespace airlight {
namespace {

constexpr int kRounds = 60;
constexpr double kTolerance = 1e-6;
constexpr double kSteepest = 1e10;
/// Of the way from the bound to the mean: so far inside is the aim, since places are not found to
/// the last digit.
constexpr double kInside = 1e-7;

/// Coefficients over the mean, so that the function's mean is 1 and degree 0 is left out of sums.
std::vector<double> over_mean(int order, const double* coefficients) {
    std::vector<double> c(coefficients, coefficients + sh_count(order));
    // Not by the mean, which may be too small a number to be told from 0.
    for (double& x : c) x = x / coefficients[0] * std::sqrt(4 * kPi);
    return c;
}

/// The part in [0, 1] of what differs from the mean that keeps the bound.
double part_above(const LowPlaces& places, const std::vector<double>& c, double least) {
    const double aim = least + kInside * (1 - least), low = places.lowest(c.data()).value;
    return low < aim ? (1 - aim) / (1 - low) : 1;
}

std::vector<double> nearest(const LowPlaces& places, const double* coefficients, double least) {
    const int order = places.order();
    const std::vector<double> c = over_mean(order, coefficients);
    std::vector<double> changed = c, basis(c.size());
    LeastNorm programme(c.size() - 1);
    for (int round = 0; round < kRounds; ++round) {
        auto low = places.below(changed.data(), least - kTolerance * (1 - least));

        if (low.empty()) break;
        for (const LowPlace& place : low) {
            const auto& d = place.direction;
            evaluate_basis(order, d[0], d[1], d[2], basis.data());
            double value = 0;
            for (std::size_t k = 0; k < c.size(); ++k) value += c[k] * basis[k];
            programme.add({basis.begin() + 1, basis.end()}, least - value);
        }
        const std::vector<double> x = programme.solve();
        for (std::size_t k = 1; k < c.size(); ++k) changed[k] = c[k] + x[k - 1];
    }
    const double part = part_above(places, changed, least);
    std::vector<double> out = {coefficients[0]};
    for (std::size_t k = 1; k < c.size(); ++k) {
        // What needs no change keeps its bits.
        out.push_back(part == 1 && changed[k] == c[k]
                          ? coefficients[k]
                          : part * changed[k] / std::sqrt(4 * kPi) * coefficients[0]);
    }
    return out;
}

/// Whether the mean is so small that nothing beside it can be told from the bound.
bool is_steep(int order, const double* c) {
    return std::any_of(c, c + sh_count(order),
                       [&](double x) { return std::abs(x) > kSteepest * c[0]; });
}

bool is_zero(int order, const double* c) {
    return std::all_of(c, c + sh_count(order), [](double x) { return x == 0; });
}

}  // namespace

const char* name_of(DeringMethod method) {
    switch (method) {
        case DeringMethod::smoothing:
            return "smoothing";
        case DeringMethod::bands:
            return "bands";
        case DeringMethod::nearest:
            return "nearest";
    }
    return "";
}

std::vector<double> least_change_window(int order, std::size_t channels, const double* coefficients,
                                        double least) {
    // Judges the arguments, too.
    const AutomaticWindow smoothing = automatic_window(order, channels, coefficients, least);
    if (smoothing.strength == 0) return smoothing.factors;
    const LowPlaces places(order);
    const auto degrees = static_cast<std::size_t>(order);
    std::vector<std::vector<double>> lights;
    std::vector<double> norms(degrees);
    double largest = 0;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const double* own = coefficients + channel * sh_count(order);
        if (!is_zero(order, own)) {
            if (is_steep(order, own)) return smoothing.factors;
            lights.push_back(over_mean(order, own));
            largest = std::max(largest, own[0]);
        }
    }
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const double* own = coefficients + channel * sh_count(order);
        for (std::size_t l = 1; l < degrees; ++l) {
            for (std::size_t k = l * l; k < (l + 1) * (l + 1); ++k) {
                norms[l] = std::hypot(norms[l], own[k] / largest);
            }
        }
    }
    // Unknowns are norm_l (1 - w_l).
    LeastNorm programme(degrees - 1);
    for (std::size_t l = 1; l < degrees; ++l) {
        if (norms[l] == 0) continue;
        std::vector<double> row(degrees - 1);
        row[l - 1] = 1;
        programme.add(row, 0);
        row[l - 1] = -1;
        programme.add(row, -norms[l]);
    }
    std::vector<double> w(degrees, 1.0), basis(sh_count(order));
    for (int round = 0; round < kRounds; ++round) {
        bool kept = true;
        for (const std::vector<double>& light : lights) {
            std::vector<double> windowed = light;
            apply_window(w, 1, windowed.data());
            for (const LowPlace& place :
                 places.below(windowed.data(), least - kTolerance * (1 - least))) {
                kept = false;
                const auto& d = place.direction;
                evaluate_basis(order, d[0], d[1], d[2], basis.data());
                std::vector<double> row(degrees - 1);
                double value = 1;
                for (std::size_t l = 1; l < degrees; ++l) {
                    double band = 0;
                    for (std::size_t k = l * l; k < (l + 1) * (l + 1); ++k) {
                        band += light[k] * basis[k];
                    }
                    value += band;
                    row[l - 1] = norms[l] > 0 ? -band / norms[l] : 0;
                }
                programme.add(row, least - value);
            }
        }
        if (kept) break;
        const std::vector<double> x = programme.solve();
        for (std::size_t l = 1; l < degrees; ++l) {
            w[l] = norms[l] > 0 ? std::clamp(1 - x[l - 1] / norms[l], 0.0, 1.0) : 1;
        }
    }
    double part = 1;
    for (const std::vector<double>& light : lights) {
        std::vector<double> windowed = light;
        apply_window(w, 1, windowed.data());
        part = std::min(part, part_above(places, windowed, least));
    }
    for (std::size_t l = 1; l < degrees; ++l) w[l] *= part;
    return w;
}

std::vector<double> dering(DeringMethod method, int order, std::size_t channels,
                           const double* coefficients, double least) {
    std::vector<double> out;
    if (method == DeringMethod::nearest) {
        const AutomaticWindow smoothing = automatic_window(order, channels, coefficients, least);
        out.assign(coefficients, coefficients + channels * sh_count(order));
        if (smoothing.strength == 0) return out;
        const LowPlaces places(order);
        for (std::size_t channel = 0; channel < channels; ++channel) {
            const double* own = coefficients + channel * sh_count(order);
            if (is_zero(order, own)) continue;
            std::vector<double> changed(own, own + sh_count(order));
            if (is_steep(order, own)) {
                apply_window(automatic_window(order, 1, own, least).factors, 1, changed.data());
            } else {
                changed = nearest(places, own, least);
            }
            std::copy(changed.begin(), changed.end(),
                      out.begin() + static_cast<std::ptrdiff_t>(channel * sh_count(order)));
        }
        return out;
    }
    const std::vector<double> w =
        method == DeringMethod::bands
            ? least_change_window(order, channels, coefficients, least)
            : automatic_window(order, channels, coefficients, least).factors;
    out.assign(coefficients, coefficients + channels * sh_count(order));
    apply_window(w, channels, out.data());
    return out;
}

}  // namespace airlight
