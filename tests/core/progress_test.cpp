// SPDX-License-Identifier: Apache-2.0
#include "core/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace airlight {
namespace {

/// A terminal that remembers what was drawn on it.
class Terminal {
  public:
    Terminal() {
        setenv("TERM", "xterm", 1);
        master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
        if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) return;
        terminal_ = open(ptsname(master_), O_RDWR | O_NOCTTY);
    }
    ~Terminal() {
        close(terminal_);
        close(master_);
    }
    int descriptor() const { return terminal_; }
    std::string text() const {
        std::string all(65536, '\0');
        const ssize_t got = read(master_, all.data(), all.size());
        all.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return all;
    }

  private:
    int master_ = -1;
    int terminal_ = -1;
};

TEST(Progress, DrawsShareAndTimeLeftAndErasesItself) {
    const Terminal terminal;
    ASSERT_GE(terminal.descriptor(), 0);
    {
        Progress progress("fog", 4, {false, terminal.descriptor()});
        EXPECT_TRUE(progress.visible());
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
        progress.tick(1);
    }
    const std::string text = terminal.text();
    EXPECT_NE(text.find("fog [######..................]  25 %  0:00 left"), std::string::npos)
        << text;
    EXPECT_EQ(text.substr(text.size() - 4), "\r\x1b[K");
}

TEST(Progress, BeginsWhereAnEarlierProcessEnded) {
    const Terminal terminal;
    ASSERT_GE(terminal.descriptor(), 0);
    ProgressOptions options;
    options.descriptor = terminal.descriptor();
    options.before = 800000;
    Progress progress("bake", 1000000, options);
    EXPECT_EQ(progress.done(), 800000u);
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    progress.tick(100);
    const std::string text = terminal.text();
    EXPECT_NE(text.find(" 80 % "), std::string::npos) << text;
    // 199900 ticks to come at 100 in 0.12 s or more; of all that is done they would be 0.03 s.
    EXPECT_EQ(text.find("0:00 left"), std::string::npos) << text;
}

TEST(Progress, DrawsSeldomHoweverOftenItTicks) {
    const Terminal terminal;
    const auto start = std::chrono::steady_clock::now();
    {
        Progress progress("fog", 1000000, {false, terminal.descriptor()});
        for (int i = 0; i < 1000000; ++i) progress.tick();
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::size_t draws = 0;
    const std::string text = terminal.text();
    for (std::size_t at = 0; (at = text.find('[', at)) != std::string::npos; ++at) ++draws;
    // Each draw has two brackets (one belongs to the erasing), and the end one more.
    EXPECT_LE(draws, 2 * (seconds / 0.1 + 1) + 1);
}

TEST(Progress, IsSilentAwayFromATerminalAndWhenQuiet) {
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_NONBLOCK), 0);
    const Terminal terminal;
    {
        Progress to_pipe("fog", 2, {false, ends[1]});
        Progress quiet("fog", 2, {true, terminal.descriptor()});
        Progress empty("fog", 0, {false, terminal.descriptor()});
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
        to_pipe.tick();
        quiet.tick();
        empty.tick();
    }
    char byte = 0;
    EXPECT_EQ(read(ends[0], &byte, 1), -1);
    EXPECT_EQ(terminal.text(), "");
    close(ends[0]);
    close(ends[1]);
}

TEST(Progress, CountsTicksOfAllThreads) {
    Progress progress("fog", 40000, {true});
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
            for (int i = 0; i < 10000; ++i) progress.tick();
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(progress.done(), 40000u);
}

}  // namespace
}  // namespace airlight
