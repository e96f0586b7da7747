// SPDX-License-Identifier: Apache-2.0
#include "prt/random_hemisphere.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/constants.h"

namespace airlight {
namespace {

// Points that become directions at a time.
constexpr std::size_t kBlock = 256;

std::uint64_t mixed(std::uint64_t bits) {
    bits ^= bits >> 32;
    bits *= 0xd1342543de82ef95u;
    bits ^= bits >> 29;
    bits *= 0x9e3779b97f4a7c15u;
    return bits ^ (bits >> 32);
}

std::uint64_t seed_of(std::uint32_t vertex) {
    return mixed((std::uint64_t{vertex} + 1) * 0x9e3779b97f4a7c15u);
}

// The i-th pair of numbers of a vertex, 32 bits each.
std::uint64_t draw(std::uint64_t seed, std::size_t i) {
    return mixed(seed + (i + 1) * 0x9e3779b97f4a7c15u);
}

// The middle of one of 2^24 parts of [0, 1], in float exactly.
float fraction(std::uint32_t bits) {
    return (static_cast<float>(bits >> 8) + 0.5f) * 0x1p-24f;
}

// Directions of u, v in (0, 1). Sine and cosine of half the azimuth less a quarter turn by their
// series, to 1e-8 over [-pi/2, pi/2], so that the loop needs no calls.
void lift(std::size_t count, const float* u, const float* v, float* x, float* y, float* z) {
    for (std::size_t i = 0; i < count; ++i) {
        const float h = static_cast<float>(kPi) * (v[i] - 0.5f), q = h * h;
        const float sine =
            h * (1 + q * (-1 / 6.f +
                          q * (1 / 120.f +
                               q * (-1 / 5040.f + q * (1 / 362880.f + q * (-1 / 39916800.f +
                                                                           q / 6227020800.f))))));
        const float cosine =
            1 + q * (-1 / 2.f +
                     q * (1 / 24.f + q * (-1 / 720.f + q * (1 / 40320.f + q * (-1 / 3628800.f +
                                                                               q / 479001600.f)))));
        const float radius = std::sqrt(u[i] * (2 - u[i]));
        x[i] = radius * (2 * sine * sine - 1);
        y[i] = radius * (-2 * sine * cosine);
        z[i] = 1 - u[i];
    }
}

// point(i, u, v) makes the i-th one.
template <class Point>
void fill(HemisphereDirections& out, const Point& point) {
    float u[kBlock], v[kBlock];
    for (std::size_t begin = 0; begin < out.count(); begin += kBlock) {
        const std::size_t size = std::min(kBlock, out.count() - begin);
        for (std::size_t k = 0; k < size; ++k) point(begin + k, u[k], v[k]);
        lift(size, u, v, out.x.data() + begin, out.y.data() + begin, out.z.data() + begin);
    }
}

// Flips each bit by a hash of those below it, since nothing here carries downwards: nested
// scrambling for numbers whose first digit is the lowest bit. The last word alone makes every flip
// fair; multiplied by even words, flips of different prefixes come apart.
class Scrambling {
  public:
    explicit Scrambling(std::uint64_t seed) {
        for (std::size_t i = 0; i < 8; i += 2) {
            const std::uint64_t bits = draw(seed, i);
            words_[i] = static_cast<std::uint32_t>(bits);
            words_[i + 1] = static_cast<std::uint32_t>(bits >> 32);
        }
    }

    std::uint32_t operator()(std::uint32_t bits) const {
        bits += words_[0];
        bits ^= bits * (words_[1] & ~1u);
        bits *= words_[2] | 1;
        bits ^= bits * (words_[3] & ~1u);
        bits += words_[4];
        bits ^= bits * (words_[5] & ~1u);
        bits *= words_[6] | 1;
        return bits ^ words_[7];
    }

  private:
    std::uint32_t words_[8];
};

std::uint32_t reversed(std::uint32_t bits) {
    bits = (bits >> 16) | (bits << 16);
    bits = ((bits & 0xff00ff00u) >> 8) | ((bits & 0x00ff00ffu) << 8);
    bits = ((bits & 0xf0f0f0f0u) >> 4) | ((bits & 0x0f0f0f0fu) << 4);
    bits = ((bits & 0xccccccccu) >> 2) | ((bits & 0x33333333u) << 2);
    return ((bits & 0xaaaaaaaau) >> 1) | ((bits & 0x55555555u) << 1);
}

// Sobol's second dimension with the first digit as the lowest bit. Digit k is the sum of C(j, k)
// i_j mod 2 over the digits i_j of the index, and C(j, k) is odd where j has all the bits of k.
std::uint32_t second_sobol(std::uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

}  // namespace

void random_hemisphere(std::uint32_t vertex, HemisphereDirections& out) {
    const std::uint64_t seed = seed_of(vertex);
    fill(out, [&](std::size_t i, float& u, float& v) {
        const std::uint64_t bits = draw(seed, i);
        u = fraction(static_cast<std::uint32_t>(bits));
        v = fraction(static_cast<std::uint32_t>(bits >> 32));
    });
}

void stratified_hemisphere(std::uint32_t vertex, HemisphereDirections& out) {
    const std::uint64_t seed = seed_of(vertex);
    const std::size_t count = out.count();
    // Cells are as high as wide at the horizon, where what hides light is.
    const auto rows = std::max<std::size_t>(
        1,
        static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count) / (2 * kPi)))));
    std::size_t row = 0, first = 0, end = count / rows;
    fill(out, [&](std::size_t i, float& u, float& v) {
        if (i == end) {
            ++row;
            first = end;
            end = count * (row + 1) / rows;
        }
        const std::uint64_t bits = draw(seed, i);
        const auto size = static_cast<float>(end - first);
        // Rounded up, the last cell would end outside of the square.
        u = std::min(0x1.fffffep-1f, (static_cast<float>(first) +
                                      size * fraction(static_cast<std::uint32_t>(bits))) /
                                         static_cast<float>(count));
        v = (static_cast<float>(i - first) + fraction(static_cast<std::uint32_t>(bits >> 32))) /
            size;
    });
}

void owen_sobol_hemisphere(std::uint32_t vertex, HemisphereDirections& out) {
    const Scrambling first(seed_of(vertex)), second(mixed(seed_of(vertex)));
    fill(out, [&](std::size_t i, float& u, float& v) {
        const auto index = static_cast<std::uint32_t>(i);
        u = fraction(reversed(first(index)));
        v = fraction(reversed(second(second_sobol(index))));
    });
}

}  // namespace airlight
