// SPDX-License-Identifier: Apache-2.0
// Parallel loops whose results never depend on the number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#endif

namespace airlight {

#ifdef __SANITIZE_THREAD__
namespace detail {

// ThreadSanitizer cannot see the synchronisation inside the packaged TBB and would report every
// loop. Plain threads, which it understands, show the races of the loop bodies themselves.
template <class RunBlock>
void run_on_plain_threads(std::size_t blocks, const RunBlock& run_block) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failing;
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < std::min<std::size_t>(blocks, 4); ++t) {
        threads.emplace_back([&] {
            try {
                for (std::size_t b; (b = next++) < blocks;) run_block(b);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(failing);
                failure = std::current_exception();
                next = blocks;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace detail
#endif

/// Calls body(begin, end) for consecutive blocks of `grain` indices that cover [0, count). The
/// blocks are the same for every thread count; each must write only what no other block touches.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t grain, const Body& body) {
    const std::size_t blocks = (count + grain - 1) / grain;
    const auto run_block = [&](std::size_t b) {
        body(b * grain, std::min(count, (b + 1) * grain));
    };
#ifdef __SANITIZE_THREAD__
    detail::run_on_plain_threads(blocks, run_block);
#else
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t b = range.begin(); b != range.end(); ++b) run_block(b);
        },
        tbb::simple_partitioner());
#endif
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
