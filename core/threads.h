// SPDX-License-Identifier: Apache-2.0
// How many threads the parallel loops may use.
#pragma once

#include <tbb/global_control.h>

#include <cassert>
#include <cstddef>
#include <memory>

namespace airlight {

/// The number of threads that parallel loops may use now.
inline int thread_count() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

/// Limits the parallel loops of the whole process while it lives: `--threads N`. 0 sets no limit.
/// Of several limits at once the smallest holds. Results never depend on it.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads) {
        assert(threads >= 0);
        if (threads > 0) {
            control_ = std::make_unique<tbb::global_control>(
                tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
        }
    }

  private:
    std::unique_ptr<tbb::global_control> control_;
};

}  // namespace airlight
