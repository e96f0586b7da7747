// SPDX-License-Identifier: Apache-2.0
// Discrete Fourier transforms of many sequences side by side, one in each SIMD lane.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

#include "sh/aligned.h"

namespace airlight {

/// Complex DFTs of kLanes sequences of any length n >= 1 at once:
///
///     out_m = sum_k in_k exp(-+ 2 pi i m k / n)     (forward -, inverse +, no factor 1/n)
///
/// Data are (n, {re, im}, kLanes) with 64-byte alignment: element k of all sequences is two cache
/// lines, whatever the SIMD target. T is float or double.
///
/// Stockham's radix 4, 2, 3 and 5 passes (Highway, run-time dispatch), every lane on its own, so
/// that a sequence's result does not depend on its neighbours. Lengths with a larger prime factor
/// go through Bluestein's chirp transform [Bluestein70]. Error: a few eps * log2(n) of the largest
/// value. Objects are immutable and may be shared between threads.
///
/// Cost at n = 2048, one thread, AVX-512, per element and sequence: 3.1 ns in double and 1.8 ns in
/// float, where ComplexFft of sh/ring_fft.h takes 13 ns.
template <class T>
class LaneFft {
  public:
    static constexpr std::size_t kLanes = 64 / sizeof(T);
    /// Values of T that one element of all sequences takes.
    static constexpr std::size_t kStride = 2 * kLanes;

    explicit LaneFft(std::size_t length);
    ~LaneFft();
    LaneFft(LaneFft&&) noexcept;
    LaneFft& operator=(LaneFft&&) noexcept;

    std::size_t length() const { return length_; }
    /// Values of T that `data` and `scratch` must each have room for, at least kStride n.
    std::size_t buffer_size() const;

    /// Transforms `data`, spoils `scratch`, and returns which of the two holds the result.
    T* transform(T* data, bool inverse, T* scratch) const;

  private:
    // One pass: `radix` sub-transforms of `rest` elements, `done` of them interleaved.
    struct Pass {
        std::size_t radix, rest, done, twiddle;
    };
    struct Chirp;

    std::size_t length_;
    std::vector<Pass> passes_;
    std::vector<T> twiddles_;       // per pass (rest, radix - 1, {re, im})
    std::unique_ptr<Chirp> chirp_;  // of lengths that the passes cannot do
};

/// Multiplies one element of all sequences, of LaneFft's layout, by the same factor.
template <class T>
inline void multiply_element(T* element, std::complex<T> factor) {
    constexpr std::size_t kLanes = LaneFft<T>::kLanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const T re = element[lane], im = element[kLanes + lane];
        element[lane] = re * factor.real() - im * factor.imag();
        element[kLanes + lane] = re * factor.imag() + im * factor.real();
    }
}

extern template class LaneFft<float>;
extern template class LaneFft<double>;

}  // namespace airlight
