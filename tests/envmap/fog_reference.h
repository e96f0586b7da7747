// SPDX-License-Identifier: Apache-2.0
// The slow, plain way to fog a map: every pixel's average of the PSF by brute subdivision, then a
// direct sum over all pixels. Shares nothing with the library but the PSF itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/constants.h"
#include "envmap/image.h"
#include "medium/psf.h"

namespace airlight::test {

/// Integral of psf(angle to the centre (theta_i, 0)) over the rectangle [t0, t1] x [p0, p1] of
/// colatitude and azimuth: halved along its longer side until it is at most 0.4 of its distance
/// long, then 5 x 5 Gauss-Legendre points; what is left at depth 60 around the singular point is
/// below 1e-15 of the integral.
inline double pixel_integral(const std::function<double(double)>& psf, double theta_i, double t0,
                             double t1, double p0, double p1, int depth = 0) {
    static const double node[] = {-0.906179845938663993, -0.538469310105683091, 0,
                                  0.538469310105683091, 0.906179845938663993};
    static const double weight[] = {0.236926885056189088, 0.478628670499366468,
                                    0.568888888888888889, 0.478628670499366468,
                                    0.236926885056189088};
    const auto angle = [&](double t, double p) {
        const double a = std::sin(0.5 * (t - theta_i)), b = std::sin(0.5 * p);
        return 2 *
               std::asin(std::min(1.0, std::sqrt(a * a + std::sin(t) * std::sin(theta_i) * b * b)));
    };
    const double tc = 0.5 * (t0 + t1), pc = 0.5 * (p0 + p1);
    const double high = t1 - t0, wide = (p1 - p0) * std::max(std::sin(t0), std::sin(t1));
    const double distance =
        angle(tc, pc) - 0.5 * std::sqrt(high * high + wide * wide);  // at least, roughly
    if (std::max(high, wide) > 0.4 * distance && depth < 60) {
        // The widest parallel of a rectangle across the equator is the equator.
        const bool across = high > (t0 < kPi / 2 && t1 > kPi / 2 ? p1 - p0 : wide);
        if (across) {
            return pixel_integral(psf, theta_i, t0, tc, p0, p1, depth + 1) +
                   pixel_integral(psf, theta_i, tc, t1, p0, p1, depth + 1);
        }
        return pixel_integral(psf, theta_i, t0, t1, p0, pc, depth + 1) +
               pixel_integral(psf, theta_i, t0, t1, pc, p1, depth + 1);
    }
    double sum = 0;
    for (int a = 0; a < 5; ++a) {
        const double t = tc + 0.5 * high * node[a];
        for (int b = 0; b < 5; ++b) {
            const double p = pc + 0.5 * (p1 - p0) * node[b];
            sum += weight[a] * weight[b] * psf(angle(t, p)) * std::sin(t);
        }
    }
    return 0.25 * high * (p1 - p0) * sum;
}

/// Pixel integrals from one output row to all pixels: (rows, columns/2 + 1).
inline std::vector<double> row_integrals(const std::function<double(double)>& psf, int rows,
                                         int columns, int row) {
    std::vector<double> taps;
    const double theta_i = kPi * (row + 0.5) / rows, width = 2 * kPi / columns;
    for (int j = 0; j < rows; ++j) {
        for (int k = 0; k <= columns / 2; ++k) {
            const double t0 = kPi * j / rows, t1 = kPi * (j + 1) / rows;
            double sum = 0;
            // A pixel that holds the centre is cut there, so that the singular point is a corner.
            const double cuts_p[] = {(k - 0.5) * width, k == 0 ? 0.0 : (k - 0.5) * width,
                                     (k + 0.5) * width};
            const double cuts_t[] = {t0, j == row ? theta_i : t0, t1};
            for (int a = 0; a < 2; ++a) {
                for (int b = 0; b < 2; ++b) {
                    if (cuts_t[a] < cuts_t[a + 1] && cuts_p[b] < cuts_p[b + 1]) {
                        sum += pixel_integral(psf, theta_i, cuts_t[a], cuts_t[a + 1], cuts_p[b],
                                              cuts_p[b + 1]);
                    }
                }
            }
            taps.push_back(sum);
        }
    }
    return taps;
}

/// sum_j L_j * integral for one output pixel and channel.
inline double brute_sum(const Image& map, const std::vector<double>& taps, int column,
                        int channel) {
    double sum = 0;
    const int half = map.width / 2 + 1;
    for (int j = 0; j < map.height; ++j) {
        for (int x = 0; x < map.width; ++x) {
            int k = std::abs(x - column);
            k = std::min(k, map.width - k);
            sum += taps[static_cast<std::size_t>(j) * half + k] * map.at(j, x, channel);
        }
    }
    return sum;
}

}  // namespace airlight::test
