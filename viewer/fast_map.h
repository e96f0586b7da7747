// SPDX-License-Identifier: Apache-2.0
// Light of the environment as the fast engine sums it: behind, in media, and on surfaces.
//
// To media that are the same everywhere the map's pixels are points of light at its distance D
// from the receiver (viewer/reference.h). What they scatter before the map is the foggy map itself
// (envmap/fog.h); before a surface at the distance d it is the map's bands times those of the
// point spread function of a path that ends there, T^2 airlight(gamma, T, sigma_t d), T = sigma_t D
// ([Sun05] eq. 10 with [Zhou07] sec. 4.2). To other media the map is infinitely far: their source
// is the map's mean, weighed by the phase function, dimmed by the depth averaged over all
// directions ([Zhou07] eq. 26), along a ray in a few steps.
//
// Surfaces get the map's bands times e^-T (1 + albedo T Lambda_l(T)) and times the bands of their
// lobe, about the normal or the mirrored view: tables of directions, one for each lobe and a few
// depths of the media that are not the same everywhere. No object shades it; .prt files do that
// (viewer/fast_transfer.h).
//
// Deviates: [Zhou07] eq. 27 takes the point spread function for all media. Media that end scatter
// a map that is infinitely far evenly, which adds their light to degree 0 alone.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "envmap/image.h"
#include "viewer/fast_block.h"
#include "viewer/fast_methods.h"
#include "viewer/fast_transfer.h"
#include "viewer/medium_grid.h"
#include "viewer/plan.h"
#include "viewer/sphere_table.h"
#include "viewer/surface_lobes.h"

namespace airlight {

/// Degree l of channel c of `bands` (3, n^2), times factors[c * order + l], as a table of
/// directions; what is negative becomes 0.
SphereTable filtered_map(const std::vector<double>& bands, int order, int nodes,
                         const std::vector<double>& factors);

class FastMap {
  public:
    /// Builds what the plan calls for and counts it. World, plan and methods stay where they are.
    FastMap(const World& world, const Plan& plan, const FastMethods& methods, FastCounts& counts);

    /// Adds the map itself where rays end at it, to the layer direct.
    void show(FastBlock& block, const RaySums& out) const;
    /// Adds what media scatter of it along rays.
    void light_media(FastBlock& block, const RaySums& out, FastCounts& counts) const;
    /// Radiance of it that the medium of a slab sends along a piece of a ray in it: as if the map's
    /// mean came through six sides.
    glm::dvec3 light_slab(const RayPiece& piece, FastCounts& counts) const;
    /// Adds its light on the surfaces that the rays end at.
    void light_surfaces(FastBlock& block, const RaySums& out, FastCounts& counts) const;

  private:
    static constexpr std::size_t kNoLobe = static_cast<std::size_t>(-1);

    void build_surfaces(FastCounts& counts);
    void build_media(FastCounts& counts);
    std::vector<double> endless_bands(double distance, int order) const;
    glm::dvec3 of_lobe(std::size_t lobe, const glm::dvec3& to_map,
                       const glm::vec3& mean_depth) const;
    glm::dvec3 before_surface(const glm::dvec3& to_map, double distance) const;
    glm::dvec3 along(const FastRay& ray, const glm::dvec3& origin) const;

    const World& world_;
    const Plan& plan_;
    const FastMethods& methods_;
    std::vector<double> bands_;     ///< (3, order^2), in the map's own world frame
    glm::dvec3 uniform_{0};         ///< extinction of the media that are the same everywhere [1/m]
    bool limited_ = false;          ///< there are others
    glm::dvec3 limited_albedo_{0};  ///< of the others, their mean
    MediumGrid grid_;               ///< likewise

    Image scattered_;                  ///< by endless media, before the map; empty without
    std::vector<double> path_ends_;    ///< distances
    std::vector<SphereTable> paths_;   ///< radiance over 1 - e^-T, of rays that end there
    std::vector<SphereTable> source_;  ///< the map by limited media's phases over its mean

    std::vector<FastTransfer> baked_;                      ///< by object
    std::vector<SurfaceLobes> materials_;                  ///< by object
    std::vector<std::size_t> diffuse_lobe_, glossy_lobe_;  ///< likewise
    std::vector<double> depth_levels_;                     ///< of limited media, ascending from 0
    std::vector<std::vector<SphereTable>> lobes_;          ///< (lobe, level)
};

}  // namespace airlight
