// SPDX-License-Identifier: Apache-2.0
// The Fourier coefficients of all rings of a lat-long map, stored order by order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <vector>

#include "core/parallel.h"
#include "sh/aligned.h"
#include "sh/lane_fft.h"

namespace airlight {

/// Fourier coefficients F_m(row) of every ring and channel for m = 0 … orders-1, laid out as
/// (orders, channels, {re, im}, rows): what one azimuthal order needs is contiguous. Rows run from
/// the north pole to the south pole. T is float or double.
template <class T>
class RowSpectra {
  public:
    RowSpectra(std::size_t rows, std::size_t orders, std::size_t channels)
        : rows_(rows), orders_(orders), channels_(channels), data_(rows * orders * channels * 2) {}

    std::size_t rows() const { return rows_; }
    std::size_t orders() const { return orders_; }
    std::size_t channels() const { return channels_; }
    std::size_t components() const { return 2 * channels_; }

    /// The rows of component c (2 * channel for the real part, + 1 for the imaginary) of order m.
    T* at(std::size_t m, std::size_t component) {
        return data_.data() + (m * components() + component) * rows_;
    }
    const T* at(std::size_t m, std::size_t component) const {
        return data_.data() + (m * components() + component) * rows_;
    }

    /// Called with a number of rows whenever so many of all channels are done; may be empty.
    using Tick = std::function<void(std::size_t rows)>;

    /// Transforms every ring, F_m = sum_k a_k exp(-2 pi i m k / n): pixel k of a row lies at
    /// row_of(row, channel)[k * stride].
    template <class RowOf>
    void forward(const LaneFft<T>& fft, std::size_t stride, const RowOf& row_of,
                 const Tick& tick = {});
    /// Writes every ring a_k = F_0 + sum_m 2 Re(F_m exp(2 pi i m k / n)), the Nyquist term once,
    /// which is n times the inverse. Imaginary parts of the mean and the Nyquist term are ignored,
    /// and orders from `orders()` on count as zero.
    template <class RowOf>
    void inverse(const LaneFft<T>& fft, std::size_t stride, const RowOf& row_of,
                 const Tick& tick = {}) const;

  private:
    // Two real rings share a complex transform: one is its real part, one its imaginary part, as
    // the places of LaneFft's elements follow each other.
    static constexpr std::size_t kRowBlock = LaneFft<T>::kStride;
    static constexpr std::size_t kLanes = LaneFft<T>::kLanes;
    // Columns gathered from all rows of a block before the next ones: the first-level cache holds
    // their elements.
    static constexpr std::size_t kColumns = 64;

