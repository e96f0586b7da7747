// SPDX-License-Identifier: Apache-2.0
#include "envmap/band_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "sh/legendre_stage.h"
#include "sh/row_spectra.h"

namespace airlight {
namespace {

double sinc(double x) {
    return std::fabs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
}

// Chebyshev coefficients in cos x of the polynomial that meets sinc(x / 2), the average's response
// to exp(i x), at Chebyshev nodes of cos x in [cos(end), 1].
std::vector<double> fit_response(double end, int taps) {
    const int nodes = taps + 1;
    const double low = std::cos(end), half = 0.5 * (1 - low);
    std::vector<double> series(nodes, 0.0);  // in z, c = low + half (1 + z)
    for (int i = 0; i < nodes; ++i) {
        const double angle = kPi * (i + 0.5) / nodes;
        const double x = std::acos(low + half * (1 + std::cos(angle)));
        for (int k = 0; k < nodes; ++k) {
            series[k] += (k == 0 ? 1.0 : 2.0) / nodes * sinc(0.5 * x) * std::cos(k * angle);
        }
    }
    // The same polynomial from its values at the Chebyshev nodes of the whole interval of c.
    std::vector<double> response(nodes, 0.0);
    for (int i = 0; i < nodes; ++i) {
        const double angle = kPi * (i + 0.5) / nodes;
        const double z = (std::cos(angle) - low) / half - 1;
        double before = 0, current = 0;  // Clenshaw
        for (int k = nodes - 1; k >= 1; --k) {
            const double next = 2 * z * current - before + series[k];
            before = current;
            current = next;
        }
        const double value = z * current - before + series[0];
        for (int k = 0; k < nodes; ++k) {
            response[k] += (k == 0 ? 1.0 : 2.0) / nodes * value * std::cos(k * angle);
        }
    }
    return response;
}

double worst_response_error(const std::vector<double>& response, double end) {
    double worst = 0;
    for (int i = 0; i <= 200; ++i) {
        const double x = end * i / 200;
        double sum = 0;
        for (std::size_t k = 0; k < response.size(); ++k) sum += response[k] * std::cos(k * x);
        worst = std::max(worst, std::fabs(sum - sinc(0.5 * x)));
    }
    return worst;
}

// Applies the filter along the meridian. Past a pole the function goes on with the sign `beyond`.
void average_rows(const std::vector<double>& taps, double beyond, std::size_t rows,
                  const double* in, std::vector<double>& extended, double* out) {
    const std::size_t reach = taps.size() - 1;
    extended.resize(rows + 2 * reach);
    std::copy(in, in + rows, extended.begin() + reach);
    for (std::size_t k = 1; k <= reach; ++k) {
        // Around the meridian circle: 2 rows samples, the second half mirrored.
        const std::size_t north = (2 * rows - k % (2 * rows)) % (2 * rows);
        const std::size_t south = (rows - 1 + k) % (2 * rows);
        const auto value = [&](std::size_t j) {
            return j < rows ? in[j] : beyond * in[2 * rows - 1 - j];
        };
        extended[reach - k] = value(north);
        extended[reach + rows - 1 + k] = value(south);
    }
    for (std::size_t j = 0; j < rows; ++j) {
        const double* centre = extended.data() + reach + j;
        double sum = taps[0] * centre[0];
        for (std::size_t k = 1; k <= reach; ++k) sum += taps[k] * (*(centre - k) + centre[k]);
        out[j] = sum;
    }
}

}  // namespace

std::vector<double> row_average_filter(int rows, int degree) {
    // A wider band than needed keeps the taps small.
    const double end = std::max(0.5 * kPi, kPi * degree / rows);
    for (int taps = 6;; ++taps) {
        std::vector<double> response = fit_response(end, taps);
        if (worst_response_error(response, end) < 1e-11 || taps == 60) {
            for (std::size_t k = 1; k < response.size(); ++k) response[k] *= 0.5;
            return response;
        }
    }
}

void write_band_filter(const Image& map, const std::vector<BandKernel>& kernels, Image& out,
                       Progress* progress) {
    const std::size_t rows = map.height, columns = map.width, channels = kernels.size();
    const int lmax = static_cast<int>(kernels.front().eigenvalues->size()) - 1;
    assert(lmax < map.height && 2 * lmax < map.width);
    const LaneFft<double> fft(columns);
    RowSpectra<double> spectra(rows, static_cast<std::size_t>(lmax) + 1, channels);
    const auto tick = [&](std::size_t count) {
        if (progress) progress->tick(count);
    };
    spectra.forward(
        fft, map.channels,
        [&](std::size_t row, std::size_t channel) {
            return map.row(static_cast<int>(row)) + kernels[channel].channel;
        },
        tick);

    std::vector<double> weight(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        weight[row] = std::sin(kPi * (std::min(row, rows - 1 - row) + 0.5) / rows);
    }
    const LegendreStage<double> legendre(northern_colatitudes(rows), lmax);
    const std::vector<double> taps = row_average_filter(map.height, lmax + 2);
    const std::size_t padded = legendre.padded_rows(), components = spectra.components();
    parallel_blocks(static_cast<std::size_t>(lmax) + 1, 4, [&](std::size_t m0, std::size_t m1) {
        AlignedVector<double> even(components * padded), odd(components * padded);
        AlignedVector<double> coefficients(components * legendre.padded_bands(0));
        std::vector<double> averaged(rows), extended;
        AlignedVector<double> values(components * spectra.padded_rows());
        LegendreStage<double>::Workspace work;
        for (std::size_t m = m0; m < m1; ++m) {
            // Row height, column width, and the column's average of exp(i m phi); the inverse
            // transform counts orders above 0 twice.
            const double scale = kPi / rows * 2 * kPi / columns *
                                 sinc(kPi * static_cast<double>(m) / columns) * (m == 0 ? 1 : 0.5);
            // P_lm goes on past a pole with (-1)^m, the sine in its weight with -1.
            const double beyond = m % 2 ? 1 : -1;
            spectra.read(m, 1, values.data());
            for (std::size_t c = 0; c < components; ++c) {
                average_rows(taps, beyond, rows, values.data() + c * spectra.padded_rows(),
                             extended, averaged.data());
                fold_rows(averaged.data(), weight.data(), rows, padded, even.data() + c * padded,
                          odd.data() + c * padded);
            }
            legendre.prepare(static_cast<int>(m), work);
            legendre.analyze(components, even.data(), odd.data(), coefficients.data(), work);
            double* value = coefficients.data();
            for (std::size_t l = m; l <= static_cast<std::size_t>(lmax); ++l) {
                for (const BandKernel& kernel : kernels) {
                    const double factor = scale * kernel.amplitude * (*kernel.eigenvalues)[l];
                    *value++ *= factor;
                    *value++ *= factor;
                }
            }
            legendre.synthesize(components, coefficients.data(), even.data(), odd.data(), work);
            for (std::size_t c = 0; c < components; ++c) {
                unfold_rows(even.data() + c * padded, odd.data() + c * padded, rows,
                            values.data() + c * spectra.padded_rows());
            }
            spectra.write(m, 1, values.data());
        }
        if (progress) progress->tick(m1 - m0);
    });

    spectra.inverse(
        fft, out.channels,
        [&](std::size_t row, std::size_t channel) {
            return out.row(static_cast<int>(row)) + kernels[channel].channel;
        },
        tick);
}

double band_filter_cost(int rows, int columns, int channels, int lmax) {
    const double transforms = 2.0 * 8 * rows * columns * channels;
    const double legendre = 0.5 * lmax * lmax * rows * (0.25 + 0.12 * channels);
    return transforms + legendre;
}

}  // namespace airlight
