// SPDX-License-Identifier: Apache-2.0
// Light of lamps that media send along rays of view, fast.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "medium/airlight_batch.h"
#include "medium/phase_airlight.h"
#include "viewer/axes.h"
#include "viewer/fast_lamps.h"
#include "viewer/medium_depths.h"
#include "viewer/ray_nodes.h"
#include "viewer/ray_shadows.h"

namespace airlight {
namespace {

int points_of(FastShafts method) {
    return method == FastShafts::map16 ? 16 : method == FastShafts::map32 ? 32 : 64;
}

RaySpan within(const RaySpan& span, const RaySpan& part) {
    const RaySpan both{std::max(span.near, part.near), std::min(span.far, part.far)};
    return both.near < both.far ? both : part;
}

int nodes_of(const FastMethods& methods, bool gaussians) {
    if (!gaussians) {
        return methods.airlight == FastAirlight::mixed_gl8    ? 8
               : methods.airlight == FastAirlight::mixed_gl16 ? 16
                                                              : 32;
    }
    return methods.gaussians == FastGaussians::mixed_gl8    ? 8
           : methods.gaussians == FastGaussians::mixed_gl16 ? 16
                                                            : 32;
}

// A ray through a lamp diverges there; the rounding of coordinates keeps it off.
glm::dvec3 beside(const glm::dvec3& to_light, const glm::dvec3& direction) {
    const double foot = glm::dot(to_light, direction), least = 1e-9 * (1 + std::abs(foot));
    if (!(foot > 0 && glm::length(to_light - foot * direction) < least)) return direction;
    glm::dvec3 x, y;
    make_axes(direction, x, y);
    return glm::normalize(foot * direction + least * x);
}

}  // namespace

// Of the rays that are not bent, to block.lit.
void FastLamps::find_lit(std::size_t lamp, FastBlock& block) const {
    block.lit.clear();
    const bool shaded = plan_.runs(Effect::shafts) && plan_.lights[lamp].shafts && world_.rays() &&
                        methods_.shafts != FastShafts::unshadowed;
    if (shaded && methods_.shafts != FastShafts::intervals) {
        shadow_maps_[lamp].lit(block.origin, block.straight, points_of(methods_.shafts), block.lit);
        return;
    }
    std::vector<RayInterval> parts;
    for (std::uint32_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.bent) continue;
        if (!shaded) {
            block.lit.push_back({i, 0, ray.distance});
            continue;
        }
        world_.shadows()->lit(world_.scene().lights[lamp].position, block.origin, ray.direction,
                              ray.distance, parts);
        for (const RayInterval& part : parts) block.lit.push_back({i, part.begin, part.end});
    }
}

void FastLamps::light_media(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    if (world_.media().empty()) return;
    for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
        const bool gaussians = plan_.runs(Effect::airlight_gaussians) &&
                               plan_.lights[lamp].airlight_gaussians && world_.media().any(true);
        const bool others = plan_.runs(Effect::airlight_point) &&
                            plan_.lights[lamp].airlight_point && world_.media().any(false);
        if (!gaussians && !others) continue;
        if (!(largest(world_.scene().lights[lamp].intensity) > 0)) continue;
        if (world_.media().everywhere() && !plan_.everything) {
            light_uniform(lamp, block, out, counts);
        } else if (gaussians && !fogshop_.empty() && !fogshop_[lamp].empty()) {
            light_fogshop(lamp, others, block, out, counts);
        } else {
            light_varying(lamp, gaussians, others, block, out, counts);
        }
    }
}

// [Zhou07] eq. 8 to 17 for each channel, the same for all where all media are grey.
void FastLamps::light_fogshop(std::size_t lamp, bool others, FastBlock& block, const RaySums& out,
                              FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const std::vector<GaussianAirlightEvaluator>& channels = fogshop_[lamp];
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.bent) continue;
        ++counts[Effect::airlight_gaussians];
        if (others) ++counts[Effect::airlight_point];
        const glm::dvec3 direction = beside(light.position - block.origin, ray.direction);
        FogshopAirlight parts;
        for (std::size_t c = 0; c < 3; ++c) {
            if (c < channels.size()) parts = channels[c].parts(direction, ray.distance);
            const int channel = static_cast<int>(c);
            out[i][RadianceLayer::airlight_gaussians][channel] +=
                gaussians_albedo_[channel] * light.intensity[channel] * parts.gaussians;
            if (others) {
                out[i][RadianceLayer::airlight_point][channel] +=
                    uniform_albedo_[channel] * light.intensity[channel] * parts.uniform;
            }
        }
    }
}