    std::size_t rows_, orders_, channels_;
    AlignedVector<T> data_;
};

/// The colatitudes of the northern pixel-centre rows, nearest the equator first: the order of
/// folded rows, and what LegendreStage is built from.
std::vector<double> northern_colatitudes(std::size_t rows);

/// Folds rows about the equator for LegendreStage: even = north + south, odd = north - south, each
/// times weight[row], nearest the equator first; the row on the equator of an odd count goes into
/// even alone. `padded` entries are written, zeros past the last row.
template <class T>
void fold_rows(const T* values, const T* weight, std::size_t rows, std::size_t padded, T* even,
               T* odd);

/// The inverse of folding without weights: north = even + odd, south = even - odd.
template <class T>
void unfold_rows(const T* even, const T* odd, std::size_t rows, T* values);

template <class T>
template <class RowOf>
void RowSpectra<T>::forward(const LaneFft<T>& fft, std::size_t stride, const RowOf& row_of,
                            const Tick& tick) {
    const std::size_t n = fft.length(), used = std::min(orders_, n / 2 + 1);
    parallel_blocks(rows_, kRowBlock, [&](std::size_t begin, std::size_t end) {
        AlignedVector<T> data(fft.buffer_size()), scratch(fft.buffer_size());
        const std::size_t count = end - begin;
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            if (count < kRowBlock) std::fill(data.begin(), data.end(), T(0));
            for (std::size_t first = 0; first < n; first += kColumns) {
                const std::size_t last = std::min(n, first + kColumns);
                for (std::size_t r = 0; r < count; ++r) {
                    const auto* row = row_of(begin + r, channel);
                    T* to = data.data() + r;
                    for (std::size_t k = first; k < last; ++k) {
                        to[k * kRowBlock] = static_cast<T>(row[k * stride]);
                    }
                }
            }
            const T* spectrum = fft.transform(data.data(), false, scratch.data());
            for (std::size_t m = 0; m < used; ++m) {
                // With Z of a + i b: A_m = (Z_m + conj Z_-m) / 2, B_m = (Z_m - conj Z_-m) / 2i.
                const T* z = spectrum + m * kRowBlock;
                const T* y = spectrum + (n - m) % n * kRowBlock;
                T re[kRowBlock], im[kRowBlock];
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    re[lane] = (z[lane] + y[lane]) / 2;
                    im[lane] = (z[kLanes + lane] - y[kLanes + lane]) / 2;
                    re[kLanes + lane] = (z[kLanes + lane] + y[kLanes + lane]) / 2;
                    im[kLanes + lane] = (y[lane] - z[lane]) / 2;
                }
                std::copy_n(re, count, at(m, 2 * channel) + begin);
                std::copy_n(im, count, at(m, 2 * channel + 1) + begin);
            }
            // Orders past the ring's last bin do not occur.
            for (std::size_t m = used; m < orders_; ++m) {
                std::fill_n(at(m, 2 * channel) + begin, count, T(0));
                std::fill_n(at(m, 2 * channel + 1) + begin, count, T(0));
            }
        }
        if (tick) tick(count);
    });
}

template <class T>
template <class RowOf>
void RowSpectra<T>::inverse(const LaneFft<T>& fft, std::size_t stride, const RowOf& row_of,
                            const Tick& tick) const {
    const std::size_t n = fft.length(), used = std::min(orders_, n / 2 + 1);
    parallel_blocks(rows_, kRowBlock, [&](std::size_t begin, std::size_t end) {
        AlignedVector<T> data(fft.buffer_size()), scratch(fft.buffer_size());
        const std::size_t count = end - begin;
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            for (std::size_t m = used; m + used <= n; ++m) {
                std::fill_n(data.data() + m * kRowBlock, kRowBlock, T(0));
            }
            T re[kRowBlock] = {}, im[kRowBlock] = {};
            for (std::size_t m = 0; m < used; ++m) {
                std::copy_n(at(m, 2 * channel) + begin, count, re);
                const bool real = m == 0 || 2 * m == n;
                if (!real) std::copy_n(at(m, 2 * channel + 1) + begin, count, im);
                // Z_m = A_m + i B_m and Z_-m = conj A_m + i conj B_m.
                T* z = data.data() + m * kRowBlock;
                T* y = data.data() + (n - m) % n * kRowBlock;
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    const T b_im = real ? T(0) : im[kLanes + lane], a_im = real ? T(0) : im[lane];
                    y[lane] = re[lane] + b_im;
                    y[kLanes + lane] = re[kLanes + lane] - a_im;
                    z[lane] = re[lane] - b_im;
                    z[kLanes + lane] = re[kLanes + lane] + a_im;
                }
            }
            const T* rings = fft.transform(data.data(), true, scratch.data());
            for (std::size_t first = 0; first < n; first += kColumns) {
                const std::size_t last = std::min(n, first + kColumns);
                for (std::size_t r = 0; r < count; ++r) {
                    auto* row = row_of(begin + r, channel);
                    for (std::size_t k = first; k < last; ++k) {
                        row[k * stride] = static_cast<std::remove_reference_t<decltype(*row)>>(
                            rings[k * kRowBlock + r]);
                    }
                }
            }
        }
        if (tick) tick(count);
    });
}

}  // namespace airlight
