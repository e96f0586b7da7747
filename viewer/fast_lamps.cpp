// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_lamps.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "prt/ray_packets.h"
#include "viewer/fast_arrival.h"
#include "viewer/material.h"
#include "viewer/surface_lobes.h"

namespace airlight {
namespace {

// Of G_n's tables (medium/surface_batch.h).
constexpr double kLeastExponent = 1, kLargestExponent = 1000;
// fogshop takes the square of their number to build.
constexpr std::size_t kMostBlobs = 512;
constexpr double kDensest = 1e100;

double clamped_exponent(double exponent) {
    return std::clamp(exponent, kLeastExponent, kLargestExponent);
}

// Points on a side of a table.
int size_of(FastSurfacePoint method) {
    switch (method) {
        case FastSurfacePoint::gn16:
            return 16;
        case FastSurfacePoint::gn24:
            return 24;
        case FastSurfacePoint::none:
        case FastSurfacePoint::gn48:
        case FastSurfacePoint::rings:
            break;
    }
    return 48;
}

// With 512, of which fewer are in a processor's own cache, pictures took 1.2 to 1.5 times as long,
// planned at no smaller errors; with 256 three balls on a floor took to intervals, at half the
// speed.
int shadow_map_size(const Scene& scene) {
    return scene.shafts ? std::min(scene.shafts->shadow_map, 1024) : 320;
}

}  // namespace

FastLamps::FastLamps(const World& world, const Plan& plan, const FastMethods& methods,
                     FastCounts& counts)
    : world_(world), plan_(plan), methods_(methods) {
    const Scene& scene = world.scene();
    const auto wanted = [&](bool LampPlan::*part) {
        return std::any_of(plan.lights.begin(), plan.lights.end(),
                           [&](const LampPlan& lamp) { return lamp.*part; });
    };
    if (plan.runs(Effect::surface_point) && wanted(&LampPlan::surface) &&
        methods.surface_point != FastSurfacePoint::none && !scene.objects.empty()) {
        const int size = size_of(methods.surface_point);
        lobes_.push_back(std::make_unique<SurfaceBatchTable>(1, size));
        for (std::size_t i = 0; i < scene.objects.size(); ++i) {
            lobe_of_object_.push_back(0);
            materials_.push_back(lobes_of(world.material(i)));
            if (!materials_[i].glossy() || !plan.objects[i].glossy) continue;
            const double exponent = clamped_exponent(materials_[i].exponent);
            for (std::size_t k = 0; k < lobes_.size(); ++k) {
                if (lobes_[k]->exponent() == exponent) lobe_of_object_[i] = k;
            }
            if (lobes_[lobe_of_object_[i]]->exponent() == exponent) continue;
            lobe_of_object_[i] = lobes_.size();
            lobes_.push_back(std::make_unique<SurfaceBatchTable>(exponent, size));
        }
        counts.tables += lobes_.size();
    }
    build_fogshop(counts);
    const bool mapped =
        methods.shafts != FastShafts::unshadowed && methods.shafts != FastShafts::intervals;
    if (plan.runs(Effect::shafts) && mapped && world.rays()) {
        shadow_maps_.resize(scene.lights.size());
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            if (!plan.lights[i].shafts) continue;
            shadow_maps_[i] =
                LampShadowMap(*world.rays(), scene.lights[i].position, shadow_map_size(scene));
            ++counts.tables;
        }
    }
}

