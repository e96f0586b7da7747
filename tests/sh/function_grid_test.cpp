// SPDX-License-Identifier: Apache-2.0
#include "sh/function_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sh/index.h"
#include "sh/triple_product.h"
#include "sh/zonal.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

// A function of order 6 between 0.3 and 2: smooth and positive.
std::vector<double> positive_function(int order, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> out(sh_count(order));
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5 * uniform(random) / double(k + 1);
    out[0] = 4;
    return out;
}

TEST(ShGrid, LeavesEverythingAloneWhereTheFunctionDoes) {
    for (const int order : {1, 2, 6, 9}) {
        for (const int rows : {order, order + 1, 0}) {
            const ShGrid grid(order, rows);
            const auto in = positive_function(order, 1);
            std::vector<double> out(in.size());
            grid.apply([](double value) { return value; }, in.data(), out.data());
            for (std::size_t k = 0; k < in.size(); ++k) EXPECT_NEAR(out[k], in[k], 3e-14);
        }
    }
}

TEST(ShGrid, SquaresAreProducts) {
    for (const int order : {2, 4, 6}) {
        const ShGrid grid(order, (3 * order - 1) / 2);
        const auto in = positive_function(order, 2);
        std::vector<double> squared(in.size()), product(in.size());
        grid.apply([](double value) { return value * value; }, in.data(), squared.data());
        TripleProducts(order).multiply(in.data(), in.data(), product.data());
        for (std::size_t k = 0; k < in.size(); ++k) EXPECT_NEAR(squared[k], product[k], 3e-14);
    }
}

// exp(a cos gamma) is sum_l (2l+1) i_l(a) P_l with modified spherical Bessel functions: i_0 =
// sinh(a) / a, i_1 = (a cosh a - sinh a) / a^2.
TEST(ShGrid, ExponentialOfACosineIsItsClosedForm) {
    constexpr double kA = 1.5;
    std::vector<double> in(36);
    in[sh_index(1, 0)] = kA / std::sqrt(3 / (4 * kPi));
    const std::vector<float> in_float(in.begin(), in.end());
    std::vector<double> out(36);
    std::vector<float> out_float(36);
    const ShGrid grid(6);
    grid.apply([](double value) { return std::exp(value); }, in.data(), out.data());
    grid.exponential(1, in_float.data(), out_float.data());
    const double i0 = std::sinh(kA) / kA, i1 = (kA * std::cosh(kA) - std::sinh(kA)) / (kA * kA);
    EXPECT_NEAR(out[0], zonal_coefficient(0, 4 * kPi * i0), 1e-13);
    EXPECT_NEAR(out[sh_index(1, 0)], zonal_coefficient(1, 4 * kPi * i1), 1e-13);
    // What function_grid.h states of sums in float.
    EXPECT_NEAR(out_float[0], out[0], 5e-6 * out[0]);
    EXPECT_NEAR(out_float[sh_index(1, 0)], out[sh_index(1, 0)], 5e-6 * out[0]);
    EXPECT_NEAR(out[sh_index(2, 1)], 0, 1e-13);
}

