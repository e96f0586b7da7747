// SPDX-License-Identifier: Apache-2.0
// The Fourier coefficients of all rings of a lat-long map, stored order by order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "sh/aligned.h"
#include "sh/ring_fft.h"

namespace airlight {

/// Fourier coefficients F_m(row) of every ring and channel for m = 0 … orders-1, laid out as
/// (orders, channels, {re, im}, rows): what one azimuthal order needs is contiguous. Rows run from
/// the north pole to the south pole.
class RowSpectra {
  public:
    RowSpectra(std::size_t rows, std::size_t orders, std::size_t channels)
        : rows_(rows), orders_(orders), channels_(channels), data_(rows * orders * channels * 2) {}

    std::size_t rows() const { return rows_; }
    std::size_t orders() const { return orders_; }
    std::size_t channels() const { return channels_; }
    std::size_t components() const { return 2 * channels_; }

    /// The rows of component c (2 * channel for the real part, + 1 for the imaginary) of order m.
    double* at(std::size_t m, std::size_t component) {
        return data_.data() + (m * components() + component) * rows_;
    }
    const double* at(std::size_t m, std::size_t component) const {
        return data_.data() + (m * components() + component) * rows_;
    }

    /// Transforms every ring: load(row, channel, double* ring) provides its values.
    template <class Load>
    void forward(const RingFft& fft, const Load& load);
    /// Recovers every ring without the factor 1/n: store(row, channel, const double* ring) takes
    /// it. Orders from `orders()` on count as zero.
    template <class Store>
    void inverse(const RingFft& fft, const Store& store) const;

  private:
    // Rows written at a time: a multiple of a cache line of the order-major layout.
    static constexpr std::size_t kRowBlock = 16;
    // Keeps the rows of a block, 2^n apart otherwise, out of one another's cache sets.
    static constexpr std::size_t kStagger = 4;

    std::size_t rows_, orders_, channels_;
    AlignedVector<double> data_;
};

/// The colatitudes of the northern pixel-centre rows, nearest the equator first: the order of folded
/// rows, and what LegendreStage is built from.
std::vector<double> northern_colatitudes(std::size_t rows);

/// Folds rows about the equator for LegendreStage: even = north + south, odd = north - south, each
/// times weight[row], nearest the equator first; the row on the equator of an odd count goes into
/// even alone. `padded` entries are written, zeros past the last row.
void fold_rows(const double* values, const double* weight, std::size_t rows, std::size_t padded,
               double* even, double* odd);

/// The inverse of folding without weights: north = even + odd, south = even - odd.
void unfold_rows(const double* even, const double* odd, std::size_t rows, double* values);

template <class Load>
void RowSpectra::forward(const RingFft& fft, const Load& load) {
    const std::size_t length = fft.length(), bins = fft.bins(), used = std::min(orders_, bins);
    const std::size_t stride = bins + kStagger;
    parallel_blocks(rows_, kRowBlock, [&](std::size_t begin, std::size_t end) {
        std::vector<double> ring(length);
        std::vector<RingFft::Complex> spectra(kRowBlock * stride);
        RingFft::Workspace work;
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            for (std::size_t row = begin; row < end; ++row) {
                load(row, channel, ring.data());
                fft.forward(ring.data(), spectra.data() + (row - begin) * stride, work);
            }
            // Orders past the ring's last bin do not occur.
            for (std::size_t m = used; m < orders_; ++m) {
                std::fill(at(m, 2 * channel) + begin, at(m, 2 * channel) + end, 0.0);
                std::fill(at(m, 2 * channel + 1) + begin, at(m, 2 * channel + 1) + end, 0.0);
            }
            for (std::size_t m = 0; m < used; ++m) {
                double* re = at(m, 2 * channel);
                double* im = at(m, 2 * channel + 1);
                for (std::size_t row = begin; row < end; ++row) {
                    const RingFft::Complex value = spectra[(row - begin) * stride + m];
                    re[row] = value.real();
                    im[row] = value.imag();
                }
            }
        }
    });
}

template <class Store>
void RowSpectra::inverse(const RingFft& fft, const Store& store) const {
    const std::size_t length = fft.length(), bins = fft.bins(), used = std::min(orders_, bins);
    const std::size_t stride = bins + kStagger;
    parallel_blocks(rows_, kRowBlock, [&](std::size_t begin, std::size_t end) {
        std::vector<double> ring(length);
        std::vector<RingFft::Complex> spectra(kRowBlock * stride);
        RingFft::Workspace work;
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            for (std::size_t m = 0; m < used; ++m) {
                const double* re = at(m, 2 * channel);
                const double* im = at(m, 2 * channel + 1);
                // The mean and the Nyquist bin of a real ring are real.
                const bool real = m == 0 || 2 * m == length;
                for (std::size_t row = begin; row < end; ++row) {
                    spectra[(row - begin) * stride + m] = {re[row], real ? 0.0 : im[row]};
                }
            }
            for (std::size_t row = begin; row < end; ++row) {
                fft.inverse(spectra.data() + (row - begin) * stride, ring.data(), work);
                store(row, channel, ring.data());
            }
        }
    });
}

}  // namespace airlight
