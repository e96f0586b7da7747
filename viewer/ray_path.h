// SPDX-License-Identifier: Apache-2.0
// A ray of view through slabs, bent at their surfaces.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "viewer/world.h"

namespace airlight {

/// A straight part of it, in one slab or outside all (null).
struct RayPiece {
    glm::dvec3 origin{0}, direction{0};
    double distance = 0;
    const Slab* slab = nullptr;
    /// Of radiance, from where the piece begins to where the ray does: surfaces and media.
    glm::dvec3 throughput{1};
};

struct RayPath {
    std::vector<RayPiece> pieces;
    std::optional<WorldHit> hit;  ///< what it ends at; nothing: the map, or nothing at all
    glm::dvec3 throughput{1};     ///< of what it ends at; 0 where it was given up
    std::uint64_t rays = 0;       ///< traced
};

/// At a surface it goes on refracted, with the transmittance of Fresnel and the factor ior^-2 or
/// ior^2 of radiance; where all is reflected, it goes on reflected. What is reflected in part is
/// left out. It is given up after kMostPieces, as is one caught by total reflection, and where it
/// has under 1e-9 left. Without slabs one piece. Unless `attenuate`, media dim nothing.
RayPath follow_ray(const World& world, const glm::dvec3& origin, const glm::dvec3& direction,
                   bool attenuate = true);

inline constexpr std::size_t kMostPieces = 32;

}  // namespace airlight
