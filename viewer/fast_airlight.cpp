// SPDX-License-Identifier: Apache-2.0
// Light of lamps that media send along rays of view, fast.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "medium/airlight_batch.h"
#include "medium/phase_airlight.h"
#include "medium/quadrature.h"
#include "viewer/fast_lamps.h"
#include "viewer/ray_shadows.h"

namespace airlight {
namespace {

int points_of(FastShafts method) {
    return method == FastShafts::map16 ? 16 : method == FastShafts::map32 ? 32 : 64;
}

}  // namespace

// Of a ray between 0 and `distance`.
void FastLamps::lit(std::size_t lamp, const glm::dvec3& origin, const glm::dvec3& direction,
                    double distance, std::vector<RayInterval>& parts) const {
    const bool shaded = plan_.runs(Effect::shafts) && plan_.lights[lamp].shafts && world_.rays() &&
                        methods_.shafts != FastShafts::unshadowed;
    if (!shaded) {
        parts.assign(1, {0, distance});
    } else if (methods_.shafts == FastShafts::intervals) {
        parts = world_.shadows()->lit(world_.scene().lights[lamp].position, origin, direction,
                                      distance);
    } else {
        shadow_maps_[lamp].lit(origin, direction, distance, points_of(methods_.shafts), parts);
    }
}

void FastLamps::light_media(FastBlock& block, LayeredRadiance* out, FastCounts& counts) const {
    if (!plan_.runs(Effect::airlight_point) || world_.media().empty()) return;
    for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
        if (!plan_.lights[lamp].airlight_point) continue;
        if (!(largest(world_.scene().lights[lamp].intensity) > 0)) continue;
        if (uniform_) {
            light_uniform(lamp, block, out, counts);
        }
    }
}

// Each lit part of a ray as seen from its own beginning, as the reference has it.
void FastLamps::light_uniform(std::size_t lamp, FastBlock& block, LayeredRadiance* out,
                              FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const glm::dvec3 to_light = light.position - block.origin;
    const glm::dvec3 extinction = *world_.media().everywhere();
    struct Part {
        std::uint32_t ray;
        double begin;
    };
    std::vector<Part> parts;
    std::vector<RayInterval> lit_parts;
    auto& [gamma, distance, length, thickness, value] = block.columns;
    gamma.clear();
    distance.clear();
    length.clear();
    for (std::uint32_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.slow) continue;
        ++counts[Effect::airlight_point];
        const double foot = glm::dot(to_light, ray.direction);
        const double height =
            std::max(glm::length(to_light - foot * ray.direction), 1e-9 * (1 + std::abs(foot)));
        lit(lamp, block.origin, ray.direction, ray.distance, lit_parts);
        for (const RayInterval& part : lit_parts) {
            const double near = foot - part.begin;
            parts.push_back({i, part.begin});
            gamma.push_back(std::atan2(static_cast<float>(height), static_cast<float>(near)));
            distance.push_back(static_cast<float>(std::sqrt(height * height + near * near)));
            length.push_back(static_cast<float>(part.end - part.begin));
        }
    }
    const std::size_t count = parts.size();
    const bool grey = extinction.x == extinction.y && extinction.x == extinction.z;
    const bool attenuates = plan_.runs(Effect::attenuation);
    value.resize(count);
    for (const MediumPart& medium : world_.media().parts()) {
        const glm::dvec3 scattering = medium.albedo() * *medium.everywhere();
        if (!(largest(scattering) > 0)) continue;
        for (int c = 0; c < (grey ? 1 : 3); ++c) {
            // Without attenuation a medium so thin that it has none.
            const double sigma = attenuates ? extinction[c] : 1e-9 * extinction[c];
            if (!(sigma > 0)) continue;
            thickness.assign(2 * count, 0);
            for (std::size_t k = 0; k < count; ++k) {
                thickness[k] = static_cast<float>(sigma) * distance[k];
                thickness[count + k] = static_cast<float>(sigma) * length[k];
            }
            if (medium.phase().kind() == PhaseKind::isotropic) {
                airlight_batch(count, gamma.data(), thickness.data(), thickness.data() + count,
                               value.data());
            } else {
                for (std::size_t k = 0; k < count; ++k) {
                    value[k] =
                        static_cast<float>(airlight(double(gamma[k]), double(thickness[k]),
                                                    double(thickness[count + k]), medium.phase()));
                }
            }
            const glm::dvec3 factor = sigma * light.intensity * scattering;
            for (std::size_t k = 0; k < count; ++k) {
                double seen = value[k];
                if (parts[k].begin > 0) seen *= std::exp(-sigma * parts[k].begin);
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
