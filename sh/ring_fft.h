// SPDX-License-Identifier: Apache-2.0
// Discrete Fourier transforms of the rings (rows) of a lat-long map, two real rings at a time.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace airlight {

/// DFT of any length n >= 1 in double precision on top of KISS FFT.
///
///   forward:  A_m = sum_k a_k exp(-2 pi i m k / n),  m = 0 … n/2
///   inverse:  a_k = A_0 + sum_{m>0} 2 Re(A_m exp(2 pi i m k / n))   (the Nyquist term once)
///
/// so inverse(forward(a)) = n a. Lengths with a prime factor above 61 go through Bluestein's
/// chirp transform [Bluestein70], so the cost is O(n log n) for every n. The relative error of a
/// round trip is a few eps * log2(n) of the ring's largest value. Objects are immutable and may be
/// shared between threads; each thread brings its own Workspace.
class RingFft {
  public:
    using Complex = std::complex<double>;
    using Workspace = std::vector<Complex>;

    explicit RingFft(std::size_t length);
    ~RingFft();
    RingFft(RingFft&&) noexcept;
    RingFft& operator=(RingFft&&) noexcept;

    std::size_t length() const { return length_; }
    /// Number of non-redundant coefficients of a real ring, n/2 + 1.
    std::size_t bins() const { return length_ / 2 + 1; }

    /// Transforms the real rings a and b (n values each) to A and B (bins() values each).
    void forward(const double* a, const double* b, Complex* A, Complex* B, Workspace& work) const;
    /// The inverse, without the factor 1/n. Imaginary parts of A_0 and the Nyquist bin must be 0.
    void inverse(const Complex* A, const Complex* B, double* a, double* b, Workspace& work) const;
    /// Plain complex transform of `in` into `out` (n values each, not overlapping).
    void transform(const Complex* in, Complex* out, bool inverse, Workspace& work) const;

  private:
    struct Impl;
    std::size_t length_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace airlight
