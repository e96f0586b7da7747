// SPDX-License-Identifier: Apache-2.0
#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/interrupt.h"

namespace airlight {
namespace {

constexpr std::chrono::nanoseconds kBetweenDraws = std::chrono::milliseconds(100);
constexpr int kBarWidth = 24;
constexpr std::string_view kEraseLine = "\r\x1b[K";

bool is_drawable(int descriptor) {
    const char* term = std::getenv("TERM");
    return isatty(descriptor) == 1 && (term == nullptr || std::string_view(term) != "dumb");
}

// The bar is an ornament: a terminal that went away must not stop the work.
void put(int descriptor, std::string_view text) {
    [[maybe_unused]] const ssize_t written = write(descriptor, text.data(), text.size());
}

}  // namespace

Progress::Progress(std::string label, std::uint64_t total, const ProgressOptions& options)
    : label_(std::move(label)),
      total_(total),
      descriptor_(options.descriptor),
      visible_(!options.quiet && total > 0 && is_drawable(options.descriptor)),
      interruptible_(options.interruptible),
      before_(options.before),
      done_(options.before),
      next_draw_(kBetweenDraws.count()) {}

Progress::~Progress() {
    if (drawn_) put(descriptor_, kEraseLine);
}

void Progress::tick(std::uint64_t steps) {
    if (interruptible_) throw_if_interrupted();
    const std::uint64_t done = done_.fetch_add(steps, std::memory_order_relaxed) + steps;
    if (!visible_) return;
    const Clock::time_point now = Clock::now();
    const std::int64_t elapsed = std::chrono::nanoseconds(now - start_).count();
    std::int64_t due = next_draw_.load(std::memory_order_relaxed);
    if (elapsed < due ||
        !next_draw_.compare_exchange_strong(due, elapsed + kBetweenDraws.count())) {
        return;
    }
    draw(now, done);
}

void Progress::draw(Clock::time_point now, std::uint64_t done) {
    const std::lock_guard<std::mutex> lock(drawing_);
    const double fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(done - before_) / elapsed;
    const double to_do = static_cast<double>(std::max(total_, done) - done);
    const auto left = static_cast<long long>(to_do / std::max(rate, 1e-9) + 0.5);
    const int filled = static_cast<int>(fraction * kBarWidth);
    put(descriptor_,
        fmt::format("{}{} [{:#<{}}{:.<{}}] {:3.0f} %  {}:{:02} left", kEraseLine, label_, "",
                    filled, "", kBarWidth - filled, 100 * fraction, left / 60, left % 60));
    drawn_ = true;
}

}  // namespace airlight
