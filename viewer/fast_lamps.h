// SPDX-License-Identifier: Apache-2.0
// Light of lamps as the fast engine sums it: on surfaces, onto them from the media, along rays.
#pragma once

#include <memory>
#include <vector>

#include "medium/surface_batch.h"
#include "viewer/fast_block.h"
#include "viewer/fast_methods.h"
#include "viewer/lamp_shadow_map.h"
#include "viewer/plan.h"
#include "viewer/ray_path.h"
#include "viewer/surface_lobes.h"

namespace airlight {

class FastLamps {
  public:
    /// Builds what the plan calls for and counts it. World, plan and methods stay where they are.
    FastLamps(const World& world, const Plan& plan, const FastMethods& methods, FastCounts& counts);

    /// Adds lamps on the surfaces that the block's rays end at, to the layers direct and
    /// surface_point of out[i] for ray i, dimmed on the way to the viewer.
    void light_surfaces(FastBlock& block, const RaySums& out, FastCounts& counts) const;

    /// Adds what media send along the rays, to the layers airlight_point and airlight_gaussians.
    void light_media(FastBlock& block, const RaySums& out, FastCounts& counts) const;

    /// Adds what particles send along the rays.
    void light_particles(FastBlock& block, const RaySums& out, FastCounts& counts) const;
    /// Radiance of a lamp that the medium of a slab, with what else fills it, sends along a piece
    /// of a ray in it.
    glm::dvec3 light_slab(std::size_t lamp, const RayPiece& piece, FastCounts& counts) const;

  private:
    struct Arrival;
    bool sees(std::size_t lamp, const glm::dvec3& point, FastCounts& counts) const;
    void add_direct(std::size_t lamp, FastBlock& block, std::vector<Arrival>& arrivals,
                    const RaySums& out, FastCounts& counts) const;
    void add_scattered(std::size_t lamp, FastBlock& block, const std::vector<Arrival>& arrivals,
                       const RaySums& out, FastCounts& counts) const;
    void add_rings(std::size_t lamp, FastBlock& block, const std::vector<Arrival>& arrivals,
                   const RaySums& out, FastCounts& counts) const;
    void light_uniform(std::size_t lamp, FastBlock& block, const RaySums& out,
                       FastCounts& counts) const;
    void light_fogshop(std::size_t lamp, bool others, FastBlock& block, const RaySums& out,
                       FastCounts& counts) const;
    void light_varying(std::size_t lamp, bool gaussians, bool others, FastBlock& block,
                       const RaySums& out, FastCounts& counts) const;
    void build_fogshop(FastCounts& counts);
    void find_lit(std::size_t lamp, FastBlock& block) const;
    glm::dvec3 depth(const glm::dvec3& from, const glm::dvec3& direction, double distance) const;

    const World& world_;
    const Plan& plan_;
    const FastMethods& methods_;
    std::vector<std::unique_ptr<SurfaceBatchTable>> lobes_;  ///< G_n; [0] is Lambert's
    std::vector<SurfaceLobes> materials_;                    ///< by object
    std::vector<std::size_t> lobe_of_object_;                ///< of its glossy part
    std::vector<LampShadowMap> shadow_maps_;                 ///< by lamp; empty unless asked for
    /// By lamp, one for each channel or for all; empty where the media are not theirs.
    std::vector<std::vector<GaussianAirlightEvaluator>> fogshop_;
    glm::dvec3 gaussians_albedo_{0}, uniform_albedo_{0};
};

}  // namespace airlight
