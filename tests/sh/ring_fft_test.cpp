// SPDX-License-Identifier: Apache-2.0
#include "sh/ring_fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace airlight {
namespace {

using Complex = ComplexFft::Complex;

std::vector<std::size_t> lengths() {
    std::vector<std::size_t> result;
    for (std::size_t n = 1; n <= 140; ++n) result.push_back(n);
    // Large primes and their doubles take the chirp transform.
    for (const std::size_t n : {256, 509, 1018, 1021, 1000, 1024, 2026}) result.push_back(n);
    return result;
}

// Rounding of a transform: a few eps * log2(n) per coefficient of size sqrt(n).
double tolerance(std::size_t n) {
    return 2e-15 * std::sqrt(static_cast<double>(n)) * (2 + std::log2(static_cast<double>(n)));
}

TEST(RingFft, AgreesWithTheDefiningSumForEveryLength) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const std::size_t n : lengths()) {
        const RingFft fft(n);
        std::vector<double> ring(n), back(n);
        for (double& value : ring) value = uniform(random);
        std::vector<Complex> bins(fft.bins());
        RingFft::Workspace work;
        fft.forward(ring.data(), bins.data(), work);
        for (std::size_t m = 0; m < bins.size(); ++m) {
            std::complex<long double> sum = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const long double angle =
                    -2 * 3.14159265358979323846264L * static_cast<long double>(m * k % n) / n;
                sum += static_cast<long double>(ring[k]) *
                       std::complex<long double>(std::cos(angle), std::sin(angle));
            }
            ASSERT_NEAR(bins[m].real(), static_cast<double>(sum.real()), tolerance(n)) << n;
            ASSERT_NEAR(bins[m].imag(), static_cast<double>(sum.imag()), tolerance(n)) << n;
        }
        fft.inverse(bins.data(), back.data(), work);
        for (std::size_t k = 0; k < n; ++k) ASSERT_NEAR(back[k] / n, ring[k], tolerance(n)) << n;
    }
}

TEST(RingFft, ComplexTransformInverts) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const std::size_t n : lengths()) {
        const ComplexFft fft(n);
        std::vector<Complex> in(n), out(n), back(n), scratch(fft.scratch_size());
        for (Complex& value : in) value = {uniform(random), uniform(random)};
        fft.transform(in.data(), out.data(), false, scratch.data());
        Complex first = 0;
        for (const Complex& value : in) first += value;
        ASSERT_LT(std::abs(out[0] - first), tolerance(n));
        fft.transform(out.data(), back.data(), true, scratch.data());
        for (std::size_t k = 0; k < n; ++k) {
            ASSERT_LT(std::abs(back[k] / static_cast<double>(n) - in[k]), tolerance(n)) << n;
        }
    }
}

}  // namespace
}  // namespace airlight