void FastLamps::light_varying(std::size_t lamp, bool gaussians, bool others, FastBlock& block,
                              const RaySums& out, FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const SceneMedia& media = world_.media();
    const int count = nodes_of(methods_, gaussians);
    const bool attenuates = plan_.runs(Effect::attenuation);
    MediumDepths depths(media);
    find_lit(lamp, block);
    auto part = block.lit.begin();
    std::vector<RayNode> nodes;
    std::vector<glm::dvec3> points, to_lamp, origins, directions, depth, lamp_depth;
    std::vector<double> distances, places;
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.bent) continue;
        if (gaussians) ++counts[Effect::airlight_gaussians];
        if (others) ++counts[Effect::airlight_point];
        const auto first = part;
        while (part != block.lit.end() && part->ray == i) ++part;
        auto span =
            span_of_media(media, MediumExtent::any, block.origin, ray.direction, ray.distance);
        if (!span) continue;
        const auto dense =
            span_of_media(media, MediumExtent::limited, block.origin, ray.direction, ray.distance);
        const bool dims = end_of_light(depths, light.position, block.origin, ray.direction, *span);
        glm::dvec3 of_gaussians(0), of_others(0);
        for (auto lit = first; lit != part; ++lit) {
            const RaySpan reach{std::max(lit->begin, span->near), std::min(lit->end, span->far)};
            if (!(reach.near < reach.far)) continue;
            ray_nodes(media, light.position, block.origin, ray.direction, reach,
                      within(dense.value_or(reach), reach), dims, count, nodes);
            const std::size_t n = nodes.size();
            points.resize(n);
            to_lamp.resize(n);
            distances.resize(n);
            places.resize(n);
            depth.assign(n, glm::dvec3(0));
            lamp_depth.assign(n, glm::dvec3(0));
            origins.assign(n, block.origin);
            directions.assign(n, ray.direction);
            for (std::size_t k = 0; k < n; ++k) {
                places[k] = nodes[k].t;
                points[k] = block.origin + nodes[k].t * ray.direction;
                to_lamp[k] = light.position - points[k];
                distances[k] = std::max(glm::length(to_lamp[k]), 1e-12);
                to_lamp[k] /= distances[k];
            }
            if (attenuates) {
                depths(n, origins.data(), directions.data(), places.data(), depth.data());
                depths(n, points.data(), to_lamp.data(), distances.data(), lamp_depth.data());
            }
            for (std::size_t k = 0; k < n; ++k) {
                const glm::dvec3 arriving = transmittance_of(depth[k] + lamp_depth[k]) *
                                            (nodes[k].weight / (distances[k] * distances[k]));
                const double cosine = std::clamp(glm::dot(to_lamp[k], ray.direction), -1.0, 1.0);
                for (const MediumPart& medium : media.parts()) {
                    if (!(medium.is_gaussian() ? gaussians : others)) continue;
                    const glm::dvec3 sent = medium.albedo() * medium.density(points[k]) *
                                            medium.phase().at_cosine(cosine) * arriving;
                    (medium.is_gaussian() ? of_gaussians : of_others) += sent;
                }
            }
        }
        out[i][RadianceLayer::airlight_gaussians] += light.intensity * of_gaussians;
        out[i][RadianceLayer::airlight_point] += light.intensity * of_others;
    }
}

// Each lit part of a ray as seen from its own beginning, as the reference has it.
void FastLamps::light_uniform(std::size_t lamp, FastBlock& block, const RaySums& out,
                              FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const glm::dvec3 to_light = light.position - block.origin;
    const glm::dvec3 extinction = *world_.media().everywhere();
    find_lit(lamp, block);
    const std::vector<LitPart>& parts = block.lit;
    auto& [foot, height, begin, length, value] = block.columns;
    const std::size_t count = parts.size();
    for (std::vector<float>* column : {&foot, &height, &begin, &length, &value}) {
        column->resize(count);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3& direction = block.rays[parts[k].ray].direction;
        const double ahead = glm::dot(to_light, direction);
        const double off = glm::length(to_light - ahead * direction);
        foot[k] = static_cast<float>(ahead - parts[k].begin);
        height[k] = static_cast<float>(std::max(off, kLeastHeight * (1 + std::abs(ahead))));
        begin[k] = static_cast<float>(parts[k].begin);
        length[k] = static_cast<float>(parts[k].end - parts[k].begin);
    }
    for (const FastRay& ray : block.rays) counts[Effect::airlight_point] += ray.bent ? 0 : 1;
    const bool grey = extinction.x == extinction.y && extinction.x == extinction.z;
    const bool attenuates = plan_.runs(Effect::attenuation);
    for (const MediumPart& medium : world_.media().parts()) {
        const glm::dvec3 scattering = medium.albedo() * *medium.everywhere();
        if (!(largest(scattering) > 0)) continue;
        for (int c = 0; c < (grey ? 1 : 3); ++c) {
            // Without attenuation a medium so thin that it has none.
            const double sigma = attenuates ? extinction[c] : 1e-9 * extinction[c];
            if (!(sigma > 0)) continue;
            if (medium.phase().kind() == PhaseKind::isotropic) {
                airlight_parts_batch(count, static_cast<float>(sigma), foot.data(), height.data(),
                                     begin.data(), length.data(), value.data());
            } else {
                for (std::size_t k = 0; k < count; ++k) {
                    const double ahead = foot[k], off = height[k];
                    const double seen =
                        airlight(std::atan2(off, ahead), sigma * std::hypot(off, ahead),
                                 sigma * double(length[k]), medium.phase());
                    value[k] = static_cast<float>(std::exp(-sigma * parts[k].begin) * seen);
                }
            }
            const glm::dvec3 factor = sigma * light.intensity * scattering;
            for (std::size_t k = 0; k < count; ++k) {
                const double seen = value[k];
                glm::dvec3& sum = out[parts[k].ray][RadianceLayer::airlight_point];
                if (grey) {
                    sum += seen * factor;
                } else {
                    sum[c] += seen * factor[c];
                }
            }
        }
    }
}

}  // namespace airlight
