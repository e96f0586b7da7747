// SPDX-License-Identifier: Apache-2.0
// Single scattering done exactly: the pictures that approximations are measured against.
//
// Along a ray of view from o in direction w, up to the surface or the environment at distance d:
//     L = T(o, d) L_d + int_0^d T(o, t) sum_m sigma_s,m(x) S_m(x) dt,  x = o + t w,
//     S_m = sum_lights p_m I T(x, light) / |x - light|^2 + int p_m T(x, map) L_map d omega,
// with the media's closed-form optical depths for T, [Sun05] sec. 3 and [Zhou07] sec. 3. A surface
// sends L_d: the light of lights and map that reaches it through the media and past the objects,
// and the light that the media scatter onto it once; light is not passed on between surfaces.
//
// What the map is: to media that are the same everywhere its directions w are point lights of the
// intensity L D^2 d omega at o + D w, with D the map's distance and o where the ray begins, at the
// camera or a surface. A ray that meets no object gathers them to infinity, so that before the map
// L = e^{-T} L_map + albedo int PSF_T L_map d omega with T = sigma_t D, what envmap/fog.h writes
// ([Sun05] sec. 6.1, [Zhou07] eq. 26). To other media, which end or thin out, its light comes
// everywhere from w itself, dimmed by all media along D; rays gather it along D. Where both are,
// each does it its way.
//
// What is deterministic: light of point lights on surfaces and in the media along rays, between the
// exact borders of the shadows there; in closed form where all media are the same everywhere, else
// by adaptive quadrature in the angle at which the light sees the ray, which takes its 1/d^2 away.
// What is sampled: directions of the map, on surfaces by its bright pixels and the surface's lobe,
// weighed against each other, in media by its bright pixels and around the ray; the place on the
// ray, unless nothing shades media that are the same everywhere, where it is a closed form; and
// what media scatter onto surfaces (around the direction of each light or of the map, where that
// light is 1/sin).
//
// Slabs: rays of view refract at their surfaces, light that reaches a point within does so through
// each face, both by Snell's law with the transmittance of Fresnel, and the light's beam spreads as
// it bends. Media fill slabs, too. Left out: what surfaces reflect in part (total reflection is
// followed by the view ray, not by light), light that one slab bends onto something outside it
// (caustics) or into another slab: that goes straight on, attenuated by the slab's medium but not
// by its surfaces. An index of 1 is a medium in a box.
//
// Shafts: particles send light along rays of view, with the weights of medium/shafts.h. They lie
// outside slabs and light no surface; the shadows are exact, no map of them is drawn.
//
// Camera rays per CPU second, one thread, with one lamp, shadows in the media and all that the
// surfaces scatter, line integrals to 1e-3 (bench/reference_bench.cpp, on a machine with other
// work): fog alone 5.3e6; over a floor with three balls of 224 triangles 1.1e6 in grey fog, 0.78e6
// in coloured, 0.57e6 with Henyey-Greenstein's phase function, 0.09e6 with a Gaussian besides; with
// balls of 65024 triangles 0.27e6. That is 6.8, 5.7, 3.3, 1.9 and 2.4 times as many as by
// RayAirlight::points, which is off by 1e-5 of the brightest ray where shadows fall (root mean
// square). Slabs are slow, since each point of theirs has shadow rays of its own, which see borders
// of shadows between points only by halving panels: a picture with a box that fills a tenth of it
// and two lamps took 0.1 ms a sample on two busy cores.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/method_names.h"
#include "viewer/medium_depths.h"
#include "viewer/plan.h"
#include "viewer/ray_path.h"
#include "viewer/ray_shadows.h"
#include "viewer/sample_stream.h"
#include "viewer/world.h"

