// SPDX-License-Identifier: Apache-2.0
// Measuring contenders side by side: one round runs each of them once, ratios are within a round.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace airlight {

struct Seconds {
    double wall = 0, cpu = 0;
};

inline double clock_seconds(clockid_t clock) {
    timespec time = {};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The time of one call, and the CPU time of the whole process meanwhile.
template <class Run>
Seconds measure(const Run& run) {
    const double wall = clock_seconds(CLOCK_MONOTONIC);
    const double cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    run();
    return {clock_seconds(CLOCK_MONOTONIC) - wall, clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

/// NaN-free values, at least one.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace airlight
