// SPDX-License-Identifier: Apache-2.0
// Embree's handles and what its calls need around them; for sources only.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstddef>
#include <string>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace airlight::detail {

/// Rays of one call: the stream that incoherent traversal was measured fastest with.
inline constexpr std::size_t kRayPacket = 256;

/// Owns a device and a scene. Stays where it is: Embree holds its address.
struct EmbreeScene {
    EmbreeScene() = default;
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene();

    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::size_t max_memory = 0;
    std::atomic<std::ptrdiff_t> bytes{0}, peak_bytes{0};
    std::atomic<bool> over_limit{false};
};

/// Denormals count as zero while it lives, on this thread.
class FlushDenormals {
  public:
#ifdef __SSE2__
    FlushDenormals() : saved_(_mm_getcsr()) {
        _mm_setcsr(saved_ | 0x8040);
    }
    ~FlushDenormals() {
        _mm_setcsr(saved_);
    }

  private:
    unsigned saved_;

  public:
#else
    FlushDenormals() {}
#endif
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
};

/// The context of rays that go anywhere.
inline RTCIntersectContext incoherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

}  // namespace airlight::detail