TEST(ShGrid, FloatBatchesAreTheDoubleFunctionsOnEveryTarget) {
    constexpr int kOrder = 6;
    constexpr std::size_t kSize = 36;
    const ShGrid grid(kOrder);
    struct Case {
        std::function<double(double)> function;
        std::function<void(std::size_t, const float*, float*)> batch;
    };
    const std::vector<Case> cases = {
        {[](double v) { return std::exp(v); },
         [&](std::size_t n, const float* in, float* out) { grid.exponential(n, in, out); }},
        {[](double v) { return std::log(std::max(v, 1.0)); },
         [&](std::size_t n, const float* in, float* out) { grid.logarithm(n, 1.0f, in, out); }},
        {[](double v) { return std::clamp(v, 0.9, 1.25); },
         [&](std::size_t n, const float* in, float* out) { grid.clamp(n, 0.9f, 1.25f, in, out); }},
    };
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        const ForcedTarget forced(target);
        for (const std::size_t count : {0, 1, 15, 40}) {
            std::vector<float> in(count * kSize);
            for (std::size_t v = 0; v < count; ++v) {
                const auto f = positive_function(kOrder, static_cast<unsigned>(v) + 3);
                std::copy(f.begin(), f.end(), in.begin() + static_cast<std::ptrdiff_t>(v * kSize));
            }
            for (const Case& c : cases) {
                std::vector<float> out(in.size() + 1, 7.0f);
                c.batch(count, in.data(), out.data());
                EXPECT_EQ(out.back(), 7.0f);
                for (std::size_t v = 0; v < count; ++v) {
                    const std::vector<double> x(&in[v * kSize], &in[v * kSize] + kSize);
                    std::vector<double> exact(kSize);
                    grid.apply(c.function, x.data(), exact.data());
                    for (std::size_t k = 0; k < kSize; ++k) {
                        ASSERT_NEAR(out[v * kSize + k], exact[k], 5e-6 * std::abs(exact[0]));
                    }
                }
                c.batch(count, in.data(), out.data());
                auto in_place = in;
                c.batch(count, in_place.data(), in_place.data());
                EXPECT_TRUE(std::equal(in_place.begin(), in_place.end(), out.begin()));
            }
        }
    }
}

TEST(ShGrid, LogarithmUndoesTheExponential) {
    const auto in = positive_function(6, 50);
    const ShGrid grid(6);
    std::vector<double> f(in), back(36);
    // Small enough for exp(f) to be of order 6 but for 1e-4.
    for (std::size_t k = 1; k < 36; ++k) f[k] *= 0.2;
    grid.apply([](double value) { return std::exp(value); }, f.data(), back.data());
    grid.apply([](double value) { return std::log(value); }, back.data(), back.data());
    for (std::size_t k = 0; k < 36; ++k) EXPECT_NEAR(back[k], f[k], 1e-3) << k;
}

TEST(ShGrid, NanStaysNanAndInItsVector) {
    const ShGrid grid(3);
    std::vector<float> in(5 * 9, 0.25f), one(9, 0.25f);
    in[2 * 9 + 4] = std::numeric_limits<float>::quiet_NaN();
    const auto expect = [&](const auto& function) {
        std::vector<float> out(in.size()), alone(9);
        function(5, in.data(), out.data());
        function(1, one.data(), alone.data());
        for (std::size_t k = 0; k < out.size(); ++k) {
            if (k / 9 == 2) {
                EXPECT_TRUE(std::isnan(out[k])) << k;
            } else {
                EXPECT_EQ(out[k], alone[k % 9]) << k;
            }
        }
    };
    expect([&](std::size_t n, const float* a, float* b) { grid.exponential(n, a, b); });
    expect([&](std::size_t n, const float* a, float* b) { grid.logarithm(n, 1e-3f, a, b); });
    expect([&](std::size_t n, const float* a, float* b) { grid.clamp(n, 0, 1, a, b); });
}

TEST(ShGrid, RefusesWhatIsOutsideItsDomain) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> memory(36);
    const ShGrid grid(6);
    EXPECT_THROW(ShGrid(0), Error);
    EXPECT_THROW(ShGrid(-1, 3), Error);
    EXPECT_THROW(ShGrid(6, 5), Error);
    EXPECT_THROW(ShGrid(6, -1), Error);
    const int largest = std::numeric_limits<int>::max();
    for (const auto& [order, rows] : {std::pair{65, 0}, {largest, 0}, {1, largest}, {255, 382}}) {
        try {
            ShGrid(order, rows);
            ADD_FAILURE() << order << " " << rows;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::memory) << error.what();
        }
    }
    EXPECT_THROW(grid.logarithm(1, HUGE_VALF, memory.data(), memory.data()), Error);
    EXPECT_THROW(grid.logarithm(1, 0, memory.data(), memory.data()), Error);
    EXPECT_THROW(grid.logarithm(1, nan, memory.data(), memory.data()), Error);
    EXPECT_THROW(grid.clamp(1, 1, 0, memory.data(), memory.data()), Error);
    EXPECT_THROW(grid.clamp(1, nan, 0, memory.data(), memory.data()), Error);
}

}  // namespace
}  // namespace airlight
