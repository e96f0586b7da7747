// SPDX-License-Identifier: Apache-2.0
// Light scattered any number of times, by media and surfaces: what single scattering leaves out.
//
// A path from the eye: free paths drawn from the media's closed-form depths, phase functions and
// the lobes of surfaces drawn exactly; at every point of it the light of every lamp and of the map
// that comes straight there. Points of a ray that a lamp's light is sought at are drawn in two
// ways, by the free path and evenly in the angle that the lamp sees the ray at, each weighed by the
// sum of both densities; directions to the map by the map and by the phase function or lobe
// likewise. Of more than 8 lamps the eye's own ray and its end see all, later points 4 that are
// drawn. Colours share free paths, so that no channel's weight grows. Depths towards lamps and
// map are closed forms: nothing of attenuation is sampled but where light scatters.
//
// The mean is exact but for paths of more than `max_bounces` points; no bias comes from the
// roulette that ends paths: one of n points goes on with a probability of what it would carry
// without roulette, times 8 / n, where that is below 1. In fog that absorbs nothing and has no end
// the order n brings light in proportion to n^{-3/2}, (3 / (4 pi n))^{3/2}, so N points leave out
// 0.98 T / sqrt(N) of the light that reaches an optical thickness T from a lamp: 1.5 % of it by
// 4096 points at 1. A path there takes 58 points on average. Ground or absorption leave nothing
// out.
//
// The map is infinitely far to all media, its light dimmed along its distance; to those without end
// ReferenceRenderer has it as lights at that distance, so under a map the two agree in media with
// bounds.
//
// Light passes between surfaces, too. Slabs are refused, and particles of shafts are left out.
//
// Paths per CPU second, one thread, with one lamp (bench/reference_bench.cpp, on a busy machine):
// fog alone 0.047e6, over a floor with three balls 0.067e6, coloured 0.050e6, with Henyey and
// Greenstein's phase function 0.042e6, with a Gaussian besides 0.019e6. Errors: within the noise,
// 0.3 % to 1 %, of ReferenceRenderer where `single`, of a white furnace, of a room's energy, and of
// transport theory (medium/point_glow.h). What single scattering leaves out is drawn by
// `airlight ladder multiple`, [Sun05] fig. 7.
#pragma once

#include <glm/vec3.hpp>

#include "viewer/reference.h"
#include "viewer/sample_stream.h"
#include "viewer/world.h"

namespace airlight {

struct PathTracerOptions {
    /// Points where a path scatters or is reflected, 1 … kLargestPathBounces.
    int max_bounces = 4096;
    /// Only the paths that ReferenceRenderer follows: at most one surface, then at most one point
    /// of the media, seen from the eye.
    bool single = false;
};

inline constexpr int kLargestPathBounces = 1 << 20;

class PathTracer {
  public:
    /// Throws Error(usage) for a world with slabs or options outside their domain.
    PathTracer(const World& world, const PathTracerOptions& options);

    /// Radiance that comes to `origin` from a unit direction: one sample, whose mean it is. Not
    /// negative, and finite unless the ray runs through a lamp.
    glm::dvec3 radiance(const glm::dvec3& origin, const glm::dvec3& direction, SampleStream& stream,
                        ReferenceCounts& counts) const;

  private:
    struct Path;
    double end_of_ray(const std::optional<WorldHit>& hit) const;
    glm::dvec3 map_from(const glm::dvec3& x, const glm::dvec3& direction,
                        ReferenceCounts& counts) const;
    glm::dvec3 lamp_at(const PointLight& light, const glm::dvec3& x, const glm::dvec3& to_lamp,
                       double distance, ReferenceCounts& counts) const;
    void lamps_in_media(Path& path, double end, double collision, SampleStream& stream,
                        ReferenceCounts& counts) const;
    bool scatter(Path& path, double distance, SampleStream& stream, ReferenceCounts& counts) const;
    bool reflect_at(Path& path, const WorldHit& hit, SampleStream& stream,
                    ReferenceCounts& counts) const;

    const World& world_;
    PathTracerOptions options_;
};

}  // namespace airlight
