// SPDX-License-Identifier: Apache-2.0
// Parallel loops whose results never depend on the number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace airlight {

/// Calls body(begin, end) for consecutive blocks of `grain` indices that cover [0, count). The
/// blocks are the same for every thread count; each must write only what no other block touches.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t grain, const Body& body) {
    const std::size_t blocks = (count + grain - 1) / grain;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t b = range.begin(); b != range.end(); ++b) {
                body(b * grain, std::min(count, (b + 1) * grain));
            }
        },
        tbb::simple_partitioner());
}

/// Maps each block to a value and folds the values in block order: the same bits for any thread
/// count. `map(begin, end)` returns a T, `fold(T&, const T&)` combines.
template <class T, class Map, class Fold>
T ordered_reduce(std::size_t count, std::size_t grain, T initial, const Map& map,
                 const Fold& fold) {
    std::vector<T> parts((count + grain - 1) / grain, initial);
    parallel_blocks(count, grain, [&](std::size_t begin, std::size_t end) {
        parts[begin / grain] = map(begin, end);
    });
    for (const T& part : parts) fold(initial, part);
    return initial;
}

}  // namespace airlight
