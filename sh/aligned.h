// SPDX-License-Identifier: Apache-2.0
// Vectors whose storage starts on a cache line, for aligned SIMD loads.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace airlight {

/// Allocator of 64-byte aligned memory.
template <class T>
struct AlignedAllocator {
    using value_type = T;
    AlignedAllocator() = default;
    template <class U>
    AlignedAllocator(const AlignedAllocator<U>&) {}
    T* allocate(std::size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(64)));
    }
    void deallocate(T* pointer, std::size_t) { ::operator delete(pointer, std::align_val_t(64)); }
    friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
    friend bool operator!=(const AlignedAllocator&, const AlignedAllocator&) { return false; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace airlight
