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

/// Fourier coefficients F_m(row) of every ring and channel for m = 0 … orders-1. Rows run from the
/// north pole to the south pole. T is float or double.
///
/// Laid out as (channels, blocks of kRowBlock rows, orders, {re, im}, kRowBlock): a block of rings
/// is transformed in one stream, and what a few orders need comes in pieces of a few cache lines.
template <class T>
class RowSpectra {
  public:
    static constexpr std::size_t kRowBlock = LaneFft<T>::kStride;

    RowSpectra(std::size_t rows, std::size_t orders, std::size_t channels)
        : rows_(rows),
          blocks_((rows + kRowBlock - 1) / kRowBlock),
          orders_(orders),
          channels_(channels),
          data_(blocks_ * orders * channels * 2 * kRowBlock) {}

    std::size_t rows() const { return rows_; }
    /// Rows with the padding that fills the last block, whose values mean nothing.
    std::size_t padded_rows() const { return blocks_ * kRowBlock; }
    std::size_t orders() const { return orders_; }
    std::size_t channels() const { return channels_; }
    std::size_t components() const { return 2 * channels_; }

    /// The rows of one block: {re, im} of order m, kRowBlock values each, and order m+1 behind.
    T* at(std::size_t m, std::size_t channel, std::size_t block) {
        return data_.data() + ((channel * blocks_ + block) * orders_ + m) * 2 * kRowBlock;
    }
    const T* at(std::size_t m, std::size_t channel, std::size_t block) const {
        return data_.data() + ((channel * blocks_ + block) * orders_ + m) * 2 * kRowBlock;
    }

    /// Copies `count` orders from m on to or from `rows`, (count, components, padded_rows()) with
    /// the component 2 * channel for real parts and + 1 for imaginary ones.
    void read(std::size_t m, std::size_t count, T* rows) const;
    void write(std::size_t m, std::size_t count, const T* rows);

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
    // Columns gathered from all rows of a block before the next ones: the first-level cache holds
    // their elements.
    static constexpr std::size_t kColumns = 64;

    static constexpr std::size_t kLanes = LaneFft<T>::kLanes;
    // Blocks of one task, which share their buffers.
    static constexpr std::size_t kTaskBlocks = 4;
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

    // Calls body(buffers, block, rows of it) for all blocks of rows.
    template <class Body>
    void for_each_block(const LaneFft<T>& fft, const Body& body) const {
        parallel_blocks(blocks_, kTaskBlocks, [&](std::size_t begin, std::size_t end) {
            Buffers buffers(fft.buffer_size(), channels_);
            for (std::size_t block = begin; block < end; ++block) {
                body(buffers, block, std::min(kRowBlock, rows_ - block * kRowBlock));
            }
        });
    }

    // The place of element `row` of the rows that read() and write() copy.
    std::size_t place(std::size_t order, std::size_t component, std::size_t block) const {
        return ((order * components() + component) * blocks_ + block) * kRowBlock;
    }

    std::size_t rows_, blocks_, orders_, channels_;
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
void RowSpectra<T>::read(std::size_t m, std::size_t count, T* rows) const {
    for (std::size_t channel = 0; channel < channels_; ++channel) {
        for (std::size_t block = 0; block < blocks_; ++block) {
            const T* from = at(m, channel, block);
            for (std::size_t i = 0; i < 2 * count; ++i, from += kRowBlock) {
                std::copy_n(from, kRowBlock, rows + place(i / 2, 2 * channel + i % 2, block));
            }
        }
    }
}

template <class T>
void RowSpectra<T>::write(std::size_t m, std::size_t count, const T* rows) {
    for (std::size_t channel = 0; channel < channels_; ++channel) {
        for (std::size_t block = 0; block < blocks_; ++block) {
            T* to = at(m, channel, block);
            for (std::size_t i = 0; i < 2 * count; ++i, to += kRowBlock) {
                std::copy_n(rows + place(i / 2, 2 * channel + i % 2, block), kRowBlock, to);
            }
        }
    }
}

template <class T>
template <class RowOf>
void RowSpectra<T>::forward(const LaneFft<T>& fft, std::size_t stride, const RowOf& row_of,
                            const Tick& tick) {
    const std::size_t n = fft.length(), used = std::min(orders_, n / 2 + 1);
    for_each_block(fft, [&](Buffers& buffers, std::size_t block, std::size_t count) {
        if (count < kRowBlock) buffers.clear();
        for (std::size_t first = 0; first < n; first += kColumns) {
            const std::size_t last = std::min(n, first + kColumns);
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t channel = 0; channel < channels_; ++channel) {
                    const auto* row = row_of(block * kRowBlock + r, channel);
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
                // Two real rings a and b are one of a + i b with the transform Z:
                // A_m = (Z_m + conj Z_-m) / 2, B_m = (Z_m - conj Z_-m) / 2i.
                const T* z = spectrum + m * kRowBlock;
                const T* y = spectrum + (n - m) % n * kRowBlock;
                T rings[2 * kRowBlock];
                T* re = rings;
                T* im = rings + kRowBlock;
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    re[lane] = (z[lane] + y[lane]) / 2;
                    im[lane] = (z[kLanes + lane] - y[kLanes + lane]) / 2;
                    re[kLanes + lane] = (z[kLanes + lane] + y[kLanes + lane]) / 2;
                    im[kLanes + lane] = (y[lane] - z[lane]) / 2;
                }
                std::copy_n(rings, 2 * kRowBlock, at(m, channel, block));
            }
            // Orders past the ring's last bin do not occur.
            for (std::size_t m = used; m < orders_; ++m) {
                std::fill_n(at(m, channel, block), 2 * kRowBlock, T(0));
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
    for_each_block(fft, [&](Buffers& buffers, std::size_t block, std::size_t count) {
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            T* data = buffers.data(channel);
            for (std::size_t m = 0; m < used; ++m) {
                // The last block's padding is nothing that its neighbours should meet.
                const T* rows = at(m, channel, block);
                T re[kRowBlock] = {}, im[kRowBlock] = {};
                const bool real = m == 0 || 2 * m == n;
                if (count == kRowBlock) {
                    std::copy_n(rows, kRowBlock, re);
                    if (!real) std::copy_n(rows + kRowBlock, kRowBlock, im);
                } else {
                    std::copy_n(rows, count, re);
                    if (!real) std::copy_n(rows + kRowBlock, count, im);
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
            const T* rings = fft.transform(data, true, buffers.data(channels_));
            if (rings != data) buffers.exchange(channel, channels_);
        }
        for (std::size_t first = 0; first < n; first += kColumns) {
            const std::size_t last = std::min(n, first + kColumns);
            for (std::size_t r = 0; r < count; ++r) {
                for (std::size_t channel = 0; channel < channels_; ++channel) {
                    auto* row = row_of(block * kRowBlock + r, channel);
                    const T* from = buffers.data(channel) + r;
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
