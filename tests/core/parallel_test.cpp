// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/threads.h"

namespace airlight {
namespace {

double sum_of_roots(std::size_t count) {
    return ordered_reduce<double>(
        count, 100, 0.0,
        [](std::size_t begin, std::size_t end) {
            double sum = 0;
            for (std::size_t i = begin; i < end; ++i)
                sum += std::sqrt(static_cast<double>(i) + 0.1);
            return sum;
        },
        [](double& sum, double part) { sum += part; });
}

TEST(Parallel, BlocksCoverEveryIndexOnce) {
    for (const std::size_t count : {0, 1, 99, 100, 101, 12345}) {
        std::vector<std::atomic<int>> visits(count);
        parallel_blocks(count, 100, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(begin % 100, 0u);
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& visit : visits) ASSERT_EQ(visit, 1);
    }
}

TEST(Parallel, SumsHaveTheSameBitsForEveryThreadCount) {
    const double expected = [] {
        const ThreadLimit one(1);
        return sum_of_roots(54321);
    }();
    EXPECT_NEAR(expected, 2.0 / 3 * std::pow(54321, 1.5), 1e-4 * expected);
    for (const int threads : {2, 3, 7, 0}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(sum_of_roots(54321), expected) << threads;
    }
}

TEST(Parallel, AThreadLimitHoldsWhileItLives) {
    const int before = thread_count();
    {
        const ThreadLimit limit(1);
        EXPECT_EQ(thread_count(), 1);
    }
    EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace airlight
