// SPDX-License-Identifier: Apache-2.0
#include "sh/lane_fft.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "sh/ring_fft.h"

namespace airlight {
namespace {

std::vector<std::size_t> lengths() {
    std::vector<std::size_t> result;
    for (std::size_t n = 1; n <= 140; ++n) result.push_back(n);
    // Large primes and their doubles take the chirp transform.
    for (const std::size_t n : {256, 509, 1018, 1000, 1024, 1080, 2026}) result.push_back(n);
    return result;
}

template <class T>
AlignedVector<T> noise(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    AlignedVector<T> values(count);
    for (T& value : values) value = static_cast<T>(uniform(random));
    return values;
}

template <class T>
class LaneFftTest : public testing::Test {};
using Types = testing::Types<float, double>;
TYPED_TEST_SUITE(LaneFftTest, Types);

// ring_fft_test.cpp compares ComplexFft with the defining sum.
TYPED_TEST(LaneFftTest, EveryLaneAgreesWithTheTransformOfOneSequenceAlone) {
    using T = TypeParam;
    constexpr std::size_t kStride = LaneFft<T>::kStride, kLanes = LaneFft<T>::kLanes;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        for (const std::size_t n : lengths()) {
            const LaneFft<T> fft(n);
            const ComplexFft reference(n);
            ASSERT_GE(fft.buffer_size(), kStride * n);
            const AlignedVector<T> in = noise<T>(fft.buffer_size());
            // Rounding of a transform: a few eps log2(n) per coefficient of size sqrt(n).
            const double tolerance = 8.0 * std::numeric_limits<T>::epsilon() *
                                     std::sqrt(static_cast<double>(n)) *
                                     (2 + std::log2(static_cast<double>(n)));
            for (const bool inverse : {false, true}) {
                AlignedVector<T> data = in, scratch(fft.buffer_size());
                const T* out = fft.transform(data.data(), inverse, scratch.data());
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    std::vector<ComplexFft::Complex> one(n), expected(n),
                        work(reference.scratch_size());
                    for (std::size_t k = 0; k < n; ++k) {
                        one[k] = {in[k * kStride + lane], in[k * kStride + kLanes + lane]};
                    }
                    reference.transform(one.data(), expected.data(), inverse, work.data());
                    for (std::size_t k = 0; k < n; ++k) {
                        const T* element = out + k * kStride + lane;
                        ASSERT_NEAR(element[0], expected[k].real(), tolerance) << n;
                        ASSERT_NEAR(element[kLanes], expected[k].imag(), tolerance) << n;
                    }
                }
            }
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TYPED_TEST(LaneFftTest, LanesDoNotSeeTheirNeighbours) {
    using T = TypeParam;
    constexpr std::size_t kStride = LaneFft<T>::kStride;
    for (const std::size_t n : {60, 97, 256}) {
        const LaneFft<T> fft(n);
        AlignedVector<T> data = noise<T>(fft.buffer_size()), other = data;
        AlignedVector<T> scratch(fft.buffer_size()), other_scratch(fft.buffer_size());
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t lane = 1; lane < LaneFft<T>::kLanes; ++lane) {
                other[k * kStride + lane] = std::numeric_limits<T>::quiet_NaN();
            }
        }
        const T* a = fft.transform(data.data(), false, scratch.data());
        const T* b = fft.transform(other.data(), false, other_scratch.data());
        for (std::size_t k = 0; k < n; ++k) ASSERT_EQ(a[k * kStride], b[k * kStride]) << n;
    }
}

}  // namespace
}  // namespace airlight
