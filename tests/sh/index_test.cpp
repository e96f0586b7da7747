// SPDX-License-Identifier: Apache-2.0
#include "sh/index.h"

#include <gtest/gtest.h>

namespace airlight {
namespace {

static_assert(sh_count(0) == 0 && sh_count(4) == 16);
static_assert(sh_index(0, 0) == 0 && sh_index(1, -1) == 1 && sh_index(1, 1) == 3);
static_assert(sh_degree(6).l == 2 && sh_degree(6).m == 0);

TEST(ShIndex, InverseUndoesIndexEverywhere) {
    std::size_t expected = 0;
    for (int l = 0; l < 300; ++l) {
        for (int m = -l; m <= l; ++m, ++expected) {
            ASSERT_EQ(sh_index(l, m), expected);
            ASSERT_EQ(sh_degree(expected).l, l);
            ASSERT_EQ(sh_degree(expected).m, m);
        }
        ASSERT_EQ(sh_count(l + 1), expected);
    }
}

TEST(ShIndex, LargeOrdersDoNotOverflow) {
    EXPECT_EQ(sh_count(46340), 2147395600u);
    for (const int l : {4095, 46339, 46340, 46341, 65535}) {
        for (const int m : {-l, -1, 0, 1, l}) {
            const ShDegree back = sh_degree(sh_index(l, m));
            EXPECT_EQ(back.l, l);
            EXPECT_EQ(back.m, m);
        }
    }
    if (sizeof(std::size_t) == 8) {
        const int largest = 2147483647 / 2;
        EXPECT_EQ(sh_degree(sh_index(largest, -largest)).l, largest);
        EXPECT_EQ(sh_degree(sh_index(largest, largest)).m, largest);
    }
}

}  // namespace
}  // namespace airlight
