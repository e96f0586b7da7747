// SPDX-License-Identifier: Apache-2.0
// Where along a ray the light of a lamp is summed.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "viewer/medium_depths.h"
#include "viewer/scene_media.h"

namespace airlight {

/// The light of a lamp on a ray through it diverges: rays are kept off, by this times 1 + |the
/// distance to their point nearest to it|, so far that angles still tell places apart, to 1e-9 of
/// the distance.
inline constexpr double kLeastHeight = 1e-7;

/// The part of a ray in which media scatter: all of it if one of them is the same everywhere; else
/// from where the first begins, or thins out to an optical depth of 1e-8 beyond, to where the last
/// ends. Nothing where no medium is met.
std::optional<RaySpan> span_of_media(const SceneMedia& media, MediumExtent extent,
                                     const glm::dvec3& origin, const glm::dvec3& direction,
                                     double distance);

/// A finite end for such a part: no later than where all channels have an optical depth of 20 or
/// so, and, where nothing ends it, a thousand times as far as the lamp. Whether it is that depth.
bool end_of_light(const MediumDepths& depths, const glm::dvec3& lamp, const glm::dvec3& origin,
                  const glm::dvec3& direction, RaySpan& part);

struct RayNode {
    double t = 0, weight = 0;  ///< int f dt ~ sum weight f(t)
};

/// Gauss-Legendre nodes over a part of a ray, ascending, `count` of them (8, 16 or 32):
///     of a lamp nearer than kFar lengths of the part, in a variable that is half the angle at
///     which the lamp sees the ray and half an angle about the middle of `dense`, the span of
///     media that end: as mixed-glN of medium/gaussian_airlight_method.h, for rays without end;
///     else in the root of the way from where layers and atmospheres are densest, if there are
///     such, half of them on either side of it;
///     else in the way, as where `dims`: the light ends there by its depth.
void ray_nodes(const SceneMedia& media, const glm::dvec3& lamp, const glm::dvec3& origin,
               const glm::dvec3& direction, const RaySpan& part, const RaySpan& dense, bool dims,
               int count, std::vector<RayNode>& nodes);

}  // namespace airlight
