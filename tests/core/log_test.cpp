// SPDX-License-Identifier: Apache-2.0
#include "core/log.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

namespace airlight {
namespace {

std::string logged(int verbosity) {
    testing::internal::CaptureStderr();
    set_up_log(verbosity);
    spdlog::error("e");
    spdlog::warn("w {}", 1);
    spdlog::info("i");
    spdlog::debug("d");
    return testing::internal::GetCapturedStderr();
}

TEST(Log, EachStepOfVerbosityLetsOneMoreLevelThrough) {
    EXPECT_EQ(logged(-1), "airlight: error: e\n");
    EXPECT_EQ(logged(0), "airlight: error: e\nairlight: warning: w 1\n");
    EXPECT_EQ(logged(1), "airlight: error: e\nairlight: warning: w 1\nairlight: info: i\n");
    EXPECT_EQ(
        logged(2),
        "airlight: error: e\nairlight: warning: w 1\nairlight: info: i\nairlight: debug: d\n");
}

}  // namespace
}  // namespace airlight
