// SPDX-License-Identifier: Apache-2.0
// Ending long work when the user or the system asks for it (Ctrl-C, SIGTERM, a closed terminal).
#pragma once

#include <stdexcept>
#include <string>

namespace airlight {

/// Work ended early because a signal asked for it; main ends the process by that signal, which a
/// shell shows as 128 + its number.
class Interrupted : public std::runtime_error {
  public:
    explicit Interrupted(int signal, const std::string& message = "interrupted")
        : std::runtime_error(message), signal_(signal) {}
    int signal() const { return signal_; }

  private:
    int signal_;
};

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is only noted, for throw_if_interrupted();
/// the second acts as ever. Signals that the process ignores stay ignored. One at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

/// The number of the signal that was noted, or 0. From any thread; costs a load.
int noted_signal();

/// Throws Interrupted when a signal was noted.
void throw_if_interrupted();

/// Ends the process by a signal, as if nothing had caught it.
[[noreturn]] void end_by_signal(int signal);

}  // namespace airlight
