// SPDX-License-Identifier: Apache-2.0
#include "viewer/reference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "viewer/environment_sampler.h"
#include "viewer/material.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Whom numbers of a sample's stream are for.
enum Purpose : unsigned { kMapOnSurfaces = 1, kMapByMedia, kLampsByMedia, kMapInMedia };

Plan all_of(const World& world) {
    PlanOptions options;
    options.bounds = false;
    return make_plan(world, options);
}

// A diffuse part alone where the plan leaves out the other; with it where all is evaluated.
SurfaceMaterial planned(SurfaceMaterial material, const ObjectPlan& plan, bool everything) {
    const auto* const phong = std::get_if<PhongMaterial>(&material.kind);
    const auto* const lambert = std::get_if<LambertMaterial>(&material.kind);
    if (phong && !plan.glossy) {
        material.kind = LambertMaterial{phong->diffuse};
    } else if (lambert && everything) {
        material.kind = PhongMaterial{lambert->diffuse, glm::dvec3(0), 1};
    }
    return material;
}

}  // namespace

ReferenceCounts& ReferenceCounts::operator+=(const ReferenceCounts& other) {
    rays += other.rays;
    line_points += other.line_points;
    airlights += other.airlights;
    surface_lights += other.surface_lights;
    attenuations += other.attenuations;
    return *this;
}

ReferenceRenderer::ReferenceRenderer(const World& world, const ReferenceOptions& options)
    : ReferenceRenderer(world, all_of(world), options) {}

ReferenceRenderer::ReferenceRenderer(const World& world, const Plan& plan,
                                     const ReferenceOptions& options)
    : world_(world),
      plan_(plan),
      options_(options),
      in_media_(plan.everything || !world.media().empty() || !world.slabs().empty()) {
    for (std::size_t i = 0; i < plan_.objects.size(); ++i) {
        materials_.push_back(planned(world.material(i), plan_.objects[i], plan_.everything));
    }
    if (plan_.single_precision()) {
        quick_.emplace(world.media());
        quick_limited_.emplace(world.media(), MediumExtent::limited);
    }
}

void ReferenceRenderer::depths(std::size_t count, const glm::dvec3* origins,
                               const glm::dvec3* directions, const double* distances,
                               glm::dvec3* out, MediumExtent extent) const {
    if (quick_ && extent != MediumExtent::endless) {
        const MediumDepths& quick = extent == MediumExtent::any ? *quick_ : *quick_limited_;
        quick(count, origins, directions, distances, out);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = world_.media().depth(origins[i], directions[i], distances[i], extent);
    }
}

bool ReferenceRenderer::sees(const glm::dvec3& from, const glm::dvec3& to,
                             ReferenceCounts& counts) const {
    ++counts.rays;
    return !world_.is_blocked(from, to);
}

bool ReferenceRenderer::sees_map(const glm::dvec3& from, const glm::dvec3& direction,
                                 ReferenceCounts& counts) const {
    ++counts.rays;
    return !world_.trace(from, direction, kInfinite);
}

glm::dvec3 ReferenceRenderer::surface_of_map(const WorldHit& hit, const glm::dvec3& to_viewer,
                                             const glm::dvec3& from, SampleStream& stream,
                                             ReferenceCounts& counts) const {
    const EnvironmentSampler* const sampler = world_.sampler();
    if (!sampler) return glm::dvec3(0);
    const SurfaceMaterial& material = materials_[hit.object];
    const auto arriving = [&](const glm::dvec3& direction) {
        if (!(glm::dot(direction, hit.face) > 0)) return glm::dvec3(0);
        if (plan_.runs(Effect::shadow_prt) && !sees_map(from, direction, counts)) {
            return glm::dvec3(0);
        }
        return straight_transmittance(from, direction, world_.scene().environment->distance,
                                      counts);
    };
    // Two ways to draw a direction, each weighed by the sum of both densities.
    const double x = stream.next(), y = stream.next();
    const EnvironmentSample light = sampler->sample(x, y);
    const LobeSample lobe = sample_lobe(material, hit.normal, to_viewer, stream);
    glm::dvec3 sum(0);
    if (light.pdf > 0) {
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, light.direction);
        const double pdf = light.pdf + lobe_pdf(material, hit.normal, to_viewer, light.direction);
        if (largest(f) > 0) sum += f * light.radiance * arriving(light.direction) / pdf;
    }
    if (lobe.pdf > 0) {
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, lobe.direction);
        const EnvironmentSample sky = sampler->at(lobe.direction);
        if (largest(f * sky.radiance) > 0) {
            sum += f * sky.radiance * arriving(lobe.direction) / (lobe.pdf + sky.pdf);
        }
    }
    return sum;
}