// For Gaussians without borders over at most one other medium, the same everywhere, all isotropic.
void FastLamps::build_fogshop(FastCounts& counts) {
    const bool asked = methods_.gaussians == FastGaussians::fogshop ||
                       methods_.gaussians == FastGaussians::centroid;
    if (!asked || !plan_.runs(Effect::airlight_gaussians)) return;
    GaussianMedium medium;
    glm::dvec3 uniform(0), scattering(0);
    std::size_t gaussians = 0;
    for (const MediumPart& part : world_.media().parts()) {
        if (part.phase().kind() != PhaseKind::isotropic || part.bounds()) return;
        if (part.everywhere()) {
            uniform += *part.everywhere();
            scattering += part.albedo() * *part.everywhere();
        } else if (part.is_gaussian() && ++gaussians == 1 && part.blobs().size() <= kMostBlobs) {
            medium.blobs = part.blobs();
            gaussians_albedo_ = part.albedo();
        } else {
            return;
        }
    }
    if (gaussians == 0) return;
    const auto& blobs = medium.blobs;
    const glm::dvec3& eye = world_.scene().camera.position;
    for (int c = 0; c < 3; ++c) {
        uniform_albedo_[c] = uniform[c] > 0 ? scattering[c] / uniform[c] : 0;
    }
    const bool grey = uniform.x == uniform.y && uniform.x == uniform.z;
    const auto method = methods_.gaussians == FastGaussians::fogshop
                            ? GaussianAirlightMethod::fogshop
                            : GaussianAirlightMethod::centroid;
    for (const PointLight& light : world_.scene().lights) {
        fogshop_.emplace_back();
        // A lamp at the eye has no finite airlight.
        if (!(glm::length(light.position - eye) > 1e-9 * (1 + largest(glm::abs(eye))))) continue;
        if (!std::all_of(blobs.begin(), blobs.end(), [&](const GaussianBlob& blob) {
                return detail::in_airlight_domain(blob, eye, light.position);
            })) {
            continue;
        }
        for (int c = 0; c < (grey ? 1 : 3); ++c) {
            medium.beta0 = uniform[c];
            fogshop_.back().emplace_back(method, medium, world_.scene().camera.position,
                                         light.position);
            ++counts.tables;
        }
    }
}

glm::dvec3 FastLamps::depth(const glm::dvec3& from, const glm::dvec3& direction,
                            double distance) const {
    if (!plan_.runs(Effect::attenuation)) return glm::dvec3(0);
    glm::dvec3 depth = world_.media().depth(from, direction, distance);
    if (!world_.slabs().empty()) depth += world_.slabs().depth(from, direction, distance);
    return depth;
}

void FastLamps::light_surfaces(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    if (block.hits.empty()) return;
    std::vector<Arrival> arrivals;
    for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
        const PointLight& light = world_.scene().lights[lamp];
        if (!(largest(light.intensity) > 0)) continue;
        arrivals.clear();
        for (const std::uint32_t i : block.hits) {
            const FastRay& ray = block.rays[i];
            const glm::dvec3 to_light = light.position - ray.hit.position;
            const double r = glm::length(to_light);
            if (!(r > 0)) continue;
            Arrival arrival;
            arrival.ray = i;
            arrival.distance = r;
            arrival.to_light = to_light / r;
            arrival.above = glm::dot(to_light, ray.hit.face) > 0;
            arrivals.push_back(arrival);
        }
        const bool scatters = !lobes_.empty() && plan_.lights[lamp].surface;
        if (!world_.media().empty() || !world_.slabs().empty()) {
            for (Arrival& arrival : arrivals) {
                if (!arrival.above && !scatters) continue;
                arrival.depth =
                    depth(block.rays[arrival.ray].hit.position, arrival.to_light, arrival.distance);
            }
        }
        add_direct(lamp, block, arrivals, out, counts);
        if (scatters) add_scattered(lamp, block, arrivals, out, counts);
        if (scatters && methods_.surface_point == FastSurfacePoint::rings) {
            add_rings(lamp, block, arrivals, out, counts);
        }
    }
}

void FastLamps::add_direct(std::size_t lamp, FastBlock& block, std::vector<Arrival>& arrivals,
                           const RaySums& out, FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    std::vector<std::uint32_t> asked;
    block.points.clear();
    for (std::uint32_t k = 0; k < arrivals.size(); ++k) {
        const Arrival& arrival = arrivals[k];
        const FastRay& ray = block.rays[arrival.ray];
        if (!arrival.above || !(glm::dot(ray.hit.normal, arrival.to_light) > 0)) continue;
        asked.push_back(k);
        block.points.push_back(ray.from);
    }
    if (asked.empty()) return;
    block.blocked.resize(asked.size());
    find_blocked_packets(*world_.rays(), asked.size(), block.points.data(), light.position,
                         block.blocked.data());
    counts.shadow_rays += asked.size();
    for (std::size_t k = 0; k < asked.size(); ++k) {
        if (block.blocked[k]) continue;
        const Arrival& arrival = arrivals[asked[k]];
        const FastRay& ray = block.rays[arrival.ray];
        const glm::dvec3 f = reflect(world_.material(ray.hit.object), ray.hit.normal,
                                     -ray.direction, arrival.to_light);
        out[arrival.ray][RadianceLayer::direct] += ray.transmittance * f * light.intensity /
                                                   (arrival.distance * arrival.distance) *
                                                   transmittance_of(arrival.depth);
    }
}

