// SPDX-License-Identifier: Apache-2.0
#include "envmap/ring_filter.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "envmap/pixel_integral.h"
#include "envmap/tap_sum.h"
#include "sh/aligned.h"
#include "sh/ring_fft.h"

namespace airlight {
namespace {

using Complex = RingFft::Complex;
constexpr std::size_t kRowBlock = 32;

// Nanoseconds of one thread on an AVX2 machine; only their ratios matter.
constexpr double kTapCost = 0.027;    // one tap, one value
constexpr double kTapIntegral = 50;   // one pixel integral
constexpr double kRingTransform = 5;  // one column of a kernel's transform
constexpr double kRingProduct = 0.8;  // one column of one channel's product

struct RowCost {
    double direct = 0, ring = 0;
    bool fits = true;  // no tap reaches round the ring
};

// Cost of output row `row` and its mirror image by either way.
RowCost row_cost(const KernelReach& reach, double channels, double radius, int row) {
    const int columns = reach.column_count();
    RowCost cost;
    const RowRange reached = reach.rows(radius, row);
    for (int j = reached.first; j <= reached.last; ++j) {
        const double count = static_cast<double>(reach.columns(radius, row, j));
        if (2 * count - 1 > columns) cost.fits = false;
        const double integrals = kTapIntegral * count;
        cost.direct += integrals + 2 * kTapCost * channels * columns * (2 * count - 1);
        cost.ring += integrals + columns * (kRingTransform + 2 * kRingProduct * channels);
    }
    cost.ring += 4.0 * kRingTransform * columns * channels;
    return cost;
}

// The number of rows from each pole that go through Fourier coefficients: the rest is cheaper
// directly, and its taps do not wrap.
int ring_rows(const KernelReach& reach, int channels, double radius) {
    const int north = (reach.row_count() + 1) / 2;
    if (radius >= 2) return north;
    int row = north;
    while (row > 0) {
        const RowCost cost = row_cost(reach, channels, radius, row - 1);
        if (!cost.fits || cost.direct > cost.ring) break;
        --row;
    }
    return row;
}

// Input rows of the channels at hand, each channel a ring wrapped round on both sides.
class WrappedRows {
  public:
    // Values are divided by `scale`.
    WrappedRows(const Image& map, const std::vector<int>& channels, int first, int last,
                std::size_t pad, float scale)
        : first_(first),
          channels_(channels.size()),
          pad_(pad),
          stride_(map.width + 2 * pad + kTapSlack),
          values_(stride_ * channels_ * (last - first + 1)) {
        const int width = map.width;
        const float inverse = 1 / scale;
        for (int row = first; row <= last; ++row) {
            const float* in = map.row(row);
            for (std::size_t c = 0; c < channels_; ++c) {
                float* ring = values_.data() + stride_ * ((row - first) * channels_ + c);
                for (int x = 0; x < width; ++x) {
                    ring[pad + x] = in[x * map.channels + channels[c]] * inverse;
                }
                for (std::size_t k = 0; k < pad; ++k) {
                    ring[pad - 1 - k] = ring[pad + width - 1 - k];
                    ring[pad + width + k] = ring[pad + k];
                }
            }
        }
    }

    const float* ring(int row, std::size_t channel) const {
        return values_.data() + stride_ * ((row - first_) * channels_ + channel) + pad_;
    }

  private:
    int first_;
    std::size_t channels_, pad_, stride_;
    std::vector<float> values_;
};

void add_row(Image& out, const RingKernel& kernel, int row, std::size_t channel,
             const float* values, double scale) {
    float* pixel = out.row(row) + kernel.channels[channel];
    const double amplitude = scale * kernel.amplitude[channel];
    for (int x = 0; x < out.width; ++x, pixel += out.channels) {
        *pixel = static_cast<float>(*pixel + amplitude * values[x]);
    }
}

// The taps of two output rows, for every input row that either reaches.
class TapPair {
  public:
    // Rows `row` and `row` + 1; `single` leaves the second one's taps 0.
    void compute(const RingKernel& kernel, const PixelIntegrator& pixels, int row, bool single) {
        const double radius = kernel.remainder->radius();
        const KernelReach& reach = pixels.reach();
        const int last = single ? row : row + 1;
        first_ = reach.rows(radius, row).first;
        const int rows = reach.rows(radius, last).last - first_ + 1;
        begin_.assign(1, 0);
        for (int j = first_; j < first_ + rows; ++j) {
            begin_.push_back(begin_.back() + std::max(reach.columns(radius, row, j),
                                                      reach.columns(radius, last, j)));
        }
        taps_.assign(2 * begin_.back(), 0.0f);
        for (int side = 0; side <= last - row; ++side) {
            pixels.integrate_row(*kernel.remainder, row + side,
                                 [&](int j, std::size_t count, const double* values) {
                                     float* taps = taps_.data() + 2 * begin_[j - first_] + side;
                                     for (std::size_t k = 0; k < count; ++k) {
                                         taps[2 * k] = static_cast<float>(values[k]);
                                     }
                                 });
        }
    }

