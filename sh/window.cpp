// SPDX-License-Identifier: Apache-2.0
#include "sh/window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "sh/index.h"
#include "sh/low_places.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool keeps_bound(const LowPlaces& places, int order, std::size_t channels,
                 const double* coefficients, double least, double strength) {
    const std::vector<double> factors = smoothing_window(order, strength);
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const double* own = coefficients + channel * sh_count(order);
        std::vector<double> smooth(own, own + sh_count(order));
        apply_window(factors, 1, smooth.data());
        // Degree 0 is the mean times sqrt(4 pi).
        if (smooth[0] > 0 &&
            places.lowest(smooth.data()).value * std::sqrt(4 * kPi) < least * smooth[0]) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::vector<double> hann_window(int order) {
    std::vector<double> w;
    for (int l = 0; l < order; ++l) w.push_back((1 + std::cos(kPi * l / order)) / 2);
    return w;
}

std::vector<double> lanczos_window(int order) {
    std::vector<double> w;
    for (int l = 0; l < order; ++l) {
        const double x = kPi * l / order;
        w.push_back(l == 0 ? 1 : std::sin(x) / x);
    }
    return w;
}

std::vector<double> smoothing_window(int order, double strength) {
    if (!(strength >= 0)) {
        throw Error(ErrorCode::usage,
                    fmt::format("strength {} of a smoothing window is not >= 0", strength));
    }
    std::vector<double> w;
    if (order >= 1) w.push_back(1);
    for (int l = 1; l < order; ++l) {
        const double laplacian = static_cast<double>(l) * (l + 1);
        w.push_back(1 / (1 + strength * laplacian * laplacian));
    }
    return w;
}

double least_value(int order, const double* coefficients) {
    return LowPlaces(order).lowest(coefficients).value;
}

AutomaticWindow automatic_window(int order, std::size_t channels, const double* coefficients,
                                 double least) {
    if (order < 1 || order > kLargestAutomaticOrder) {
        throw Error(ErrorCode::usage, "order " + std::to_string(order) +
                                          " of an automatic window is not in [1, " +
                                          std::to_string(kLargestAutomaticOrder) + "]");
    }
    if (!(least < 1)) {
        throw Error(ErrorCode::usage,
                    fmt::format("an automatic window's bound is {}, not below 1", least));
    }
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const double* own = coefficients + channel * sh_count(order);
        for (std::size_t k = 0; k < sh_count(order); ++k) {
            if (std::isfinite(own[k])) continue;
            throw Error(ErrorCode::data, "coefficient " + std::to_string(k) + " of channel " +
                                             std::to_string(channel) + " is not finite");
        }
        const bool zero = std::all_of(own, own + sh_count(order), [](double c) { return c == 0; });
        if (!zero && !(own[0] > 0)) {
            throw Error(ErrorCode::data, "channel " + std::to_string(channel) +
                                             " has no positive mean, so no window can bring it "
                                             "above a bound");
        }
    }
    const LowPlaces places(order);
    const auto passes = [&](double strength) {
        return keeps_bound(places, order, channels, coefficients, least, strength);
    };
    AutomaticWindow window;
    if (!passes(0)) {
        double low = 0, high = 1e-6;
        while (high < kInfinity && !passes(high)) {
            low = high;
            high *= 4;
        }
        while (high < kInfinity && high - low > 1e-6 * high) {
            const double middle = low + (high - low) / 2;
            (passes(middle) ? high : low) = middle;
        }
        window.strength = high;
    }
    window.factors = smoothing_window(order, window.strength);
    return window;
}

void apply_window(const std::vector<double>& factors, std::size_t channels, double* coefficients) {
    zonal_convolve(factors, channels, coefficients);
}

}  // namespace airlight
