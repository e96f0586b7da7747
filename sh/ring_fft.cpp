// SPDX-License-Identifier: Apache-2.0
#include "sh/ring_fft.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <kissfft.hh>

namespace airlight {
namespace {

using Complex = RingFft::Complex;

constexpr std::size_t kLargestDirectPrime = 61;
constexpr double kPi = 3.14159265358979323846;

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

// KISS FFT computes its twiddles from a running index in one multiplication, which is accurate.
struct Kiss {
    explicit Kiss(std::size_t n) : forward(n, false), inverse(n, true) {}
    kissfft<double> forward, inverse;
};

}  // namespace

struct RingFft::Impl {
    std::unique_ptr<Kiss> direct;
    // Bluestein: a chirp of length n, convolved with the spectrum of the conjugate chirp.
    std::size_t padded = 0;
    std::unique_ptr<Kiss> convolution;
    std::vector<Complex> chirp, chirp_spectrum;
};

RingFft::RingFft(std::size_t length) : length_(length), impl_(std::make_unique<Impl>()) {
    assert(length >= 1);
    if (largest_prime_factor(length) <= kLargestDirectPrime) {
        impl_->direct = std::make_unique<Kiss>(length);
        return;
    }
    std::size_t padded = 1;
    while (padded < 2 * length - 1) padded *= 2;
    impl_->padded = padded;
    impl_->convolution = std::make_unique<Kiss>(padded);
    impl_->chirp.resize(length);
    std::vector<Complex> wrapped(padded);
    for (std::size_t k = 0; k < length; ++k) {
        // k^2 modulo 2n keeps the angle small, hence accurate.
        const double angle = kPi * static_cast<double>(k * k % (2 * length)) / length;
        impl_->chirp[k] = {std::cos(angle), -std::sin(angle)};
        wrapped[k] = std::conj(impl_->chirp[k]);
        if (k > 0) wrapped[padded - k] = wrapped[k];
    }
    impl_->chirp_spectrum.resize(padded);
    impl_->convolution->forward.transform(wrapped.data(), impl_->chirp_spectrum.data());
    for (Complex& value : impl_->chirp_spectrum) value /= static_cast<double>(padded);
}

RingFft::~RingFft() = default;
RingFft::RingFft(RingFft&&) noexcept = default;
RingFft& RingFft::operator=(RingFft&&) noexcept = default;

void RingFft::transform(const Complex* in, Complex* out, bool inverse, Workspace& work) const {
    if (impl_->direct) {
        (inverse ? impl_->direct->inverse : impl_->direct->forward).transform(in, out);
        return;
    }
    const std::size_t n = length_, padded = impl_->padded;
    // The caller may hold its own data in the front of `work`: use what lies behind it.
    const std::size_t base = work.size();
    work.resize(base + 2 * padded);
    Complex* a = work.data() + base;
    Complex* b = a + padded;
    for (std::size_t k = 0; k < n; ++k) {
        a[k] = (inverse ? std::conj(in[k]) : in[k]) * impl_->chirp[k];
    }
    std::fill(a + n, a + padded, Complex());
    impl_->convolution->forward.transform(a, b);
    for (std::size_t k = 0; k < padded; ++k) b[k] *= impl_->chirp_spectrum[k];
    impl_->convolution->inverse.transform(b, a);
    for (std::size_t k = 0; k < n; ++k) {
        const Complex value = a[k] * impl_->chirp[k];
        out[k] = inverse ? std::conj(value) : value;
    }
    work.resize(base);
}

void RingFft::forward(const double* a, const double* b, Complex* A, Complex* B,
                      Workspace& work) const {
    const std::size_t n = length_;
    // Room behind the two buffers lets transform() extend the workspace without moving them.
    work.reserve(2 * n + 2 * impl_->padded);
    work.resize(2 * n);
    Complex* z = work.data();
    Complex* Z = z + n;
    for (std::size_t k = 0; k < n; ++k) z[k] = {a[k], b[k]};
    transform(z, Z, false, work);
    A[0] = Z[0].real();
    B[0] = Z[0].imag();
    for (std::size_t m = 1; m < bins(); ++m) {
        const Complex p = Z[m], q = Z[n - m];
        A[m] = {0.5 * (p.real() + q.real()), 0.5 * (p.imag() - q.imag())};
        B[m] = {0.5 * (p.imag() + q.imag()), 0.5 * (q.real() - p.real())};
    }
}

void RingFft::inverse(const Complex* A, const Complex* B, double* a, double* b,
                      Workspace& work) const {
    const std::size_t n = length_;
    work.reserve(2 * n + 2 * impl_->padded);
    work.resize(2 * n);
    Complex* Z = work.data();
    Complex* z = Z + n;
    Z[0] = {A[0].real(), B[0].real()};
    for (std::size_t m = 1; m < bins(); ++m) {
        // For even n the last pass writes the Nyquist bin twice with the same value.
        Z[n - m] = {A[m].real() + B[m].imag(), B[m].real() - A[m].imag()};
        Z[m] = {A[m].real() - B[m].imag(), A[m].imag() + B[m].real()};
    }
    transform(Z, z, true, work);
    for (std::size_t k = 0; k < n; ++k) {
        a[k] = z[k].real();
        b[k] = z[k].imag();
    }
}

}  // namespace airlight
