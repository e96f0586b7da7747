// SPDX-License-Identifier: Apache-2.0
#include "prt/random_hemisphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <set>
#include <utility>
#include <vector>

#include "core/constants.h"

namespace airlight {
namespace {

using Sampler = void (*)(std::uint32_t vertex, HemisphereDirections& out);

HemisphereDirections directions(Sampler sampler, std::uint32_t vertex, std::size_t count) {
    HemisphereDirections out;
    for (auto* values : {&out.x, &out.y, &out.z}) values->resize(count);
    sampler(vertex, out);
    return out;
}

/// The points of the square that became directions.
std::vector<glm::dvec2> points(Sampler sampler, std::uint32_t vertex, std::size_t count) {
    const HemisphereDirections d = directions(sampler, vertex, count);
    std::vector<glm::dvec2> out;
    for (std::size_t i = 0; i < count; ++i) {
        const double turns = std::atan2(double(d.y[i]), double(d.x[i])) / (2 * kPi);
        out.emplace_back(1 - double(d.z[i]), turns < 0 ? turns + 1 : turns);
    }
    return out;
}

constexpr Sampler kSamplers[] = {random_hemisphere, stratified_hemisphere, owen_sobol_hemisphere};

TEST(RandomHemisphere, DirectionsAreUnitAboveAndOfTheVertexAlone) {
    for (const Sampler sampler : kSamplers) {
        for (const std::size_t count : {1u, 2u, 7u, 1000u, 4097u}) {
            for (const std::uint32_t vertex : {0u, 1u, 123456u, 0xffffffffu}) {
                const HemisphereDirections d = directions(sampler, vertex, count);
                glm::dvec3 sum(0);
                for (std::size_t i = 0; i < count; ++i) {
                    const glm::dvec3 v(d.x[i], d.y[i], d.z[i]);
                    ASSERT_NEAR(glm::length(v), 1, 1e-6);
                    ASSERT_GT(v.z, 0);
                    ASSERT_LE(v.z, 1);
                    sum += v / double(count);
                }
                // Five standard deviations of independent ones.
                const double five = 5 / std::sqrt(double(count));
                EXPECT_NEAR(sum.z, 0.5, five * std::sqrt(1 / 12.0));
                EXPECT_NEAR(sum.x, 0, five * std::sqrt(1 / 3.0));
                EXPECT_NEAR(sum.y, 0, five * std::sqrt(1 / 3.0));
                const HemisphereDirections again = directions(sampler, vertex, count);
                EXPECT_TRUE(d.x == again.x && d.y == again.y && d.z == again.z);
                const HemisphereDirections other = directions(sampler, vertex ^ 1, count);
                EXPECT_FALSE(d.x == other.x);
            }
        }
    }
}

TEST(RandomHemisphere, EveryStratumHasOnePoint) {
    for (const std::size_t count : {1u, 5u, 64u, 1000u}) {
        const auto rows = std::max(1L, std::lround(std::sqrt(double(count) / (2 * kPi))));
        const std::vector<glm::dvec2> p = points(stratified_hemisphere, 77, count);
        std::size_t i = 0;
        for (std::size_t row = 0; row < std::size_t(rows); ++row) {
            const std::size_t first = i, end = count * (row + 1) / std::size_t(rows);
            for (; i < end; ++i) {
                EXPECT_GE(p[i].x, double(first) / double(count) - 1e-6);
                EXPECT_LE(p[i].x, double(end) / double(count) + 1e-6);
                EXPECT_NEAR(p[i].y * double(end - first), double(i - first) + 0.5, 0.5 + 1e-4);
            }
        }
        EXPECT_EQ(i, count);
    }
}

TEST(RandomHemisphere, EveryElementaryIntervalHasOneOfOwensPoints) {
    for (const std::uint32_t vertex : {0u, 1u, 2u, 99u}) {
        for (const int digits : {1, 4, 8}) {
            const std::vector<glm::dvec2> p =
                points(owen_sobol_hemisphere, vertex, std::size_t{1} << digits);
            for (int a = 0; a <= digits; ++a) {
                std::set<std::pair<int, int>> cells;
                for (const glm::dvec2& at : p) {
                    cells.emplace(int(std::ldexp(at.x, a)), int(std::ldexp(at.y, digits - a)));
                }
                EXPECT_EQ(cells.size(), p.size()) << vertex << ' ' << digits << ' ' << a;
            }
        }
    }
}

// Owen's scrambling flips a digit by a fair coin for each prefix, and coins of different prefixes,
// digits and dimensions are independent.
TEST(RandomHemisphere, OwensFlipsAreFairAndIndependent) {
    constexpr int kVertices = 8192, kDigits = 6, kPoints = 16;
    // Digits of points of many vertices, as +-1.
    std::vector<std::vector<double>> coins(2 * kDigits * kPoints);
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        const std::vector<glm::dvec2> p = points(owen_sobol_hemisphere, vertex, kPoints);
        std::size_t k = 0;
        for (const glm::dvec2& at : p) {
            for (int axis = 0; axis < 2; ++axis) {
                for (int digit = 1; digit <= kDigits; ++digit, ++k) {
                    coins[k].push_back(int(std::ldexp(at[axis], digit)) % 2 ? 1 : -1);
                }
            }
        }
    }
    // The same coin, or its other side: the same prefix, which by construction is shared.
    double worst = 0;
    for (std::size_t a = 0; a < coins.size(); ++a) {
        double mean = 0;
        for (const double c : coins[a]) mean += c / kVertices;
        EXPECT_LT(std::abs(mean), 5 / std::sqrt(double(kVertices))) << a;
        for (std::size_t b = 0; b < a; ++b) {
            double product = 0;
            for (std::size_t i = 0; i < kVertices; ++i) product += coins[a][i] * coins[b][i];
            product = std::abs(product) / kVertices;
            if (product < 0.999) worst = std::max(worst, product);
        }
    }
    // Of 18 thousand pairs of fair coins the worst is at 4 to 4.5 standard deviations;
    // measured 3.9.
    EXPECT_LT(worst, 5 / std::sqrt(double(kVertices)));
}

// The solid angle of a part of the hemisphere with a curved edge.
TEST(RandomHemisphere, OwensPointsBeatStrataWhichBeatChance) {
    double before = 1;
    for (const Sampler sampler : kSamplers) {
        double squares = 0;
        constexpr int kVertices = 200, kCount = 1024;
        for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
            const HemisphereDirections d = directions(sampler, vertex, kCount);
            double inside = 0;
            for (std::size_t i = 0; i < kCount; ++i) {
                inside += 0.6f * d.x[i] + 0.8f * d.z[i] > 0.7f ? 1.0 / kCount : 0.0;
            }
            // The cap does not reach the horizon: its part of 2 pi is 1 - cos.
            squares += std::pow(inside - 0.3, 2) / kVertices;
        }
        const double error = std::sqrt(squares);
        EXPECT_LT(error, before / 1.2);
        before = error;
    }
}

}  // namespace
}  // namespace airlight
