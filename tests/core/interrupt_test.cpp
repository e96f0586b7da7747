// SPDX-License-Identifier: Apache-2.0
#include "core/interrupt.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "core/parallel.h"
#include "core/progress.h"

namespace airlight {
namespace {

/// The signal that ended a child which ran `body`, or its exit status.
template <class Body>
int end_of_child(const Body& body) {
    const pid_t child = fork();
    if (child == 0) {
        body();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(Interrupt, TheFirstSignalIsNotedWhileGuarded) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const InterruptGuard guard;
        EXPECT_NO_THROW(throw_if_interrupted());
        std::raise(signal);
        EXPECT_EQ(noted_signal(), signal);
        try {
            throw_if_interrupted();
            ADD_FAILURE();
        } catch (const Interrupted& interrupted) {
            EXPECT_EQ(interrupted.signal(), signal);
        }
    }
    EXPECT_EQ(noted_signal(), 0);
}

TEST(Interrupt, TheSecondSignalEndsTheProcess) {
    EXPECT_EQ(end_of_child([] {
                  const InterruptGuard guard;
                  std::raise(SIGINT);
                  std::raise(SIGINT);
              }),
              -SIGINT);
}

TEST(Interrupt, IgnoredSignalsStayIgnoredAndHandlersComeBack) {
    EXPECT_EQ(end_of_child([] {
                  std::signal(SIGHUP, SIG_IGN);
                  {
                      const InterruptGuard guard;
                      std::raise(SIGHUP);
                      if (noted_signal() != 0) _exit(1);
                  }
                  std::raise(SIGHUP);
                  std::raise(SIGTERM);
              }),
              -SIGTERM);
}

TEST(Interrupt, EndingBySignalIsSeenAsOne) {
    EXPECT_EQ(end_of_child([] {
                  const InterruptGuard guard;
                  std::raise(SIGTERM);
                  end_by_signal(noted_signal());
              }),
              -SIGTERM);
}

TEST(Interrupt, TicksOfAnInterruptibleProgressEndParallelLoops) {
    const InterruptGuard guard;
    ProgressOptions options;
    options.quiet = options.interruptible = true;
    Progress progress("work", 1000, options);
    std::atomic<int> blocks{0};
    EXPECT_THROW(parallel_blocks(1000, 1,
                                 [&](std::size_t, std::size_t) {
                                     if (++blocks == 10) std::raise(SIGINT);
                                     progress.tick();
                                 }),
                 Interrupted);
    EXPECT_LT(blocks, 1000);
    Progress deaf("work", 10, {true});
    EXPECT_NO_THROW(deaf.tick());
}

}  // namespace
}  // namespace airlight
