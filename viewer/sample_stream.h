// SPDX-License-Identifier: Apache-2.0
// Numbers for the samples of a pixel, the same whichever thread asks.
#pragma once

#include <cmath>
#include <cstdint>

namespace airlight {

/// The numbers of sample `index` of pixel `pixel`, in [0, 1), one after the other. Over the indices
/// the first kEven of them are additive recurrences with steps sqrt(p) mod 1, p the primes, shifted
/// by a hash of the pixel: evenly spread. Later ones are hashes.
class SampleStream {
  public:
    SampleStream(std::uint64_t pixel, std::uint64_t index) : pixel_(pixel), index_(index) {}

    /// The numbers after those already drawn, but for one purpose alone: what others draw or leave
    /// out does not change them.
    SampleStream of(unsigned purpose) const {
        SampleStream stream(mix(pixel_, ~std::uint64_t(purpose)), index_);
        stream.dimension_ = dimension_;
        return stream;
    }

    double next() {
        static constexpr double kSteps[kEven] = {
            0.41421356237309515, 0.73205080756887719, 0.23606797749978981, 0.64575131106459072,
            0.31662479035539981, 0.60555127546398912, 0.12310562561766059, 0.35889894354067398,
            0.79583152331271952, 0.38516480713450418, 0.56776436283002192, 0.082762530298219369};
        const int dimension = dimension_++;
        const double shift = fraction(mix(pixel_, static_cast<std::uint64_t>(dimension)));
        if (dimension >= kEven) return fraction(mix(mix(pixel_, index_ + 1), dimension_));
        const double x = shift + static_cast<double>(index_) * kSteps[dimension];
        return x - std::floor(x);
    }

  private:
    static constexpr int kEven = 12;

    // Multiplication carries upwards, the shifts bring it down again.
    static std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
        std::uint64_t bits = (a + 1) * 0x9e3779b97f4a7c15u ^ (b + 1) * 0xd1342543de82ef95u;
        bits ^= bits >> 29;
        bits *= 0xd1342543de82ef95u;
        bits ^= bits >> 32;
        bits *= 0x9e3779b97f4a7c15u;
        return bits ^ (bits >> 30);
    }
    static double fraction(std::uint64_t bits) {
        return 0x1p-53 * static_cast<double>(bits >> 11);
    }

    std::uint64_t pixel_, index_;
    int dimension_ = 0;
};

}  // namespace airlight
