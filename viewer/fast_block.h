// SPDX-License-Identifier: Apache-2.0
// Rays of view that the fast engine takes together, and what it counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "viewer/effects.h"
#include "viewer/world.h"

namespace airlight {

/// What the fast engine evaluated.
struct FastCounts {
    std::uint64_t rays = 0;         ///< of view
    std::uint64_t shadow_rays = 0;  ///< to lamps, and what else was traced
    std::uint64_t tables = 0;       ///< built before the first ray
    /// How often each effect was evaluated: once for a ray or surface point and lamp or map.
    std::array<std::uint64_t, kEffectCount> effects{};

    std::uint64_t& operator[](Effect effect) { return effects[static_cast<std::size_t>(effect)]; }
    std::uint64_t operator[](Effect effect) const {
        return effects[static_cast<std::size_t>(effect)];
    }
    FastCounts& operator+=(const FastCounts& other) {
        rays += other.rays;
        shadow_rays += other.shadow_rays;
        tables += other.tables;
        for (std::size_t i = 0; i < kEffectCount; ++i) effects[i] += other.effects[i];
        return *this;
    }
};

/// A straight ray of view.
struct FastRay {
    glm::dvec3 direction{0};
    double distance = 0;  ///< to what it ends at; inf where it ends at nothing
    bool meets = false;   ///< it ends at a surface: `hit`
    bool slow = false;    ///< it meets a slab, which others see to
    WorldHit hit;
    glm::dvec3 from{0};           ///< the hit, lifted off the surface
    glm::dvec3 transmittance{1};  ///< to where it ends
};

/// Rays from the camera and room for vectors of floats.
struct FastBlock {
    static constexpr std::size_t kRays = 256;

    glm::dvec3 origin{0};
    std::vector<FastRay> rays;
    std::vector<std::uint32_t> hits;  ///< rays that meet a surface
    std::array<std::vector<float>, 5> columns;
    std::vector<glm::dvec3> points;
    std::vector<std::uint8_t> blocked;
};

}  // namespace airlight
