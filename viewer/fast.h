// SPDX-License-Identifier: Apache-2.0
// The fast engine: what viewer/reference.h integrates and samples, by the papers' closed forms,
// tables and products. Nothing in it is drawn at random.
//
//     lamps in uniform media      [Sun05] eq. 11 in vectors (medium/airlight_batch.h), in shadow
//                                 part by part of the ray
//     lamps in other media        Gauss-Legendre rules along the ray, or [Zhou07] eq. 8 to 17
//     media onto surfaces         [Sun05] eq. 17 and 18 by tables of G_n (medium/surface_batch.h),
//                                 with the mean extinction towards the lamp ([Zhou07] sec. 4.1)
//     the map                     viewer/fast_map.h, on baked objects viewer/fast_transfer.h
//     slabs                       rays of view bent as the reference has it, eight points within
//     particles                   a few points in each cell
//
// Beside the reference, rays per CPU second on one thread, as ratios (bench/fast_bench.cpp at
// 64 x 36, line integrals to each scene's tolerance of 1e-2), with the methods that plans choose:
// 24 with slabs, 12 to 25 with uniform fog before a map, 2 to 11 with shadows in uniform fog, and 8
// to 22 without these, as [Sun05] has it; 3 to 8 where Gaussians are; about 1 around planets, where
// surfaces take `rings`, and with particles; 2 to 5 in clear air, where both trace the same rays.
// Objects do not shade the media that light surfaces, nor surfaces under a map without a .prt file:
// that errs most, by 3 to 11 % of the mean of pictures with a map, and by most of that light in a
// room whose lamp stands outside (data/scenes/shafts.json).
//
// Rays and shadow rays of neighbouring pixels are traced in packets. What the plan leaves out is
// neither built nor evaluated; counts show it.
#pragma once

#include <memory>

#include "viewer/fast_block.h"
#include "viewer/fast_lamps.h"
#include "viewer/fast_map.h"
#include "viewer/fast_methods.h"
#include "viewer/plan.h"

namespace airlight {

class FastRenderer {
  public:
    /// Builds what the plan calls for, for rays from the scene's camera. The world, whose media
    /// should be those of the plan, stays where it is.
    FastRenderer(const World& world, const Plan& plan, const FastMethods& methods = {});
    FastRenderer(const FastRenderer&) = delete;
    FastRenderer& operator=(const FastRenderer&) = delete;

    /// Radiance that comes to the camera along count * together unit directions: out[i] is the sum
    /// of the i-th `together` of them. Neighbours should go almost the same way. The result is the
    /// same however many threads call, each with arrays of its own; a ray's may depend on its block
    /// in whether it grazes a triangle.
    void shade(const glm::dvec3* directions, std::size_t count, std::size_t together,
               LayeredRadiance* out, FastCounts& counts) const;

    /// What the constructor built.
    const FastCounts& built() const { return built_; }

  private:
    void trace(FastBlock& block, FastCounts& counts) const;
    void trace_bent(FastRay& ray, FastBlock& block, FastCounts& counts) const;
    void light_bent(FastBlock& block, const RaySums& out, FastCounts& counts) const;
    void shade_block(FastBlock& block, const RaySums& out, FastCounts& counts) const;

    const World& world_;
    Plan plan_;
    FastMethods methods_;
    FastCounts built_;
    FastLamps lamps_;
    FastMap map_;
};

}  // namespace airlight
