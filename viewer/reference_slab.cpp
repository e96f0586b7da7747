// SPDX-License-Identifier: Apache-2.0
// Light in slabs.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "viewer/environment_sampler.h"
#include "viewer/line_quadrature.h"
#include "viewer/ray_nodes.h"
#include "viewer/reference.h"

namespace airlight {
// Of an arrival's way within the slab.
glm::dvec3 ReferenceRenderer::slab_depth(const Slab& slab, const glm::dvec3& x,
                                         const SlabArrival& way) const {
    return slab.extinction * way.inside + world_.media().depth(x, way.to_light, way.inside);
}

// Of a straight line outside slabs, or through them as if their surfaces were not there.
glm::dvec3 ReferenceRenderer::straight_depth(const glm::dvec3& x, const glm::dvec3& direction,
                                             double distance, ReferenceCounts& counts) const {
    if (!attenuates()) return glm::dvec3(0);
    ++counts.attenuations;
    glm::dvec3 depth;
    depths(1, &x, &direction, &distance, &depth);
    return depth + world_.slabs().depth(x, direction, distance);
}

glm::dvec3 ReferenceRenderer::straight_transmittance(const glm::dvec3& x,
                                                     const glm::dvec3& direction, double distance,
                                                     ReferenceCounts& counts) const {
    if (!attenuates()) return glm::dvec3(1);
    return transmittance_of(straight_depth(x, direction, distance, counts));
}

glm::dvec3 ReferenceRenderer::sent_in_slab(const Slab& slab, const glm::dvec3& x,
                                           const glm::dvec3& incoming,
                                           const glm::dvec3& outgoing) const {
    const double cosine = std::clamp(glm::dot(incoming, outgoing), -1.0, 1.0);
    return slab.scattering * slab.phase.at_cosine(cosine) + scattered(x, incoming, outgoing);
}

glm::dvec3 ReferenceRenderer::irradiance_in_slab(const Slab& slab, const glm::dvec3& x,
                                                 const SlabArrival& way, const PointLight& light,
                                                 bool shadows, ReferenceCounts& counts) const {
    const glm::dvec3 outside = light.position - way.entry;
    const double distance = glm::length(outside);
    if (shadows && !sees(x, way.entry, counts)) return glm::dvec3(0);
    glm::dvec3 depth = slab_depth(slab, x, way);
    if (distance > 0) {
        if (shadows && !sees(way.entry, light.position, counts)) return glm::dvec3(0);
        depth += straight_depth(way.entry, outside / distance, distance, counts);
    }
    return light.intensity * way.irradiance * transmittance_of(depth);
}

// In the angle at which the light would see the ray straight, which smooths it where it is near.
glm::dvec3 ReferenceRenderer::airlight_in_slab(const PointLight& light, const RayPiece& piece,
                                               double absolute, ReferenceCounts& counts) const {
    const Slab& slab = *piece.slab;
    const double foot = glm::dot(light.position - piece.origin, piece.direction);
    const double height =
        std::max(glm::length(light.position - piece.origin - foot * piece.direction),
                 kLeastHeight * (1 + std::abs(foot)));
    std::vector<double> breaks =
        world_.media().marks(piece.origin, piece.direction, piece.distance);
    const double free_path = 1 / largest(slab.extinction);
    for (const double t : {foot, free_path, 4 * free_path}) {
        if (t > 0 && t < piece.distance) breaks.push_back(t);
    }
    for (double& t : breaks) t = std::atan((t - foot) / height);
    std::sort(breaks.begin(), breaks.end());
    const auto integrand = [&](double u) {
        const double tangent = std::tan(u);
        const double t = foot + height * tangent;
        glm::dvec3 sum(0);
        if (!(t > 0 && t < piece.distance)) return sum;
        ++counts.line_points;
        const glm::dvec3 x = piece.origin + t * piece.direction;
        for (const SlabArrival& way : arrivals_of_point(slab, x, light.position)) {
            const glm::dvec3 sent = sent_in_slab(slab, x, -way.to_light, -piece.direction);
            if (!(largest(sent) > 0)) continue;
            sum +=
                sent * irradiance_in_slab(slab, x, way, light, options_.shadows_in_media, counts);
        }
        const glm::dvec3 depth =
            slab.extinction * t + world_.media().depth(piece.origin, piece.direction, t);
        return sum * transmittance_of(depth) * (height * (1 + tangent * tangent));
    };
    LineQuadratureOptions quadrature;
    quadrature.relative = options_.quadrature;
    quadrature.absolute = absolute;
    return integrate_line(integrand, breaks, quadrature).value;
}

ReferenceRenderer::LampAirlight ReferenceRenderer::airlight_along(std::size_t lamp,
                                                                  const LampUse& use,
                                                                  const RayPath& path,
                                                                  double absolute,
                                                                  ReferenceCounts& counts) const {
    const bool gaussians = use.gaussians && (plan_.everything || world_.media().any(true));
    const bool others = use.others && (plan_.everything || world_.media().any(false));
    LampAirlight sum;
    for (const RayPiece& piece : path.pieces) {
        const double most = largest(piece.throughput);
        if (!(most > 0)) continue;
        const auto enough = [&] {
            const double so_far = largest(sum.gaussians + sum.others);
            return std::max(absolute, options_.quadrature * so_far) / most;
        };
        if (piece.slab) {
            if (use.others) {
                sum.others += piece.throughput * airlight_in_slab(world_.scene().lights[lamp],
                                                                  piece, enough(), counts);
            }
            continue;
        }
        if (others) {
            sum.others +=
                piece.throughput * airlight_of(lamp, Scatterers::others, piece.origin,
                                               piece.direction, piece.distance, enough(), counts);
        }
        if (gaussians) {
            sum.gaussians +=
                piece.throughput * airlight_of(lamp, Scatterers::gaussians, piece.origin,
                                               piece.direction, piece.distance, enough(), counts);
        }
    }
    return sum;
}

glm::dvec3 ReferenceRenderer::map_in_slab(const Slab& slab, const glm::dvec3& x,
                                          const SlabArrival& way, const glm::dvec3& to_map,
                                          bool shadows, ReferenceCounts& counts) const {
    if (shadows && !(sees(x, way.entry, counts) && sees_map(way.entry, to_map, counts))) {
        return glm::dvec3(0);
    }
    const double distance = world_.scene().environment->distance;
    return way.irradiance *
           transmittance_of(
               slab_depth(slab, x, way) +
               straight_depth(way.entry, to_map, std::max(0.0, distance - way.inside), counts));
}

// With what of a lamp and of the map arrives at a surface.
void ReferenceRenderer::surface_in_slab(const Slab& slab, const WorldHit& hit,
                                        const glm::dvec3& to_viewer, const glm::dvec3& from,
                                        SampleStream stream, ReferenceCounts& counts,
                                        LayeredRadiance& light) const {
    const SurfaceMaterial& material = materials_[hit.object];
    const auto reflected = [&](const SlabArrival& way) {
        if (!(glm::dot(way.to_light, hit.face) > 0)) return glm::dvec3(0);
        return reflect(material, hit.normal, to_viewer, way.to_light);
    };
    for (const PointLight& lamp : world_.scene().lights) {
        for (const SlabArrival& way : arrivals_of_point(slab, from, lamp.position)) {
            const glm::dvec3 f = reflected(way);
            if (!(largest(f) > 0)) continue;
            light[RadianceLayer::direct] +=
                f * irradiance_in_slab(slab, from, way, lamp, true, counts);
        }
    }
    const EnvironmentSampler* const sampler = world_.sampler();
    if (!sampler || !plan_.runs(Effect::surface_environment)) return;
    const double u = stream.next(), v = stream.next();
    const EnvironmentSample sky = sampler->sample(u, v);
    if (!(sky.pdf > 0)) return;
    for (const SlabArrival& way : arrivals_of_direction(slab, from, sky.direction)) {
        const glm::dvec3 f = reflected(way);
        if (!(largest(f) > 0)) continue;
        light[RadianceLayer::surface_environment] +=
            f * sky.radiance / sky.pdf * map_in_slab(slab, from, way, sky.direction, true, counts);
    }
}

}  // namespace airlight
