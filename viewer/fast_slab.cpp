// SPDX-License-Identifier: Apache-2.0
// Light in slabs, and that of particles, fast.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "medium/quadrature.h"
#include "medium/shafts.h"
#include "viewer/cell_walk.h"
#include "viewer/fast_lamps.h"
#include "viewer/fast_map.h"

namespace airlight {
namespace {

constexpr int kSlabNodes = 8;
constexpr double kLeastDistance = 1e-3, kLongest = 1e4;  // [m]

// Nodes along a piece as its light falls off: even in the transmittance of its densest channel,
// down to e^-8. Calls take(t, weight).
template <class Take>
void each_slab_node(const RayPiece& piece, double sigma, const Take& take) {
    const double end = std::min(piece.distance, 8 / std::max(sigma, 1e-12));
    const double all = -std::expm1(-sigma * end);
    const detail::QuadratureRule rule = detail::gauss_legendre(kSlabNodes);
    for (int i = 0; i < rule.count; ++i) {
        for (const double side : {-1.0, 1.0}) {
            const double x = 0.5 + 0.5 * side * rule.nodes[i].x, w = 0.5 * rule.nodes[i].w;
            if (!(all > 1e-6)) {
                take(x * end, w * end);
                continue;
            }
            const double t = -std::log1p(-x * all) / sigma;
            take(t, w * all / (sigma * std::exp(-sigma * t)));
        }
    }
}

int points_of(FastParticles method) {
    return method == FastParticles::cells1 ? 1 : method == FastParticles::cells2 ? 2 : 6;
}

}  // namespace

bool FastLamps::sees(std::size_t lamp, const glm::dvec3& point, FastCounts& counts) const {
    if (!plan_.runs(Effect::shafts) || !plan_.lights[lamp].shafts || !world_.rays() ||
        methods_.shafts == FastShafts::unshadowed) {
        return true;
    }
    if (!shadow_maps_.empty()) return shadow_maps_[lamp].sees(point);
    ++counts.shadow_rays;
    return !world_.is_blocked(point, world_.scene().lights[lamp].position);
}

glm::dvec3 FastLamps::light_slab(std::size_t lamp, const RayPiece& piece,
                                 FastCounts& counts) const {
    const Slab& slab = *piece.slab;
    const PointLight& light = world_.scene().lights[lamp];
    const SceneMedia& media = world_.media();
    const bool attenuates = plan_.runs(Effect::attenuation);
    ++counts[Effect::slab];
    glm::dvec3 sum(0);
    each_slab_node(piece, attenuates ? largest(slab.extinction) : 0, [&](double t, double weight) {
        const glm::dvec3 x = piece.origin + t * piece.direction;
        SlabArrivals arrivals;
        if (methods_.slab == FastSlab::refracted) {
            arrivals = arrivals_of_point(slab, x, light.position);
        } else {
            const glm::dvec3 to_light = light.position - x;
            const double r = std::max(glm::length(to_light), kLeastDistance);
            const double way = exit_of(slab.box, x, to_light / r).distance;
            arrivals.count = 1;
            arrivals.ways[0] = {to_light / r, x + std::min(way, r) * to_light / r, std::min(way, r),
                                1 / (r * r)};
        }
        if (!sees(lamp, x, counts)) return;
        for (const SlabArrival& way : arrivals) {
            const double cosine = std::clamp(glm::dot(way.to_light, piece.direction), -1.0, 1.0);
            glm::dvec3 sent = slab.scattering * slab.phase.at_cosine(cosine);
            for (const MediumPart& part : media.parts()) {
                sent += part.albedo() * part.density(x) * part.phase().at_cosine(cosine);
            }
            glm::dvec3 gone(0);
            if (attenuates) {
                const glm::dvec3 outside = light.position - way.entry;
                const double r = glm::length(outside);
                gone = slab.extinction * (t + way.inside);
                if (!media.empty()) {
                    gone += media.depth(piece.origin, piece.direction, t) +
                            media.depth(x, way.to_light, way.inside);
                    if (r > 0) gone += media.depth(way.entry, outside / r, r);
                }
            }
            sum += weight * way.irradiance * sent * transmittance_of(gone);
        }
    });
    return light.intensity * sum;
}

glm::dvec3 FastMap::light_slab(const RayPiece& piece, FastCounts& counts) const {
    if (bands_.empty() || !plan_.runs(Effect::airlight_environment)) return glm::dvec3(0);
    ++counts[Effect::airlight_environment];
    const Slab& slab = *piece.slab;
    glm::dvec3 sum(0), mean(0);
    for (int c = 0; c < 3; ++c) {
        mean[c] = bands_[static_cast<std::size_t>(c) * bands_.size() / 3] / std::sqrt(4 * kPi);
    }
    each_slab_node(piece, largest(slab.extinction), [&](double t, double weight) {
        const glm::dvec3 x = piece.origin + t * piece.direction;
        glm::dvec3 left(0);
        for (int side = 0; side < 6; ++side) {
            const int axis = side / 2;
            const double way = std::abs((side % 2 ? slab.box.max : slab.box.min)[axis] - x[axis]);
            left += transmittance_of(slab.extinction * way) / 6.0;
        }
        sum += weight * slab.scattering * left * transmittance_of(slab.extinction * t);
    });
    return slab.ior * slab.ior * mean * sum;
}

// The particle of a cell stands for all of the ray in it, as in viewer/reference_shafts.cpp.
void FastLamps::light_particles(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    const bool runs = plan_.runs(Effect::particles) && !world_.media().empty();
    const ParticleIrradianceTable* const irradiance = runs ? world_.particle_irradiance() : nullptr;
    if (!irradiance) return;
    const SceneMedia& media = world_.media();
    ParticleOptions options;
    options.distribution = world_.scene().shafts->particles;
    const int points = points_of(methods_.particles);
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.bent) continue;
        const double end = std::min(ray.distance, kLongest);
        CellWalk walk(block.origin, ray.direction, options.cell_size);
        glm::dvec3 sum(0);
        for (double begin = 0; begin < end; walk.advance()) {
            const double last = std::min(walk.end(), end);
            if (!(begin < last)) continue;
            const double first = begin, width = (last - begin) / points;
            begin = last;
            const Particle& particle = block.particle(walk.cell, options);
            if (!(particle.weight > 0)) continue;
            glm::dvec3 left(1);
            for (int k = 0; k < points; ++k) {
                const double t = first + (k + 0.5) * width;
                const glm::dvec3 x = block.origin + t * ray.direction;
                const glm::dvec3 place = x + particle.direction * particle.offset;
                if (plan_.runs(Effect::attenuation)) {
                    left = media.transmittance(block.origin, ray.direction, t);
                }
                for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
                    ++counts[Effect::particles];
                    if (!sees(lamp, place, counts)) continue;
                    const PointLight& light = world_.scene().lights[lamp];
                    const double distance =
                        std::max(glm::length(place - light.position), kLeastDistance);
                    const double cosine = std::clamp(
                        glm::dot(glm::normalize(light.position - x), ray.direction), -1.0, 1.0);
                    glm::dvec3 sent(0);
                    for (const MediumPart& part : media.parts()) {
                        sent += part.albedo() * part.density(x) * part.phase().at_cosine(cosine);
                    }
                    sum += width * particle.weight * (*irradiance)(particle.extinction, distance) *
                           light.intensity * sent * left;
                }
            }
            if (largest(left) < 1e-4) break;
        }
        out[i][RadianceLayer::particles] += sum;
    }
}

}  // namespace airlight
