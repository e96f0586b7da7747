// SPDX-License-Identifier: Apache-2.0
#include "sh/meridian_weight.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "sh/ring_fft.h"

namespace airlight {
namespace {

// The sum over |n| <= 2 rows - 2 of c_n exp(i n t), |sin t| = sum c_n exp(i n t), at t = k pi /
// (2 rows), k < 4 rows. Higher terms cannot reach the degrees that are kept.
std::vector<double> sine_series(std::size_t rows) {
    const RingFft fft(4 * rows);
    std::vector<RingFft::Complex> spectrum(fft.bins());
    for (std::size_t n = 0; n + 2 <= 2 * rows; n += 2) {
        spectrum[n] = -2 / (kPi * (static_cast<double>(n) * static_cast<double>(n) - 1));
    }
    std::vector<double> values(4 * rows);
    RingFft::Workspace work;
    fft.inverse(spectrum.data(), values.data(), work);
    return values;
}

}  // namespace

template <class T>
MeridianWeight<T>::MeridianWeight(std::size_t rows) : rows_(rows), fft_(2 * rows) {
    const std::vector<double> series = sine_series(rows);
    const double n = 2.0 * static_cast<double>(rows);
    // The last factor is the row spacing.
    const double scale = 0.5 * kPi / static_cast<double>(rows);
    for (std::size_t j = 0; j < 2 * rows; ++j) {
        on_.push_back(static_cast<T>(scale * series[2 * j + 1]));
        between_.push_back(static_cast<T>(scale / (n * n) * series[(2 * j + 2) % (4 * rows)]));
    }
    for (std::size_t k = 0; k < rows; ++k) {
        const double angle = kPi * static_cast<double>(k) / n;
        half_.push_back({static_cast<T>(std::cos(angle)), static_cast<T>(std::sin(angle))});
    }
}

// Multiplies the spectrum by exp(+- i pi k / n) for -rows < k < rows; the degree `rows`, which no
// band-limited function has, goes.
template <class T>
void MeridianWeight<T>::shift(T* spectrum, bool back) const {
    constexpr std::size_t kStride = LaneFft<T>::kStride;
    for (std::size_t k = 1; k < rows_; ++k) {
        const std::complex<T> factor = back ? std::conj(half_[k]) : half_[k];
        multiply_element(spectrum + k * kStride, factor);
        multiply_element(spectrum + (2 * rows_ - k) * kStride, std::conj(factor));
    }
    std::fill_n(spectrum + rows_ * kStride, kStride, T(0));
}

template <class T>
void MeridianWeight<T>::apply(RowSpectra<T>& spectra, std::size_t m0, std::size_t channel,
                              const std::vector<std::complex<T>>& turn, Workspace& work) const {
    constexpr std::size_t kStride = LaneFft<T>::kStride, kLanes = LaneFft<T>::kLanes;
    constexpr std::size_t kRows = RowSpectra<T>::kRowBlock;
    const std::size_t n = 2 * rows_, count = std::min(kOrders, spectra.orders() - m0);
    work.a.resize(fft_.buffer_size());
    work.b.resize(fft_.buffer_size());
    if (count < kOrders) std::fill(work.a.begin(), work.a.end(), T(0));
    T* x = work.a.data();
    for (std::size_t first = 0; first < rows_; first += kRows) {
        const std::size_t rows = std::min(kRows, rows_ - first);
        const T* block = spectra.at(m0, channel, first / kRows);
        for (std::size_t lane = 0; 2 * lane < count; ++lane) {
            const bool both = 2 * lane + 1 < count;
            for (std::size_t part = 0; part < 2; ++part) {
                const T* u = block + (4 * lane + part) * kRows;
                const T* v = u + 2 * kRows;
                T* to = x + part * kLanes + lane;
                for (std::size_t r = 0; r < rows; ++r) {
                    const std::size_t j = first + r;
                    const T odd = both ? v[r] : T(0);
                    to[j * kStride] = u[r] + odd;
                    to[(n - 1 - j) * kStride] = u[r] - odd;
                }
            }
        }
    }
    T* other = work.b.data();
    const auto transform = [&](bool inverse) {
        T* result = fft_.transform(x, inverse, other);
        if (result != x) std::swap(x, other);
    };
    transform(false);
    T nyquist[kStride];
    for (std::size_t place = 0; place < kStride; ++place) {
        nyquist[place] = x[rows_ * kStride + place] / static_cast<T>(n);
    }
    shift(x, false);
    transform(true);
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t place = 0; place < kStride; ++place) x[j * kStride + place] *= between_[j];
    }
    transform(false);
    shift(x, true);
    transform(true);
    for (std::size_t first = 0; first < rows_; first += kRows) {
        const std::size_t rows = std::min(kRows, rows_ - first);
        T* block = spectra.at(m0, channel, first / kRows);
        for (std::size_t order = 0; order < count; ++order) {
            const std::size_t lane = order / 2;
            const T side = order % 2 ? T(-0.5) : T(0.5);
            const T sign = order % 2 ? T(1) : T(0);
            const std::complex<T> factor = turn[m0 + order];
            T* re = block + 2 * order * kRows;
            T* im = re + kRows;
            for (std::size_t r = 0; r < rows; ++r) {
                const std::size_t j = first + r;
                const T* s = x + j * kStride + lane;
                const T* t = x + (n - 1 - j) * kStride + lane;
                const T alternating = j % 2 ? -sign : sign;
                const std::complex<T> value(
                    on_[j] * (re[r] - alternating * nyquist[lane]) + T(0.5) * s[0] + side * t[0],
                    on_[j] * (im[r] - alternating * nyquist[kLanes + lane]) + T(0.5) * s[kLanes] +
                        side * t[kLanes]);
                const std::complex<T> turned = value * factor;
                re[r] = turned.real();
                im[r] = turned.imag();
            }
        }
    }
}

template <class T>
void MeridianWeight<T>::apply(RowSpectra<T>& spectra,
                              const std::vector<std::complex<T>>& turn) const {
    parallel_blocks(spectra.orders(), kOrders, [&](std::size_t m0, std::size_t) {
        Workspace work;
        for (std::size_t channel = 0; channel < spectra.channels(); ++channel) {
            apply(spectra, m0, channel, turn, work);
        }
    });
}

template class MeridianWeight<float>;
template class MeridianWeight<double>;

}  // namespace airlight
