// SPDX-License-Identifier: Apache-2.0
// How long the steps of a command took, for its report.
#pragma once

#include <chrono>

namespace airlight {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace airlight
