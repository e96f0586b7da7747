// SPDX-License-Identifier: Apache-2.0
// A progress bar on the terminal.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace airlight {

struct ProgressOptions {
    bool quiet = false;
    int descriptor = 2;  ///< where it draws, only if that is a terminal
    /// Ticks of the total that an earlier process did; the time left does not count on them.
    std::uint64_t before = 0;
    bool interruptible = false;  ///< tick() throws Interrupted after a signal (core/interrupt.h)
};

/// "fog [#####.......]  42 %  0:07 left": drawn at most ten times a second, and erased by the
/// destructor. Away from a terminal it draws nothing.
class Progress {
  public:
    /// `total` is the number of ticks in all; 0 draws nothing.
    Progress(std::string label, std::uint64_t total, const ProgressOptions& options = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Counts work done. From any thread; costs one atomic addition and, when drawing, a look at
    /// the clock.
    void tick(std::uint64_t steps = 1);

    std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }
    bool visible() const { return visible_; }

  private:
    using Clock = std::chrono::steady_clock;
    void draw(Clock::time_point now, std::uint64_t done);

    const std::string label_;
    const std::uint64_t total_;
    const int descriptor_;
    const bool visible_;
    const bool interruptible_;
    const std::uint64_t before_;
    const Clock::time_point start_ = Clock::now();
    std::atomic<std::uint64_t> done_;
    std::atomic<std::int64_t> next_draw_{0};  ///< nanoseconds after start_
    std::mutex drawing_;
    bool drawn_ = false;
};

}  // namespace airlight