// Around a light the airlight is 1 / sin(gamma) bright, so gamma and the azimuth are drawn evenly:
// the density is 1 / (2 pi^2 sin(gamma)).
void ReferenceRenderer::surface_of_media(const WorldHit& hit, const glm::dvec3& to_viewer,
                                         const glm::dvec3& from, const SampleStream& stream,
                                         ReferenceCounts& counts, LayeredRadiance& light) const {
    if (!in_media_) return;
    const SurfaceMaterial& material = materials_[hit.object];
    const auto path_to = [&](const glm::dvec3& direction) {
        RayPath path = follow_ray(world_, from, direction, attenuates());
        counts.rays += path.rays;
        // Lifted only so that the surface does not stop it.
        path.pieces.front().origin = hit.position;
        return path;
    };
    SampleStream of_lamps = stream.of(kLampsByMedia);
    for (std::size_t lamp = 0; lamp < plan_.lights.size(); ++lamp) {
        const double gamma = kPi * of_lamps.next(), azimuth = 2 * kPi * of_lamps.next();
        if (!plan_.lights[lamp].surface) continue;
        const glm::dvec3 axis = glm::normalize(world_.scene().lights[lamp].position - hit.position);
        glm::dvec3 x, y;
        make_axes(axis, x, y);
        const glm::dvec3 direction =
            std::sin(gamma) * (std::cos(azimuth) * x + std::sin(azimuth) * y) +
            std::cos(gamma) * axis;
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, direction);
        if (!(largest(f) > 0) || !(glm::dot(direction, hit.face) > 0)) continue;
        ++counts.surface_lights;
        const glm::dvec3 weight = f * (2 * kPi * kPi * std::sin(gamma));
        const double absolute = options_.quadrature * largest(light.total()) / largest(weight);
        const LampAirlight sent = airlight_along(lamp, {}, path_to(direction), absolute, counts);
        light[RadianceLayer::surface_point] += weight * (sent.gaussians + sent.others);
    }
    if (!world_.sampler() || !plan_.runs(Effect::surface_environment)) return;
    light[RadianceLayer::surface_environment] +=
        surface_of_scattered_map(hit, to_viewer, from, stream.of(kMapByMedia), counts);
}

void ReferenceRenderer::surface(const WorldHit& hit, const glm::dvec3& to_viewer,
                                const SampleStream& stream, ReferenceCounts& counts,
                                LayeredRadiance& light) const {
    const glm::dvec3 from = world_.lifted(hit);
    const Slab* const slab = world_.slabs().at(from);
    if (slab) {
        surface_in_slab(*slab, hit, to_viewer, from, stream.of(kMapOnSurfaces), counts, light);
    } else {
        for (const PointLight& lamp : world_.scene().lights) {
            const glm::dvec3 to_light = lamp.position - hit.position;
            const double r = glm::length(to_light);
            if (!(r > 0) || !(glm::dot(to_light, hit.face) > 0)) continue;
            const glm::dvec3 f =
                reflect(materials_[hit.object], hit.normal, to_viewer, to_light / r);
            if (!(largest(f) > 0) || !sees(from, lamp.position, counts)) continue;
            light[RadianceLayer::direct] +=
                f * lamp.intensity / (r * r) *
                straight_transmittance(hit.position, to_light / r, r, counts);
        }
        if (plan_.runs(Effect::surface_environment)) {
            SampleStream of_map = stream.of(kMapOnSurfaces);
            light[RadianceLayer::surface_environment] +=
                surface_of_map(hit, to_viewer, from, of_map, counts);
        }
    }
    surface_of_media(hit, to_viewer, from, stream, counts, light);
}

LayeredRadiance ReferenceRenderer::layers(const glm::dvec3& origin, const glm::dvec3& direction,
                                          SampleStream& stream, ReferenceCounts& counts) const {
    LayeredRadiance light;
    if (!in_media_) {
        ++counts.rays;
        if (const auto hit = world_.trace(origin, direction, kInfinite)) {
            surface(*hit, -direction, stream, counts, light);
        } else {
            light[RadianceLayer::direct] = world_.environment(direction);
        }
        return light;
    }
    const RayPath path = follow_ray(world_, origin, direction, attenuates());
    counts.rays += path.rays;
    if (attenuates()) counts.attenuations += path.pieces.size();
    if (largest(path.throughput) > 0) {
        const glm::dvec3& last = path.pieces.back().direction;
        if (path.hit) {
            surface(*path.hit, -last, stream, counts, light);
            for (glm::dvec3& layer : light.layers) layer *= path.throughput;
        } else {
            light[RadianceLayer::direct] = path.throughput * world_.environment(last);
        }
    }
    if (plan_.runs(Effect::airlight_environment)) {
        SampleStream of_map = stream.of(kMapInMedia);
        light[RadianceLayer::airlight_environment] = map_along(path, of_map, counts);
    }
    for (std::size_t lamp = 0; lamp < plan_.lights.size(); ++lamp) {
        const LampUse use = {plan_.lights[lamp].airlight_gaussians,
                             plan_.lights[lamp].airlight_point};
        const LampAirlight sent =
            airlight_along(lamp, use, path, options_.quadrature * largest(light.total()), counts);
        light[RadianceLayer::airlight_point] += sent.others;
        light[RadianceLayer::airlight_gaussians] += sent.gaussians;
    }
    if (plan_.runs(Effect::particles)) {
        for (const RayPiece& piece : path.pieces) {
            light[RadianceLayer::particles] += piece.throughput * particles_along(piece, counts);
        }
    }
    return light;
}

}  // namespace airlight
