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
    constexpr std::size_t kStride = LaneFft<T>::kStride, kLanes = LaneFft<T>::kLanes, kChunk = 32;
    const std::size_t n = 2 * rows_, count = std::min(kOrders, spectra.orders() - m0);
    work.a.resize(fft_.buffer_size());
    work.b.resize(fft_.buffer_size());
    if (count < kOrders) std::fill(work.a.begin(), work.a.end(), T(0));
    const std::vector<T> none(count % 2 ? rows_ : 0);
    // The rows of u and v, component `part`, in one lane.
    const auto rows_of = [&](std::size_t lane, std::size_t part, const T*& u, const T*& v) {
        const std::size_t m = m0 + 2 * lane;
        u = spectra.at(m, 2 * channel + part);
        v = m + 1 < m0 + count ? spectra.at(m + 1, 2 * channel + part) : none.data();
    };
    T* x = work.a.data();
    for (std::size_t first = 0; first < rows_; first += kChunk) {
        const std::size_t last = std::min(rows_, first + kChunk);
        for (std::size_t lane = 0; 2 * lane < count; ++lane) {
            for (std::size_t part = 0; part < 2; ++part) {
                const T *u, *v;
                rows_of(lane, part, u, v);
                const std::size_t place = part * kLanes + lane;
                for (std::size_t j = first; j < last; ++j) {
                    x[j * kStride + place] = u[j] + v[j];
                    x[(n - 1 - j) * kStride + place] = u[j] - v[j];
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
    for (std::size_t j = 0; j < n; ++j) multiply_element(x + j * kStride, {between_[j], T(0)});
    transform(false);
    shift(x, true);
    transform(true);
    for (std::size_t first = 0; first < rows_; first += kChunk) {
        const std::size_t last = std::min(rows_, first + kChunk);
        for (std::size_t lane = 0; 2 * lane < count; ++lane) {
            T* out[2][2];
            for (std::size_t side = 0; side < 2; ++side) {
                for (std::size_t part = 0; part < 2; ++part) {
                    const std::size_t m = std::min(2 * lane + side, count - 1);
                    out[side][part] = spectra.at(m0 + m, 2 * channel + part);
                }
            }
            const bool both = 2 * lane + 1 < count;
            const std::complex<T> turn_u = turn[m0 + 2 * lane];
            const std::complex<T> turn_v = both ? turn[m0 + 2 * lane + 1] : std::complex<T>();
            for (std::size_t j = first; j < last; ++j) {
                const T* s = x + j * kStride + lane;
                const T* t = x + (n - 1 - j) * kStride + lane;
                const T w = on_[j];
                const std::complex<T> u(w * out[0][0][j] + (s[0] + t[0]) / 2,
                                        w * out[0][1][j] + (s[kLanes] + t[kLanes]) / 2);
                const std::complex<T> turned_u = u * turn_u;
                if (both) {
                    const T re = j % 2 ? -nyquist[lane] : nyquist[lane];
                    const T im = j % 2 ? -nyquist[kLanes + lane] : nyquist[kLanes + lane];
                    const std::complex<T> v(w * (out[1][0][j] - re) + (s[0] - t[0]) / 2,
                                            w * (out[1][1][j] - im) + (s[kLanes] - t[kLanes]) / 2);
                    const std::complex<T> turned_v = v * turn_v;
                    out[1][0][j] = turned_v.real();
                    out[1][1][j] = turned_v.imag();
                }
                out[0][0][j] = turned_u.real();
                out[0][1][j] = turned_u.imag();
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