// medium/surface_shading.h, with the mean extinction and scattering of the way to the lamp as
// [Zhou07] sec. 4.1 has it. Diffuse parts go by G_1 about the normal, lobes by G_n about the
// mirrored view.
void FastLamps::add_scattered(std::size_t lamp, FastBlock& block,
                              const std::vector<Arrival>& arrivals, const RaySums& out,
                              FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const SceneMedia& media = world_.media();
    std::vector<std::uint32_t> chosen;
    std::vector<glm::dvec3> factors;  // reflectance * sigma_s
    auto& [thickness, chord, value, spare, unused] = block.columns;
    glm::dvec3 everywhere(0);
    for (const MediumPart& part : media.parts()) {
        if (part.everywhere()) everywhere += part.albedo() * *part.everywhere();
    }
    for (std::size_t lobe = 0; lobe < lobes_.size(); ++lobe) {
        const double n = lobes_[lobe]->exponent();
        chosen.clear();
        factors.clear();
        chord.clear();
        for (std::uint32_t k = 0; k < arrivals.size(); ++k) {
            const Arrival& arrival = arrivals[k];
            const FastRay& ray = block.rays[arrival.ray];
            const SurfaceLobes& lobes = materials_[ray.hit.object];
            glm::dvec3 reflectance(0), axis = ray.hit.normal;
            if (lobe == 0 && methods_.surface_point != FastSurfacePoint::rings) {
                reflectance = lobes.diffuse / kPi;
            }
            if (lobe > 0 && lobe_of_object_[ray.hit.object] == lobe) {
                reflectance = (n + 1) / (2 * kPi) * lobes.specular;
                axis = ray.direction - 2 * glm::dot(ray.hit.normal, ray.direction) * ray.hit.normal;
            }
            if (!(largest(reflectance) > 0)) continue;
            glm::dvec3 scattering = everywhere;
            for (const MediumPart& part : media.parts()) {
                if (part.everywhere()) continue;
                scattering += part.albedo() *
                              part.depth(ray.hit.position, arrival.to_light, arrival.distance) /
                              arrival.distance;
            }
            // Nothing comes through endless depths.
            if (!media.everywhere()) scattering = glm::min(scattering, kDensest);
            const glm::dvec3 between = axis - arrival.to_light;
            chosen.push_back(k);
            chord.push_back(std::min(1.0f, static_cast<float>(0.25 * glm::dot(between, between))));
            factors.push_back(reflectance * scattering / (2 * kPi * arrival.distance) *
                              light.intensity * ray.transmittance);
        }
        if (chosen.empty()) continue;
        counts[Effect::surface_point] += chosen.size();
        value.resize(chosen.size());
        thickness.resize(chosen.size());
        bool grey = true;
        for (int c = 0; c < (grey ? 1 : 3); ++c) {
            for (std::size_t k = 0; k < chosen.size(); ++k) {
                const glm::dvec3& depth = arrivals[chosen[k]].depth;
                grey = grey && depth.x == depth.y && depth.x == depth.z;
                thickness[k] = static_cast<float>(depth[c]);
            }
            lobes_[lobe]->surface_batch_by_chord(chosen.size(), thickness.data(), chord.data(),
                                                 value.data());
            for (std::size_t k = 0; k < chosen.size(); ++k) {
                glm::dvec3& sum = out[arrivals[chosen[k]].ray][RadianceLayer::surface_point];
                if (grey) {
                    sum += double(value[k]) * factors[k];
                } else {
                    sum[c] += double(value[k]) * factors[k][c];
                }
            }
        }
    }
}

}  // namespace airlight
