// SPDX-License-Identifier: Apache-2.0
// Random inputs of the ladders, the same everywhere and at every call.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "core/constants.h"

namespace airlight {

/// Draws by the standard's generator, whose numbers do not depend on the library.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : bits_(seed) {}
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53;
    }
    double decades(double lo, double hi) { return std::pow(10.0, uniform(lo, hi)); }
    /// Unit, uniform over the sphere but for z below `lowest`.
    glm::dvec3 direction(double lowest = -1) {
        const double z = uniform(lowest, 1), phi = uniform(-kPi, kPi);
        const double sine = std::sqrt((1 - z) * (1 + z));
        return {sine * std::cos(phi), sine * std::sin(phi), z};
    }

  private:
    std::mt19937_64 bits_;
};

/// Uniform in [-1, 1].
template <class T>
std::vector<T> random_numbers(std::size_t count, std::uint64_t seed) {
    Draws draws(seed);
    std::vector<T> out(count);
    for (T& value : out) value = static_cast<T>(draws.uniform(-1, 1));
    return out;
}

}  // namespace airlight
