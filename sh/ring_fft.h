// SPDX-License-Identifier: Apache-2.0
// Discrete Fourier transforms of the rings (rows) of a lat-long map.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace airlight {

/// Complex DFT of any length n >= 1 in double precision, on top of KISS FFT:
///
///     out_m = sum_k in_k exp(-+ 2 pi i m k / n)     (forward -, inverse +, no factor 1/n)
///
/// Lengths with a prime factor above 5 go through Bluestein's chirp transform [Bluestein70], so
/// the cost is O(n log n) for every n. The relative error is a few eps * log2(n) of the largest
/// value. Objects are immutable and may be shared between threads.
class ComplexFft {
  public:
    using Complex = std::complex<double>;

    explicit ComplexFft(std::size_t length);
    ~ComplexFft();
    ComplexFft(ComplexFft&&) noexcept;
    ComplexFft& operator=(ComplexFft&&) noexcept;

    /// Values of scratch memory that transform() needs.
    std::size_t scratch_size() const;
    /// `in` and `out` hold n values each and do not overlap.
    void transform(const Complex* in, Complex* out, bool inverse, Complex* scratch) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// DFT of real rings of any length n >= 1:
///
///   forward:  A_m = sum_k a_k exp(-2 pi i m k / n),  m = 0 … n/2
///   inverse:  a_k = A_0 + sum_{m>0} 2 Re(A_m exp(2 pi i m k / n))   (the Nyquist term once)
///
/// so inverse(forward(a)) = n a. Rings of even length run as one complex transform of half the
/// length. Each thread brings its own Workspace.
class RingFft {
  public:
    using Complex = ComplexFft::Complex;
    using Workspace = std::vector<Complex>;

    explicit RingFft(std::size_t length);

    std::size_t length() const { return length_; }
    /// Number of non-redundant coefficients of a real ring, n/2 + 1.
    std::size_t bins() const { return length_ / 2 + 1; }

    /// Transforms the real ring a (n values) to A (bins() values).
    void forward(const double* a, Complex* A, Workspace& work) const;
    /// The inverse, without the factor 1/n. Imaginary parts of A_0 and the Nyquist bin must be 0.
    void inverse(const Complex* A, double* a, Workspace& work) const;

  private:
    std::size_t length_;
    ComplexFft fft_;
    std::vector<Complex> twiddle_;  // exp(-2 pi i m / n), m <= n/4, for even n
};

}  // namespace airlight
