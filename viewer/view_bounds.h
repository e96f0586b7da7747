// SPDX-License-Identifier: Apache-2.0
// Bounds on what lamps and media can add to any pixel of a picture, without a ray being traced.
//
// All of them follow from the single scattering integral of viewer/reference.h with the
// transmittances in it taken as 1 at most.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "viewer/scene.h"
#include "viewer/world.h"

namespace airlight {

/// The cone around all rays of view.
class ViewCone {
  public:
    ViewCone(const Camera& camera, int width, int height);

    /// The least angle between a ray of view and the way to a point; 0 within the cone.
    double angle_to(const glm::dvec3& point) const;
    /// The least distance of a point from all rays of view.
    double distance_to(const glm::dvec3& point) const;
    /// At most the mean over any pixel of int_0^inf dt / |x(t) - point|^2 [1/m]. For one ray that
    /// is (pi - gamma) / (D sin gamma); a pixel that the point may lie in counts as a disc of the
    /// least pixel's solid angle around it, which has the largest mean.
    double glow(const glm::dvec3& point) const;
    /// At most the mean over any pixel of (pi - gamma) / (4 pi sin gamma), gamma from a direction.
    double glow_of_direction() const;
    /// A lower bound on the distance of a point from the convex hull of the cone and `others`.
    double distance_to_hull(const glm::dvec3& point, const std::vector<glm::dvec3>& others) const;

  private:
    glm::dvec3 origin_, axis_;
    double half_angle_;
    double pixel_radius_;  ///< of a disc of the least pixel's solid angle [rad]
    double unevenness_;    ///< how much more of a pixel's area than of its solid angle a part has
};

/// Bounds for one medium, or one blob of it, lit by the lamps. Of channels the largest.
struct MediumBounds {
    double view_depth = 0;  ///< optical depth from the camera to surfaces or the map
    double lamp_depth = 0;  ///< from lamps and map to what they light
    double air_depth = 0;   ///< along all that rays of view pass, +inf for fog without end
    /// Radiance of a pixel, lamp by lamp: scattered along rays of view, and by surfaces that the
    /// medium lights.
    std::vector<double> airlight, surface;
    double airlight_environment = 0, surface_environment = 0;  ///< likewise, the map

    /// Everything that leaving the medium out changes, over `level`: what it sends, and what others
    /// bring that it no longer takes; `alone` where no other medium sends anything.
    double total(double level, bool alone) const;
    MediumBounds& operator+=(const MediumBounds& other);
};

/// The geometry of a scene as bounds need it.
class ViewBounds {
  public:
    /// Takes a pass over the environment map, if there is one.
    ViewBounds(const World& world, int width, int height);

    /// Of any medium but a slab; Gaussians as the sum of their blobs.
    MediumBounds of_medium(const SceneMedium& medium) const;
    MediumBounds of_blob(const SceneGaussians& medium, const ScenePhase& phase,
                         const GaussianBlob& blob) const;
    const ViewCone& cone() const { return cone_; }

  private:
    std::optional<SceneBox> region(const SceneMedium& medium, const SceneBox& box) const;
    void add_lamps(const glm::dvec3& scattering, double phase,
                   const std::optional<SceneBox>& within, MediumBounds& bounds) const;

    const World& world_;
    ViewCone cone_;
    std::vector<glm::dvec3> lamps_;
    SceneBox seen_;        ///< camera, surfaces and lamps, and what the map shines through
    SceneBox along_rays_;  ///< all that rays of view pass
    double longest_view_ = 0, longest_lamp_ = 0;  ///< ways [m]
    double reach_ = 0;                            ///< of the map [m], 0 without one
    std::vector<double> lamp_to_surface_;         ///< least distances [m]; inf without surfaces
    double most_reflected_ = 0;  ///< the largest value of any surface's reflect() [1/sr]
    double map_brightest_ = 0, map_power_ = 0;  ///< its radiance, and that over all directions
};

/// The largest value of a phase function [1/sr].
double most_of_phase(const PhaseFunction& phase);

}  // namespace airlight