    // Calls visit(j, taps, count) for the input rows.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t n = 0; n + 1 < begin_.size(); ++n) {
            const std::size_t count = begin_[n + 1] - begin_[n];
            if (count > 0) visit(first_ + static_cast<int>(n), taps_.data() + 2 * begin_[n], count);
        }
    }

  private:
    int first_ = 0;
    std::vector<std::size_t> begin_;
    std::vector<float> taps_;
};

bool holds_huge_values(const Image& map) {
    return ordered_reduce<int>(
               map.pixels.size(), std::size_t{1} << 16, 0,
               [&](std::size_t begin, std::size_t end) {
                   int huge = 0;
                   for (std::size_t i = begin; i < end; ++i) {
                       huge |= std::fabs(map.pixels[i]) > 1e36f;
                   }
                   return huge;
               },
               [](int& any, int part) { any |= part; }) != 0;
}

// Rows [begin, end) of the northern hemisphere and their mirror images, by direct sums.
void add_direct_rows(const Image& map, const RingKernel& kernel, const PixelIntegrator& pixels,
                     int begin, int end, float scale, Image& out) {
    const int rows = map.height;
    const double radius = kernel.remainder->radius();
    const KernelReach& reach = pixels.reach();
    const RowRange range = {reach.rows(radius, begin).first, reach.rows(radius, end - 1).last};
    std::size_t pad = 0;
    for (int row = begin; row < end; ++row) {
        for (int j = range.first; j <= range.last; ++j) {
            pad = std::max(pad, reach.columns(radius, row, j));
        }
    }
    const WrappedRows north(map, kernel.channels, range.first, range.last, pad, scale);
    const WrappedRows south(map, kernel.channels, rows - 1 - range.last, rows - 1 - range.first,
                            pad, scale);
    TapPair taps;
    std::vector<TapRow> tap_rows;
    std::vector<float> sums[2];
    for (std::vector<float>& sum : sums) sum.resize(map.width + kTapSlack);
    for (int row = begin; row < end; row += 2) {
        const int count = std::min(2, end - row);
        taps.compute(kernel, pixels, row, count == 1);
        for (std::size_t c = 0; c < kernel.channels.size(); ++c) {
            for (const bool mirrored : {false, true}) {
                tap_rows.clear();
                taps.for_each([&](int j, const float* values, std::size_t columns) {
                    tap_rows.push_back({mirrored ? south.ring(rows - 1 - j, c) : north.ring(j, c),
                                        values, columns});
                });
                sum_taps(tap_rows.data(), tap_rows.size(), map.width, sums[0].data(),
                         sums[1].data());
                for (int side = 0; side < count; ++side) {
                    const int mirror = rows - 1 - row - side;
                    if (mirrored && mirror == row + side) continue;
                    add_row(out, kernel, mirrored ? mirror : row + side, c, sums[side].data(),
                            scale);
                }
            }
        }
    }
}

// Fourier coefficients of the input rings that a polar cap needs.
class RingSpectra {
  public:
    // Rows [0, depth) and their mirror images.
    RingSpectra(const Image& map, const RingKernel& kernel, const RingFft& fft, int depth)
        : rows_(map.height),
          depth_(std::min(depth, (map.height + 1) / 2)),
          channels_(kernel.channels.size()),
          bins_(fft.bins()),
          values_(2 * depth_ * channels_ * bins_) {
        parallel_blocks(depth_, 1, [&](std::size_t begin, std::size_t end) {
            std::vector<double> ring(map.width);
            RingFft::Workspace work;
            for (std::size_t row = begin; row < end; ++row) {
                for (std::size_t south = 0; south < 2; ++south) {
                    const int j = static_cast<int>(south ? rows_ - 1 - row : row);
                    for (std::size_t c = 0; c < channels_; ++c) {
                        const float* in = map.row(j) + kernel.channels[c];
                        for (int x = 0; x < map.width; ++x) ring[x] = in[x * map.channels];
                        fft.forward(ring.data(), at(row, south, c), work);
                    }
                }
            }
        });
    }

