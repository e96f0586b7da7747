// SPDX-License-Identifier: Apache-2.0
// Sweeps: a function at a million inputs, random and from the corners of its domain.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "core/parallel.h"

namespace airlight {

/// Sanitizers make everything ten times slower; a tenth of the inputs then takes as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr std::size_t kSweepInputs = 100'000;
#else
inline constexpr std::size_t kSweepInputs = 1'000'000;
#endif

/// Draws of one input, the same for the same number on every platform.
class SweepDraw {
  public:
    explicit SweepDraw(std::uint64_t number) : state_(number * 0x9E3779B97F4A7C15u) {}

    std::uint64_t bits() {
        // SplitMix64.
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// In (0, 1).
    double unit() { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * unit(); }
    /// Powers of ten from 10^lo to 10^hi, evenly in the exponent; below -308 denormal.
    double decades(double lo, double hi) { return std::pow(10.0, uniform(lo, hi)); }
    double pick(std::initializer_list<double> values) {
        return values.begin()[bits() % values.size()];
    }
    bool chance(double probability) { return unit() < probability; }
    double sign() { return chance(0.5) ? 1 : -1; }

    /// [0, inf] with all its corners: zeros of both signs, denormals, all of a double's range,
    /// ordinary sizes around 1, infinity if `infinite`.
    double not_negative(bool infinite = true) {
        switch (bits() % 8) {
            case 0:
                return pick({0.0, -0.0, 5e-324, 1e-310, 2.2250738585072014e-308, 1e-300, 1e-160,
                             1e-16, 1.0, 1e16, 1e160, 1e300, 1.7976931348623157e308});
            case 1:
                return decades(-323, 308);
            case 2:
                return infinite && chance(0.5) ? std::numeric_limits<double>::infinity()
                                               : decades(-12, 12);
            case 3:
            case 4:
                return decades(-6, 3);
            default:
                return uniform(0, 20);
        }
    }
    /// [lo, hi] with both ends, what lies next to them and beside the middle.
    double between(double lo, double hi) {
        switch (bits() % 8) {
            case 0:
                return pick({lo, hi, std::nextafter(lo, hi), std::nextafter(hi, lo),
                             lo + (hi - lo) / 2, std::nextafter(lo + (hi - lo) / 2, hi)});
            case 1:
                return lo + (hi - lo) * decades(-17, 0);
            case 2:
                return hi - (hi - lo) * decades(-17, 0);
            case 3:
                return lo + (hi - lo) * (0.5 + sign() * 0.5 * decades(-17, 0));
            default:
                return uniform(lo, hi);
        }
    }
    /// [0, pi] with its corners, angles down to the denormals among them.
    double angle() { return chance(0.1) ? decades(-323, 0) : between(0, 3.141592653589793); }

  private:
    std::uint64_t state_;
};

/// Calls `check(draw)` for `count` inputs on all cores; it returns "" or what is wrong, in one
/// line with the arguments. The test fails with the first few of those.
template <class Check>
void sweep(const Check& check, std::size_t count = kSweepInputs) {
    std::mutex mutex;
    std::vector<std::string> wrong;
    std::atomic<std::size_t> failures{0};
    parallel_blocks(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            SweepDraw draw(i);
            const std::string message = check(draw);
            if (message.empty()) continue;
            ++failures;
            const std::lock_guard<std::mutex> lock(mutex);
            if (wrong.size() < 5) wrong.push_back(message);
        }
    });
    for (const std::string& message : wrong) ADD_FAILURE() << message;
    EXPECT_EQ(failures, 0u) << "of " << count << " inputs";
}

/// A line for sweep(): what(a, b, ...) = value.
inline std::string sweep_report(const char* what, std::initializer_list<double> arguments,
                                double value) {
    std::string line = std::string(what) + "(";
    const auto append = [&line](double number) {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", number);
        line += text;
    };
    for (const double& argument : arguments) {
        if (&argument != arguments.begin()) line += ", ";
        append(argument);
    }
    line += ") = ";
    append(value);
    return line;
}

}  // namespace airlight
