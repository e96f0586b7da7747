// SPDX-License-Identifier: Apache-2.0
#include "core/checked.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"

namespace airlight {
namespace {

constexpr std::size_t kLargest = std::numeric_limits<std::size_t>::max();

template <class Function>
std::string memory_error(const Function& function) {
    try {
        function();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::memory);
        return error.describe();
    }
    return "no error";
}

TEST(Checked, SumsAndProductsUpToTheLargestSizeAreExact) {
    EXPECT_EQ(checked_add(kLargest - 1, 1, "x"), kLargest);
    EXPECT_EQ(checked_multiply(kLargest, 1, "x"), kLargest);
    EXPECT_EQ(checked_multiply(kLargest / 3, 3, "x"), kLargest / 3 * 3);
    EXPECT_EQ(checked_multiply(0, kLargest, "x"), 0u);
    EXPECT_EQ(checked_product({2, 3, 7}, "x"), 42u);
    EXPECT_EQ(checked_product({}, "x"), 1u);
    EXPECT_EQ(checked_product({kLargest, kLargest, 0}, "x"), 0u);
}

TEST(Checked, OneMoreThanTheLargestIsAnErrorThatNamesTheThing) {
    const std::string expected = "the map is larger than this machine can address";
    EXPECT_EQ(memory_error([] { checked_add(kLargest, 1, "the map"); }), expected);
    EXPECT_EQ(memory_error([] { checked_multiply(kLargest / 2 + 1, 2, "the map"); }), expected);
    EXPECT_EQ(memory_error([] {
                  checked_product({1000000000, 1000000000, 1000000000}, "the map");
              }),
              expected);
}

TEST(Checked, TheMemoryLimitIsInclusiveAndStated) {
    EXPECT_NO_THROW(require_memory(100, 100, "the map"));
    EXPECT_EQ(memory_error([] {
                  require_memory(std::size_t{3} << 30, kDefaultMaxMemory, "the map", "a.exr");
              }),
              "a.exr: the map needs 3 GiB, more than the limit of 2 GiB (--max-memory)");
}

TEST(Checked, BytesAreReadable) {
    EXPECT_EQ(format_bytes(0), "0 bytes");
    EXPECT_EQ(format_bytes(1023), "1023 bytes");
    EXPECT_EQ(format_bytes(1536), "1.5 KiB");
    EXPECT_EQ(format_bytes(1023 * 1024), "0.999 MiB");
    EXPECT_EQ(format_bytes(kLargest), "16 EiB");
}

}  // namespace
}  // namespace airlight
