// SPDX-License-Identifier: Apache-2.0
// Rays of view that the fast engine takes together, and what it counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "medium/particles.h"
#include "viewer/effects.h"
#include "viewer/lamp_shadow_map.h"
#include "viewer/ray_path.h"
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
    bool bent = false;    ///< it met slabs: direction and distance are those of its last piece
    WorldHit hit;
    /// Place in the hit triangle, as World::hit_at() takes it.
    std::uint32_t triangle = 0;
    float u = 0, v = 0;
    glm::dvec3 from{0};           ///< the hit, lifted off the surface
    glm::dvec3 transmittance{1};  ///< to where it ends
};

/// Where the light of a block's rays is added: those of a pixel share a sum.
struct RaySums {
    LayeredRadiance* sums = nullptr;
    std::array<std::uint32_t, RayColumns::kSize> number{};  ///< by ray

    LayeredRadiance& operator[](std::size_t ray) const { return sums[number[ray]]; }
};

/// Rays from the camera and room for vectors of floats.
struct FastBlock {
    static constexpr std::size_t kRays = RayColumns::kSize, kCells = 1024;

    struct Cell {
        bool known = false;
        std::int64_t x = 0, y = 0, z = 0;
        Particle particle;
    };

    glm::dvec3 origin{0};
    std::vector<FastRay> rays;
    std::vector<std::uint32_t> hits;  ///< rays that meet a surface
    RayColumns straight;              ///< the rays, but for bent ones: written once they are traced
    std::vector<LitPart> lit;
    std::array<std::vector<float>, 5> columns;
    std::vector<Cell> cells;
    std::vector<glm::dvec3> points;
    std::vector<std::uint8_t> blocked;

    void write_columns() {
        straight.count = rays.size();
        for (std::size_t i = 0; i < kRays; ++i) {
            const bool asked = i < rays.size() && !rays[i].bent;
            straight.distance[i] = asked ? static_cast<float>(rays[i].distance) : 0;
            if (!asked) continue;
            straight.x[i] = static_cast<float>(rays[i].direction.x);
            straight.y[i] = static_cast<float>(rays[i].direction.y);
            straight.z[i] = static_cast<float>(rays[i].direction.z);
        }
    }

    /// The particle of a cell, remembered: neighbouring rays pass the same cells.
    const Particle& particle(const std::int64_t cell[3], const ParticleOptions& options) {
        if (cells.empty()) cells.resize(kCells);
        const auto hash = static_cast<std::uint64_t>(cell[0] + 16 * cell[1] + 256 * cell[2]);
        Cell& found = cells[hash % kCells];
        if (!found.known || found.x != cell[0] || found.y != cell[1] || found.z != cell[2]) {
            found = {true, cell[0], cell[1], cell[2],
                     particle_in_cell(cell[0], cell[1], cell[2], options)};
        }
        return found.particle;
    }

    std::vector<RayPath> paths;  ///< of the rays that slabs bend, in their order
};

}  // namespace airlight
