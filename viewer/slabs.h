// SPDX-License-Identifier: Apache-2.0
// The slabs of a scene: boxes of a medium behind surfaces that refract [Slab].
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "medium/phase_function.h"
#include "viewer/scene.h"

namespace airlight {

struct Slab {
    SceneBox box;
    double ior = 1;  ///< inside over outside
    glm::dvec3 scattering{0}, extinction{0};
    PhaseFunction phase = PhaseFunction::isotropic();
};

/// Where a ray crosses a face of a box.
struct FaceCrossing {
    double distance = 0;
    int axis = 0;
    double side = 1;  ///< the outward normal is +1 or -1 along the axis
};
/// Of a ray from outside; nothing where it misses the box or only touches it.
std::optional<FaceCrossing> entry_of(const SceneBox& box, const glm::dvec3& origin,
                                     const glm::dvec3& direction);
/// Of a ray from inside or from a face inwards.
FaceCrossing exit_of(const SceneBox& box, const glm::dvec3& origin, const glm::dvec3& direction);

/// A way on which light reaches a point in a slab.
struct SlabArrival {
    glm::dvec3 to_light{0};  ///< unit, at the point
    glm::dvec3 entry{0};  ///< where it crosses the surface; the light itself where that is inside
    double inside = 0;    ///< length within the slab
    /// Irradiance across the beam there for radiant intensity 1 [1/m^2], or for the map over
    /// irradiance across the beam outside; the surface in it, media not.
    double irradiance = 0;
};
struct SlabArrivals {
    std::array<SlabArrival, 6> ways;
    int count = 0;

    const SlabArrival* begin() const { return ways.data(); }
    const SlabArrival* end() const { return ways.data() + count; }
};

/// Ways from a point light, by Snell's law through each face that it is outside of; straight where
/// light and point are both inside, or the index is 1. 0.2 us a face.
SlabArrivals arrivals_of_point(const Slab& slab, const glm::dvec3& x, const glm::dvec3& light);
/// The same from a direction, unit, outside.
SlabArrivals arrivals_of_direction(const Slab& slab, const glm::dvec3& x,
                                   const glm::dvec3& to_light);

class SceneSlabs {
  public:
    SceneSlabs() = default;
    /// Throws Error(data), naming `path`, for slabs that overlap.
    SceneSlabs(const std::vector<SceneMedium>& media, const std::string& path);

    bool empty() const { return slabs_.empty(); }
    const std::vector<Slab>& all() const { return slabs_; }
    /// The one that holds a point in its interior; null outside all.
    const Slab* at(const glm::dvec3& x) const;
    /// Optical depth along a straight line, surfaces not regarded.
    glm::dvec3 depth(const glm::dvec3& origin, const glm::dvec3& direction, double distance) const;

  private:
    std::vector<Slab> slabs_;
};

}  // namespace airlight
