// SPDX-License-Identifier: Apache-2.0
#include "sh/triple_product.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "sh/index.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

TEST(TripleProducts, MatchGoldenValues) {
    const TripleProducts small(8), large(16);
    double worst = 0, worst_large = 0;
    for (const auto& row : reference_rows("triple_products.csv", 4, 765)) {
        const auto i = static_cast<std::size_t>(row[0]), j = static_cast<std::size_t>(row[1]);
        const auto k = static_cast<std::size_t>(row[2]);
        const double error = std::abs(large.at(i, j, k) - row[3]);
        worst_large = std::max(worst_large, error);
        if (row[3] == 0) {
            EXPECT_EQ(large.at(i, j, k), 0);
        }
        if (std::max({i, j, k}) >= 64) continue;
        worst = std::max(worst, std::abs(small.at(i, j, k) - row[3]));
        EXPECT_NEAR(small.at(i, j, k), row[3], 1e-15) << i << " " << j << " " << k;
    }
    EXPECT_LT(worst_large, 3e-15);
    RecordProperty("order_8", std::to_string(worst * 1e18) + "e-18");
    RecordProperty("order_16", std::to_string(worst_large * 1e18) + "e-18");
}

TEST(TripleProducts, AreAsManyAsTheLiteratureCounts) {
    constexpr std::array<std::array<std::size_t, 3>, 5> kCounts = {
        {{3, 83, 25}, {4, 353, 77}, {5, 1158, 238}, {6, 2907, 549}, {8, 12868, 2300}}};
    for (const auto& [order, all, distinct] : kCounts) {
        const TripleProducts triples(static_cast<int>(order));
        EXPECT_EQ(triples.nonzero_count(), all);
        std::size_t sorted = 0;
        for (std::size_t k = 0; k < order * order; ++k) {
            sorted += static_cast<std::size_t>(
                std::count_if(triples.begin(k), triples.end(k),
                              [&](const TripleProducts::Term& term) { return term.j <= k; }));
        }
        EXPECT_EQ(sorted, distinct);
    }
}

TEST(TripleProducts, AreSymmetricToTheLastBit) {
    const TripleProducts triples(6);
    for (std::size_t i = 0; i < 36; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t k = 0; k <= j; ++k) {
                const double value = triples.at(i, j, k);
                EXPECT_EQ(triples.at(i, k, j), value);
                EXPECT_EQ(triples.at(j, i, k), value);
                EXPECT_EQ(triples.at(j, k, i), value);
                EXPECT_EQ(triples.at(k, i, j), value);
                EXPECT_EQ(triples.at(k, j, i), value);
            }
        }
    }
}

TEST(TripleProducts, RefuseOrdersTheyCannotHold) {
    const auto code = [](int order) {
        try {
            TripleProducts triples(order);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::io;
    };
    EXPECT_EQ(code(0), ErrorCode::usage);
    EXPECT_EQ(code(-3), ErrorCode::usage);
    EXPECT_EQ(code(256), ErrorCode::usage);
    EXPECT_EQ(code(100), ErrorCode::memory);
}

}  // namespace
}  // namespace airlight
