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

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

}  // namespace

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

// Where on the ray: with the density of the first collision, were the whole depth spread evenly;
// what that misses is weighed.
glm::dvec3 ReferenceRenderer::airlight_of_map(const glm::dvec3& origin, const glm::dvec3& direction,
                                              double distance, SampleStream& stream,
                                              ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    const EnvironmentSampler* const sampler = world_.sampler();
    if (media.empty() || !sampler || !std::isfinite(distance)) return glm::dvec3(0);
    const double xi = stream.next(), choice_x = stream.next(), choice_y = stream.next();
    const double depth = largest(media.depth(origin, direction, distance));
    const double rate = std::min(depth, 700.0) / distance;
    const double all = -std::expm1(-rate * distance);
    const double t = all > 0 ? -std::log1p(-xi * all) / rate : xi * distance;
    const double pdf = all > 0 ? rate * std::exp(-rate * t) / all : 1 / distance;
    const glm::dvec3 x = origin + t * direction;
    const EnvironmentSample light = sampler->sample(choice_x, choice_y);
    if (!(light.pdf > 0)) return glm::dvec3(0);
    ++counts.line_points;
    const glm::dvec3 scattered = this->scattered(x, -light.direction, -direction);
    if (options_.shadows_in_media && !sees_map(x, light.direction, counts)) return glm::dvec3(0);
    return scattered * media.transmittance(origin, direction, t) *
           media.transmittance(x, light.direction, world_.scene().environment->distance) *
           light.radiance / (light.pdf * pdf);
}

glm::dvec3 ReferenceRenderer::surface_of_map(const WorldHit& hit, const glm::dvec3& to_viewer,
                                             const glm::dvec3& from, SampleStream& stream,
                                             ReferenceCounts& counts) const {
    const EnvironmentSampler* const sampler = world_.sampler();
    if (!sampler) return glm::dvec3(0);
    const SurfaceMaterial& material = world_.material(hit.object);
    const auto arriving = [&](const glm::dvec3& direction) {
        if (!(glm::dot(direction, hit.face) > 0) || !sees_map(from, direction, counts)) {
            return glm::dvec3(0);
        }
        return world_.environment(direction) *
               world_.media().transmittance(from, direction, world_.scene().environment->distance);
    };
    // Two ways to draw a direction, each weighed by the sum of both densities.
    const double x = stream.next(), y = stream.next();
    const EnvironmentSample light = sampler->sample(x, y);
    const LobeSample lobe = sample_lobe(material, hit.normal, to_viewer, stream);
    glm::dvec3 sum(0);
    if (light.pdf > 0) {
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, light.direction);
        const double pdf = light.pdf + lobe_pdf(material, hit.normal, to_viewer, light.direction);
        if (largest(f) > 0) sum += f * arriving(light.direction) / pdf;
    }
    if (lobe.pdf > 0) {
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, lobe.direction);
        if (largest(f) > 0) {
            sum += f * arriving(lobe.direction) / (lobe.pdf + sampler->pdf(lobe.direction));
        }
    }
    return sum;
}

// Around a light the airlight is 1 / sin(gamma) bright, so gamma and the azimuth are drawn evenly:
// the density is 1 / (2 pi^2 sin(gamma)).
glm::dvec3 ReferenceRenderer::surface_of_media(const WorldHit& hit, const glm::dvec3& to_viewer,
                                               const glm::dvec3& from, const glm::dvec3& direct,
                                               SampleStream& stream,
                                               ReferenceCounts& counts) const {
    if (world_.media().empty()) return glm::dvec3(0);
    const SurfaceMaterial& material = world_.material(hit.object);
    const auto end_of = [&](const glm::dvec3& direction) {
        ++counts.rays;
        const std::optional<WorldHit> next = world_.trace(from, direction, kInfinite);
        if (next) return next->distance;
        return world_.sampler() ? world_.scene().environment->distance : kInfinite;
    };
    glm::dvec3 sum(0);
    for (const PointLight& light : world_.scene().lights) {
        const double gamma = kPi * stream.next(), azimuth = 2 * kPi * stream.next();
        const glm::dvec3 axis = glm::normalize(light.position - from);
        glm::dvec3 x, y;
        make_axes(axis, x, y);
        const glm::dvec3 direction =
            std::sin(gamma) * (std::cos(azimuth) * x + std::sin(azimuth) * y) +
            std::cos(gamma) * axis;
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, direction);
        if (!(largest(f) > 0) || !(glm::dot(direction, hit.face) > 0)) continue;
        const glm::dvec3 weight = f * (2 * kPi * kPi * std::sin(gamma));
        const double absolute = options_.quadrature * largest(sum + direct) / largest(weight);
        sum += weight * airlight_of(light, from, direction, end_of(direction), absolute, counts);
    }
    if (world_.sampler()) {
        const LobeSample lobe = sample_lobe(material, hit.normal, to_viewer, stream);
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, lobe.direction);
        if (lobe.pdf > 0 && largest(f) > 0 && glm::dot(lobe.direction, hit.face) > 0) {
            sum += f *
                   airlight_of_map(from, lobe.direction, end_of(lobe.direction), stream, counts) /
                   lobe.pdf;
        }
    }
    return sum;
}

glm::dvec3 ReferenceRenderer::surface(const WorldHit& hit, const glm::dvec3& to_viewer,
                                      SampleStream& stream, ReferenceCounts& counts) const {
    const SurfaceMaterial& material = world_.material(hit.object);
    const glm::dvec3 from = world_.lifted(hit);
    glm::dvec3 sum(0);
    for (const PointLight& light : world_.scene().lights) {
        const glm::dvec3 to_light = light.position - from;
        const double r = glm::length(to_light);
        if (!(r > 0) || !(glm::dot(to_light, hit.face) > 0)) continue;
        const glm::dvec3 f = reflect(material, hit.normal, to_viewer, to_light / r);
        if (!(largest(f) > 0) || !sees(from, light.position, counts)) continue;
        sum += f * light.intensity / (r * r) * world_.media().transmittance(from, to_light / r, r);
    }
    sum += surface_of_map(hit, to_viewer, from, stream, counts);
    return sum + surface_of_media(hit, to_viewer, from, sum, stream, counts);
}

glm::dvec3 ReferenceRenderer::radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                       SampleStream& stream, ReferenceCounts& counts) const {
    ++counts.rays;
    const std::optional<WorldHit> hit = world_.trace(origin, direction, kInfinite);
    const auto& environment = world_.scene().environment;
    const double distance = hit ? hit->distance : environment ? environment->distance : kInfinite;
    const glm::dvec3 behind =
        hit ? surface(*hit, -direction, stream, counts) : world_.environment(direction);
    glm::dvec3 sum = airlight_of_map(origin, direction, distance, stream, counts);
    if (largest(behind) > 0) {
        sum += behind * world_.media().transmittance(origin, direction, distance);
    }
    return sum + airlight_of_lights(origin, direction, distance, counts,
                                    options_.quadrature * largest(sum));
}

}  // namespace airlight
