// SPDX-License-Identifier: Apache-2.0
#include "sh/ring_fft.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <kissfft.hh>

#include "core/constants.h"

namespace airlight {
namespace {

using Complex = ComplexFft::Complex;

// KISS FFT has butterflies for 2 … 5; its general one shares a buffer between threads.
constexpr std::size_t kLargestDirectPrime = 5;

std::size_t largest_prime_factor(std::size_t n) {
    std::size_t largest = 1;
    for (std::size_t p = 2; p * p <= n; ++p) {
        while (n % p == 0) {
            largest = p;
            n /= p;
        }
    }
    return std::max(largest, n);
}

struct Kiss {
    explicit Kiss(std::size_t n) : forward(n, false), inverse(n, true) {}
    kissfft<double> forward, inverse;
};

}  // namespace

struct ComplexFft::Impl {
    explicit Impl(std::size_t length_in) : length(length_in) {
        if (largest_prime_factor(length) <= kLargestDirectPrime) {
            kiss = std::make_unique<Kiss>(length);
            return;
        }
        padded = 1;
        while (padded < 2 * length - 1) padded *= 2;
        kiss = std::make_unique<Kiss>(padded);
        chirp.resize(length);
        std::vector<Complex> wrapped(padded);
        for (std::size_t k = 0; k < length; ++k) {
            // k^2 modulo 2n keeps the angle small, hence accurate.
            const double angle = kPi * static_cast<double>(k * k % (2 * length)) / length;
            chirp[k] = {std::cos(angle), -std::sin(angle)};
            wrapped[k] = std::conj(chirp[k]);
            if (k > 0) wrapped[padded - k] = wrapped[k];
        }
        chirp_spectrum.resize(padded);
        kiss->forward.transform(wrapped.data(), chirp_spectrum.data());
        for (Complex& value : chirp_spectrum) value /= static_cast<double>(padded);
    }

    std::size_t length;
    std::size_t padded = 0;  // length of the chirp convolution, 0 for a direct transform
    std::unique_ptr<Kiss> kiss;
    std::vector<Complex> chirp, chirp_spectrum;
};

ComplexFft::ComplexFft(std::size_t length) : impl_(std::make_unique<Impl>(length)) {
    assert(length >= 1);
}

ComplexFft::~ComplexFft() = default;
ComplexFft::ComplexFft(ComplexFft&&) noexcept = default;
ComplexFft& ComplexFft::operator=(ComplexFft&&) noexcept = default;

std::size_t ComplexFft::scratch_size() const {
    return 2 * impl_->padded;
}

void ComplexFft::transform(const Complex* in, Complex* out, bool inverse, Complex* scratch) const {
    const Kiss& kiss = *impl_->kiss;
    if (impl_->padded == 0) {
        (inverse ? kiss.inverse : kiss.forward).transform(in, out);
        return;
    }
    const std::size_t n = impl_->length, padded = impl_->padded;
    const std::vector<Complex>& chirp = impl_->chirp;
    Complex* a = scratch;
    Complex* b = scratch + padded;
    for (std::size_t k = 0; k < n; ++k) a[k] = (inverse ? std::conj(in[k]) : in[k]) * chirp[k];
    std::fill(a + n, a + padded, Complex());
    kiss.forward.transform(a, b);
    for (std::size_t k = 0; k < padded; ++k) b[k] *= impl_->chirp_spectrum[k];
    kiss.inverse.transform(b, a);
    for (std::size_t k = 0; k < n; ++k) {
        const Complex value = a[k] * chirp[k];
        out[k] = inverse ? std::conj(value) : value;
    }
}

RingFft::RingFft(std::size_t length)
    : length_(length), fft_(length % 2 == 0 ? length / 2 : length) {
    if (length % 2 == 1) return;
    for (std::size_t m = 0; m <= length / 4; ++m) {
        const double angle = 2 * kPi * static_cast<double>(m) / length;
        twiddle_.push_back({std::cos(angle), -std::sin(angle)});
    }
}

// Even n: z_k = a_2k + i a_2k+1 has the transform Z = E + i O of the even and odd samples, and
// A_m = E_m + w^m O_m, w = exp(-2 pi i / n).
void RingFft::forward(const double* a, Complex* A, Workspace& work) const {
    const std::size_t n = length_;
    work.resize(2 * n + fft_.scratch_size());
    Complex* z = work.data();
    if (n % 2 == 1) {
        std::copy(a, a + n, z);
        fft_.transform(z, z + n, false, z + 2 * n);
        std::copy(z + n, z + n + bins(), A);
        return;
    }
    const std::size_t half = n / 2;
    for (std::size_t k = 0; k < half; ++k) z[k] = {a[2 * k], a[2 * k + 1]};
    fft_.transform(z, A, false, z + n);
    const Complex first = A[0];
    A[0] = first.real() + first.imag();
    A[half] = first.real() - first.imag();
    for (std::size_t m = 1; 2 * m <= half; ++m) {
        const Complex p = A[m], q = std::conj(A[half - m]);
        const Complex even = 0.5 * (p + q), difference = 0.5 * (p - q);
        const Complex odd = Complex(difference.imag(), -difference.real()) * twiddle_[m];
        A[m] = even + odd;
        A[half - m] = std::conj(even - odd);
    }
}

void RingFft::inverse(const Complex* A, double* a, Workspace& work) const {
    const std::size_t n = length_;
    work.resize(2 * n + fft_.scratch_size());
    Complex* z = work.data();
    if (n % 2 == 1) {
        std::copy(A, A + bins(), z);
        for (std::size_t m = 1; m < bins(); ++m) z[n - m] = std::conj(A[m]);
        fft_.transform(z, z + n, true, z + 2 * n);
        for (std::size_t k = 0; k < n; ++k) a[k] = z[n + k].real();
        return;
    }
    const std::size_t half = n / 2;
    z[0] = {A[0].real() + A[half].real(), A[0].real() - A[half].real()};
    for (std::size_t m = 1; 2 * m <= half; ++m) {
        const Complex p = A[m], q = std::conj(A[half - m]);
        const Complex even = p + q, odd = (p - q) * std::conj(twiddle_[m]);
        const Complex turned(-odd.imag(), odd.real());
        z[half - m] = std::conj(even - turned);
        z[m] = even + turned;
    }
    fft_.transform(z, z + n, true, z + 2 * n);
    for (std::size_t k = 0; k < half; ++k) {
        a[2 * k] = z[n + k].real();
        a[2 * k + 1] = z[n + k].imag();
    }
}

}  // namespace airlight
