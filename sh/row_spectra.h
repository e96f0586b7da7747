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
        : rows_(rows),
          row_stride_((rows / kLanes + 1) * kLanes | kLanes),
          orders_(orders),
          channels_(channels),
          data_(row_stride_ * orders * channels * 2) {}

    std::size_t rows() const { return rows_; }
    std::size_t orders() const { return orders_; }
    std::size_t channels() const { return channels_; }
    std::size_t components() const { return 2 * channels_; }

    /// The rows of component c (2 * channel for the real part, + 1 for the imaginary) of order m.
    T* at(std::size_t m, std::size_t component) {
        return data_.data() + (m * components() + component) * row_stride_;
    }
    const T* at(std::size_t m, std::size_t component) const {
        return data_.data() + (m * components() + component) * row_stride_;
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

    // Blocks of one task, which share their buffers.
    static constexpr std::size_t kTaskBlocks = 4;
    // Orders lie pages apart; that many are fetched ahead.
    static constexpr std::size_t kAhead = 8;

    // The elements of one block of rows in every channel, and one more to transform into.
    class Buffers {
      public:
        Buffers(std::size_t size, std::size_t channels) {
            for (std::size_t i = 0; i <= channels; ++i) buffers_.emplace_back(size);
        }
        T* data(std::size_t i) { return buffers_[i].data(); }
        void exchange(std::size_t i, std::size_t j) { buffers_[i].swap(buffers_[j]); }
        void clear() {
            for (AlignedVector<T>& buffer : buffers_) std::fill(buffer.begin(), buffer.end(), T(0));
        }

      private:
        std::vector<AlignedVector<T>> buffers_;
    };

    // Calls body(buffers, begin, count) for all blocks of rows.
    template <class Body>
    void for_each_block(const LaneFft<T>& fft, const Body& body) const {
        parallel_blocks(rows_, kTaskBlocks * kRowBlock, [&](std::size_t begin, std::size_t end) {
            Buffers buffers(fft.buffer_size(), channels_);
            for (; begin < end; begin += kRowBlock) {
                body(buffers, begin, std::min(kRowBlock, end - begin));
            }
        });
    }

    void prefetch(std::size_t m, std::size_t channel, std::size_t row) const {
        if (m >= orders_) return;
        for (std::size_t part = 0; part < 2; ++part) {
            const T* rows = at(m, 2 * channel + part) + row;
            __builtin_prefetch(rows);
            __builtin_prefetch(rows + kLanes);
        }
    }

    // All rows of a block but the last one are copied without a loop.
    static void copy_rows(const T* from, std::size_t count, T* to) {
        if (count == kRowBlock) {
            std::copy_n(from, kRowBlock, to);
        } else {
            std::copy_n(from, count, to);
        }
    }

    // An odd number of cache lines keeps the rows of neighbouring orders, which lie 2^n apart in a
    // usual map, out of one another's cache sets.
    std::size_t rows_, row_stride_, orders_, channels_;
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
    for_each_block(fft, [&](Buffers& buffers, std::size_t begin, std::size_t count) {
        if (count < kRowBlock) buffers.clear();
        for (std::size_t first = 0; first < n; first += kColumns) {
            const std::size_t last = std::min(n, first + kColumns);
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t channel = 0; channel < channels_; ++channel) {
                    const auto* row = row_of(begin + r, channel);
                    T* to = buffers.data(channel) + r;
                    for (std::size_t k = first; k < last; ++k) {
                        to[k * kRowBlock] = static_cast<T>(row[k * stride]);
                    }
                }
            }
        }
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            const T* spectrum =
                fft.transform(buffers.data(channel), false, buffers.data(channels_));
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
                copy_rows(re, count, at(m, 2 * channel) + begin);
                copy_rows(im, count, at(m, 2 * channel + 1) + begin);
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
    for_each_block(fft, [&](Buffers& buffers, std::size_t begin, std::size_t count) {
        std::vector<const T*> rings(channels_);
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            T* data = buffers.data(channel);
            T re[kRowBlock] = {}, im[kRowBlock] = {};
            for (std::size_t m = 0; m < used; ++m) {
                prefetch(m + kAhead, channel, begin);
                copy_rows(at(m, 2 * channel) + begin, count, re);
                const bool real = m == 0 || 2 * m == n;
                if (real) {
                    std::fill_n(im, kRowBlock, T(0));
                } else {
                    copy_rows(at(m, 2 * channel + 1) + begin, count, im);
                }
                // Z_m = A_m + i B_m and Z_-m = conj A_m + i conj B_m.
                T z[kRowBlock], y[kRowBlock];
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    y[lane] = re[lane] + im[kLanes + lane];
                    y[kLanes + lane] = re[kLanes + lane] - im[lane];
                    z[lane] = re[lane] - im[kLanes + lane];
                    z[kLanes + lane] = re[kLanes + lane] + im[lane];
                }
                std::copy_n(y, kRowBlock, data + (n - m) % n * kRowBlock);
                std::copy_n(z, kRowBlock, data + m * kRowBlock);
            }
            for (std::size_t m = used; m + used <= n; ++m) {
                std::fill_n(data + m * kRowBlock, kRowBlock, T(0));
            }
            rings[channel] = fft.transform(data, true, buffers.data(channels_));
            if (rings[channel] != data) buffers.exchange(channel, channels_);
        }
        for (std::size_t first = 0; first < n; first += kColumns) {
            const std::size_t last = std::min(n, first + kColumns);
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t channel = 0; channel < channels_; ++channel) {
                    auto* row = row_of(begin + r, channel);
                    const T* from = rings[channel] + r;
                    for (std::size_t k = first; k < last; ++k) {
                        row[k * stride] = static_cast<std::remove_reference_t<decltype(*row)>>(
                            from[k * kRowBlock]);
                    }
                }
            }
        }
        if (tick) tick(count);
    });
}

}  // namespace airlight
