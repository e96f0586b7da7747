// SPDX-License-Identifier: Apache-2.0
// Vectors whose storage starts on a cache line, for aligned SIMD loads, and is not cleared first.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace airlight {

/// Allocator of 64-byte aligned memory. A vector's resize() leaves new numbers unset: whoever
/// resizes writes them.
template <class T>
struct AlignedAllocator {
    using value_type = T;
    AlignedAllocator() = default;
    template <class U>
    AlignedAllocator(const AlignedAllocator<U>&) {}
    T* allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        void* memory = ::operator new(bytes, alignment(bytes));
        // Strided passes over a large array live or die by the number of pages.
        if (bytes >= kHugePage) madvise(memory, bytes, MADV_HUGEPAGE);
        return static_cast<T*>(memory);
    }
    /// Leaves numbers uninitialised where a container would write zeros first.
    template <class U>
    void construct(U* pointer) {
        ::new (static_cast<void*>(pointer)) U;
    }
    template <class U, class... Arguments>
    void construct(U* pointer, Arguments&&... arguments) {
        ::new (static_cast<void*>(pointer)) U(std::forward<Arguments>(arguments)...);
    }
    void deallocate(T* pointer, std::size_t count) {
        ::operator delete(pointer, alignment(count * sizeof(T)));
    }
    friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
    friend bool operator!=(const AlignedAllocator&, const AlignedAllocator&) { return false; }

  private:
    static constexpr std::size_t kHugePage = std::size_t{2} << 20;
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t(bytes >= kHugePage ? kHugePage : 64);
    }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace airlight
