// SPDX-License-Identifier: Apache-2.0
#include "core/memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

namespace airlight {
namespace {

TEST(Memory, ThePeakRisesWithTouchedMemoryAndStays) {
    constexpr std::size_t kBytes = std::size_t{64} << 20;
    const std::size_t before = peak_memory();
    ASSERT_GT(before, std::size_t{1} << 20);
    {
        const std::unique_ptr<char[]> block(new char[kBytes]);
        std::memset(block.get(), 1, kBytes);
        volatile char keep = block[kBytes / 2];
        static_cast<void>(keep);
    }
    // Other pages may leave meanwhile, so not the whole block shows.
    EXPECT_GE(peak_memory(), before + kBytes * 3 / 4);
    // A sanitizer keeps shadow bytes beside each.
    EXPECT_LT(peak_memory(), before + 8 * kBytes);
}

}  // namespace
}  // namespace airlight