namespace airlight {

struct EnvironmentSample;

/// How the light of lamps that media scatter is summed along a ray.
enum class RayAirlight {
    /// Over the parts of the ray that the lamp reaches (viewer/ray_shadows.h): in closed form where
    /// all media are the same everywhere, else by adaptive quadrature.
    parts,
    /// By adaptive quadrature with a shadow ray from every point, blind to shadows between them.
    points,
};
inline constexpr NamedMethod<RayAirlight> kRayAirlights[] = {
    {RayAirlight::parts, "parts"},
    {RayAirlight::points, "points"},
};

struct ReferenceOptions {
    /// Error of each integral along a ray, relative to it or to what else the ray brings, whichever
    /// is brighter.
    double quadrature = 1e-4;
    RayAirlight airlight = RayAirlight::parts;
    /// Whether objects keep the light of lamps and map from parts of the media. The light that
    /// reaches surfaces is always kept by objects.
    bool shadows_in_media = true;
};

/// What was evaluated.
struct ReferenceCounts {
    std::uint64_t rays = 0;         ///< traced, shadow rays among them
    std::uint64_t line_points = 0;  ///< points of media whose light was summed
    std::uint64_t airlights = 0;    ///< rays of view and lamps or map, in the media
    std::uint64_t surface_lights =
        0;                           ///< points of surfaces that light of the media was sought for
    std::uint64_t attenuations = 0;  ///< ways whose optical depth was taken

    ReferenceCounts& operator+=(const ReferenceCounts& other);
    /// All that only media cause.
    std::uint64_t in_media() const {
        return line_points + airlights + surface_lights + attenuations;
    }
};

class ReferenceRenderer {
  public:
    /// Everything that the scene holds.
    ReferenceRenderer(const World& world, const ReferenceOptions& options);
    /// What the plan calls for. The options' quadrature and shadows hold beside it; the world's
    /// media should be those of the plan (World::set_media).
    ReferenceRenderer(const World& world, const Plan& plan, const ReferenceOptions& options);

    /// Radiance that comes to `origin` from a unit direction; one sample of what is sampled, whose
    /// mean it is. Not negative, and finite unless the ray runs through a light.
    glm::dvec3 radiance(const glm::dvec3& origin, const glm::dvec3& direction, SampleStream& stream,
                        ReferenceCounts& counts) const {
        return layers(origin, direction, stream, counts).total();
    }
    /// The same by what brought it. Numbers of the stream belong to one layer each: a layer that is
    /// left out does not change the others.
    LayeredRadiance layers(const glm::dvec3& origin, const glm::dvec3& direction,
                           SampleStream& stream, ReferenceCounts& counts) const;

    /// Light of the point lights that media scatter towards `origin` along a ray: nothing of it is
    /// sampled. `distance` in [0, inf]. Within the larger of `absolute` and the relative error.
    glm::dvec3 airlight_of_lights(const glm::dvec3& origin, const glm::dvec3& direction,
                                  double distance, ReferenceCounts& counts,
                                  double absolute = 0) const;

    /// What the particles of the scene's shafts add to that: the second term of medium/shafts.h's
    /// sum, with shadows at the particles' places, integrated within each cell of particles. For
    /// rays outside slabs, up to 10 km or where a tenth of the tolerance is left; 0 without shafts.
    glm::dvec3 light_of_particles(const glm::dvec3& origin, const glm::dvec3& direction,
                                  double distance, ReferenceCounts& counts) const;