    const Complex* ring(int row, std::size_t channel) const {
        const bool south = row >= depth_;
        const std::size_t slot = south ? rows_ - 1 - row : row;
        return values_.data() + ((slot * 2 + south) * channels_ + channel) * bins_;
    }

  private:
    Complex* at(std::size_t slot, std::size_t south, std::size_t channel) {
        return values_.data() + ((slot * 2 + south) * channels_ + channel) * bins_;
    }

    int rows_, depth_;
    std::size_t channels_, bins_;
    std::vector<Complex> values_;
};

// Output row `row` and its mirror image by products of Fourier coefficients.
void add_ring_row(const RingKernel& kernel, const PixelIntegrator& pixels, const RingFft& fft,
                  const RingSpectra& spectra, int row, Image& out) {
    const int rows = out.height, columns = out.width;
    const int mirror = rows - 1 - row, sides = mirror == row ? 1 : 2;
    const std::size_t channels = kernel.channels.size(), bins = fft.bins();
    std::vector<Complex> sums(sides * channels * bins), tap_bins(bins);
    std::vector<double> ring(columns);
    RingFft::Workspace work;
    pixels.integrate_row(*kernel.remainder, row, [&](int j, std::size_t count, const double* taps) {
        if (count == 0) return;
        std::fill(ring.begin(), ring.end(), 0.0);
        for (std::size_t k = 0; k < count; ++k) {
            ring[k] = taps[k];
            ring[(columns - k) % columns] = taps[k];
        }
        fft.forward(ring.data(), tap_bins.data(), work);
        for (int side = 0; side < sides; ++side) {
            for (std::size_t c = 0; c < channels; ++c) {
                const Complex* in = spectra.ring(side == 0 ? j : rows - 1 - j, c);
                Complex* sum = sums.data() + (side * channels + c) * bins;
                // Taps are even in the column: their coefficients are real.
                for (std::size_t m = 0; m < bins; ++m) sum[m] += tap_bins[m].real() * in[m];
            }
        }
    });
    for (int side = 0; side < sides; ++side) {
        for (std::size_t c = 0; c < channels; ++c) {
            fft.inverse(sums.data() + (side * channels + c) * bins, ring.data(), work);
            float* pixel = out.row(side == 0 ? row : mirror) + kernel.channels[c];
            const double scale = kernel.amplitude[c] / columns;
            for (int x = 0; x < columns; ++x, pixel += out.channels) {
                *pixel = static_cast<float>(*pixel + scale * ring[x]);
            }
        }
    }
}

}  // namespace

void add_ring_filter(const Image& map, const std::vector<RingKernel>& kernels, Image& out,
                     Progress* progress) {
    // Float sums of values near the largest float would overflow on the way.
    const float scale = holds_huge_values(map) ? 1024.0f : 1.0f;
    const PixelIntegrator pixels(map.height, map.width);
    const int north = (map.height + 1) / 2;
    for (const RingKernel& kernel : kernels) {
        const double radius = kernel.remainder->radius();
        const int rings =
            ring_rows(pixels.reach(), static_cast<int>(kernel.channels.size()), radius);
        if (rings > 0) {
            const RingFft fft(map.width);
            const RingSpectra spectra(map, kernel, fft,
                                      pixels.reach().rows(radius, rings - 1).last + 1);
            parallel_blocks(rings, 1, [&](std::size_t row, std::size_t) {
                add_ring_row(kernel, pixels, fft, spectra, static_cast<int>(row), out);
                if (progress) progress->tick();
            });
        }
        parallel_blocks(north - rings, kRowBlock, [&](std::size_t begin, std::size_t end) {
            add_direct_rows(map, kernel, pixels, rings + static_cast<int>(begin),
                            rings + static_cast<int>(end), scale, out);
            if (progress) progress->tick(end - begin);
        });
    }
}

double ring_filter_cost(const KernelReach& reach, int channels, int kernels, double radius) {
    const int north = (reach.row_count() + 1) / 2;
    // Rows change slowly: a few dozen stand for all, more densely towards the pole.
    double cost = 0;
    for (int row = 0; row < north;) {
        const int step = std::min(north - row, 1 + row / 8);
        const RowCost one = row_cost(reach, static_cast<double>(channels) / kernels, radius, row);
        cost += step * (one.fits ? std::min(one.direct, one.ring) : one.ring);
        row += step;
    }
    return cost * kernels;
}

}  // namespace airlight
