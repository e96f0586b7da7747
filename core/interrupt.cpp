// SPDX-License-Identifier: Apache-2.0
#include "core/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <iterator>

namespace airlight {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may store it");
std::atomic<int> noted{0};
std::atomic<bool> guarded{false};
struct sigaction before[std::size(kSignals)];

extern "C" void note_signal(int signal) {
    noted.store(signal, std::memory_order_relaxed);
}

}  // namespace

InterruptGuard::InterruptGuard() {
    [[maybe_unused]] const bool second = guarded.exchange(true);
    assert(!second);
    noted = 0;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
        sigaction(kSignals[i], nullptr, &before[i]);
        if (before[i].sa_handler == SIG_IGN) continue;
        struct sigaction action = {};
        action.sa_handler = note_signal;
        // Reset by the first signal, so that the next one ends a process that does not listen.
        action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
        sigemptyset(&action.sa_mask);
        sigaction(kSignals[i], &action, nullptr);
    }
}

InterruptGuard::~InterruptGuard() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
        sigaction(kSignals[i], &before[i], nullptr);
    }
    noted = 0;
    guarded = false;
}

int noted_signal() {
    return noted.load(std::memory_order_relaxed);
}

void throw_if_interrupted() {
    if (const int signal = noted_signal(); signal != 0) throw Interrupted(signal);
}

void end_by_signal(int signal) {
    struct sigaction action = {};
    action.sa_handler = SIG_DFL;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, signal);
    sigprocmask(SIG_UNBLOCK, &only, nullptr);
    raise(signal);
    _exit(128 + signal);
}

}  // namespace airlight