  private:
    enum class Scatterers { gaussians, others };
    glm::dvec3 airlight_of(std::size_t lamp, Scatterers which, const glm::dvec3& origin,
                           const glm::dvec3& direction, double distance, double absolute,
                           ReferenceCounts& counts) const;
    glm::dvec3 airlight_of_uniform(const PointLight& light, double foot, double height,
                                   const std::vector<RayInterval>& lit) const;
    glm::dvec3 scattered(const glm::dvec3& x, const glm::dvec3& incoming,
                         const glm::dvec3& outgoing, MediumExtent extent = MediumExtent::any) const;
    glm::dvec3 airlight_of_map(const RayPiece& piece, const EnvironmentSample& light, double choice,
                               ReferenceCounts& counts) const;
    glm::dvec3 airlight_of_direction(const RayPath& path, const glm::dvec3& to_map, double choice,
                                     ReferenceCounts& counts) const;
    glm::dvec3 map_along(const RayPath& path, SampleStream& stream, ReferenceCounts& counts) const;
    struct LampAirlight {
        glm::dvec3 gaussians{0}, others{0};
    };
    struct LampUse {
        bool gaussians = true, others = true;
    };
    LampAirlight airlight_along(std::size_t lamp, const LampUse& use, const RayPath& path,
                                double absolute, ReferenceCounts& counts) const;
    glm::dvec3 particles_along(const RayPiece& piece, ReferenceCounts& counts) const;
    /// Optical depths of ways through the media, slabs apart, as precise as the plan asks.
    void depths(std::size_t count, const glm::dvec3* origins, const glm::dvec3* directions,
                const double* distances, glm::dvec3* out,
                MediumExtent extent = MediumExtent::any) const;
    std::vector<double> depths_to(const RayPiece& piece, const std::vector<double>& places) const;
    glm::dvec3 straight_depth(const glm::dvec3& x, const glm::dvec3& direction, double distance,
                              ReferenceCounts& counts) const;

    glm::dvec3 airlight_in_slab(const PointLight& light, const RayPiece& piece, double absolute,
                                ReferenceCounts& counts) const;
    glm::dvec3 slab_depth(const Slab& slab, const glm::dvec3& x, const SlabArrival& way) const;
    glm::dvec3 sent_in_slab(const Slab& slab, const glm::dvec3& x, const glm::dvec3& incoming,
                            const glm::dvec3& outgoing) const;
    glm::dvec3 irradiance_in_slab(const Slab& slab, const glm::dvec3& x, const SlabArrival& way,
                                  const PointLight& light, bool shadows,
                                  ReferenceCounts& counts) const;
    glm::dvec3 map_in_slab(const Slab& slab, const glm::dvec3& x, const SlabArrival& way,
                           const glm::dvec3& to_map, bool shadows, ReferenceCounts& counts) const;
    void surface_in_slab(const Slab& slab, const WorldHit& hit, const glm::dvec3& to_viewer,
                         const glm::dvec3& from, SampleStream stream, ReferenceCounts& counts,
                         LayeredRadiance& light) const;

    void surface(const WorldHit& hit, const glm::dvec3& to_viewer, const SampleStream& stream,
                 ReferenceCounts& counts, LayeredRadiance& light) const;
    glm::dvec3 surface_of_map(const WorldHit& hit, const glm::dvec3& to_viewer,
                              const glm::dvec3& from, SampleStream& stream,
                              ReferenceCounts& counts) const;
    void surface_of_media(const WorldHit& hit, const glm::dvec3& to_viewer, const glm::dvec3& from,
                          const SampleStream& stream, ReferenceCounts& counts,
                          LayeredRadiance& light) const;
    glm::dvec3 surface_of_scattered_map(const WorldHit& hit, const glm::dvec3& to_viewer,
                                        const glm::dvec3& from, SampleStream stream,
                                        ReferenceCounts& counts) const;
    bool sees(const glm::dvec3& from, const glm::dvec3& to, ReferenceCounts& counts) const;
    bool sees_map(const glm::dvec3& from, const glm::dvec3& direction,
                  ReferenceCounts& counts) const;
    glm::dvec3 straight_transmittance(const glm::dvec3& x, const glm::dvec3& direction,
                                      double distance, ReferenceCounts& counts) const;
    bool attenuates() const { return plan_.runs(Effect::attenuation); }

    const World& world_;
    Plan plan_;
    ReferenceOptions options_;
    /// Where single precision is enough: of all media and of those that end.
    std::optional<MediumDepths> quick_, quick_limited_;
    bool in_media_;  ///< there is something in the air, or the plan does not ask
    std::vector<SurfaceMaterial> materials_;  ///< of the objects, as the plan has them
};

}  // namespace airlight
