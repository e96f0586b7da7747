// SPDX-License-Identifier: Apache-2.0
// Light of the environment that media send along rays of view, fast.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "envmap/fog.h"
#include "medium/phase_airlight.h"
#include "sh/lobes.h"
#include "sh/zonal.h"
#include "viewer/environment_sampler.h"
#include "viewer/fast_map.h"
#include "viewer/map_lookup.h"

namespace airlight {
namespace {

// Where rays may end for which endless media have a table, in distances to the map, and its order.
constexpr double kPathEnds[] = {0.02, 0.1, 0.25, 0.45, 0.65, 0.85, 1, 1.25, 2, 5};
constexpr int kPathOrder = 12, kPathNodes = 200;
constexpr double kFogTolerance = 1e-3;

int points_of(FastMapAirlight method) {
    switch (method) {
        case FastMapAirlight::march4:
            return 4;
        case FastMapAirlight::march8:
            return 8;
        case FastMapAirlight::march16:
            return 16;
        case FastMapAirlight::march32:
            break;
    }
    return 32;
}

}  // namespace

void FastMap::build_media(FastCounts& counts) {
    const Image& map = world_.sampler()->map();
    const double reach = world_.scene().environment->distance;
    const double scale = world_.scene().environment->scale;
    for (const MediumPart& part : world_.media().parts()) {
        if (part.everywhere()) continue;
        const PhaseFunction& phase = part.phase();
        source_.emplace_back();
        if (phase.kind() == PhaseKind::isotropic) continue;
        const std::vector<double> of_phase = zonal_eigenvalues(
            [&](double gamma) { return phase.at_angle(gamma); }, kPathOrder, kPathNodes);
        std::vector<double> factors;
        for (std::size_t c = 0; c < 3; ++c) {
            const double mean = bands_[c * bands_.size() / 3] * std::sqrt(1 / (4 * kPi));
            for (const double value : of_phase) factors.push_back(mean > 0 ? value / mean : 0);
        }
        source_.back() = filtered_map(bands_, kPathOrder, 4 * kPathOrder + 1, factors);
        ++counts.tables;
    }
    if (!(largest(uniform_) > 0)) return;

    for (const MediumPart& part : world_.media().parts()) {
        if (!part.everywhere()) continue;
        FogOptions fog;
        fog.tolerance = kFogTolerance;
        fog.phase = part.phase();
        fog.optical_thickness.clear();
        fog.albedo.clear();
        for (int c = 0; c < 3; ++c) {
            const double sigma = uniform_[c];
            fog.optical_thickness.push_back(sigma * reach);
            fog.albedo.push_back(
                sigma > 0 ? std::min(1.0, part.albedo()[c] * (*part.everywhere())[c] / sigma) : 0);
        }
        const Image own = scattered_light(map, plan_fog(map.height, map.width, 3, fog));
        if (scattered_.pixels.empty()) {
            scattered_ = own;
        } else {
            for (std::size_t i = 0; i < own.pixels.size(); ++i) {
                scattered_.pixels[i] += own.pixels[i];
            }
        }
    }
    for (float& value : scattered_.pixels) value *= static_cast<float>(scale);
    ++counts.tables;

    for (const double end : kPathEnds) {
        std::vector<double> factors(3 * static_cast<std::size_t>(kPathOrder), 0);
        for (int c = 0; c < 3; ++c) {
            const double sigma = uniform_[c], t = sigma * reach;
            if (!(t > 0 && t < 700)) continue;
            for (const MediumPart& part : world_.media().parts()) {
                if (!part.everywhere()) continue;
                const double own = part.albedo()[c] * (*part.everywhere())[c] / sigma;
                const std::vector<double> path = zonal_eigenvalues(
                    [&](double gamma) { return t * t * airlight(gamma, t, t * end, part.phase()); },
                    kPathOrder, kPathNodes);
                for (std::size_t l = 0; l < kPathOrder; ++l) {
                    factors[static_cast<std::size_t>(c) * kPathOrder + l] +=
                        own * path[l] / -std::expm1(-t * end);
                }
            }
        }
        path_ends_.push_back(end * reach);
        paths_.push_back(filtered_map(bands_, kPathOrder, 2 * kPathOrder + 1, factors));
        ++counts.tables;
    }
}

// By endless media.
glm::dvec3 FastMap::before_surface(const glm::dvec3& to_map, double distance) const {
    const auto next = std::upper_bound(path_ends_.begin(), path_ends_.end(), distance);
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        next - path_ends_.begin(), 1, static_cast<std::ptrdiff_t>(path_ends_.size()) - 1));
    const double part =
        std::clamp((distance - path_ends_[k - 1]) / (path_ends_[k] - path_ends_[k - 1]), 0.0, 1.0);
    glm::dvec3 sent = (1 - part) * paths_[k - 1](to_map) + part * paths_[k](to_map);
    for (int c = 0; c < 3; ++c) sent[c] *= -std::expm1(-uniform_[c] * distance);
    return sent;
}

// By limited media, in steps of equal lengths. Where their phase functions are not isotropic the
// light that arrives has the map's ratio of them.
glm::dvec3 FastMap::along(const FastRay& ray, const glm::dvec3& origin) const {
    const int steps = points_of(methods_.map_airlight);
    const double reach = world_.scene().environment->distance;
    const double width = std::min(ray.distance, reach) / steps;
    const glm::dvec3 to_map = world_.sampler()->to_map(ray.direction);
    const bool attenuates = plan_.runs(Effect::attenuation);
    glm::dvec3 sum(0), before(0);
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * width;
        const glm::dvec3 x = origin + t * ray.direction;
        const GridMedium medium = grid_(x);
        glm::dvec3 extinction(medium.extinction), scattering(0);
        std::size_t number = 0;
        bool blobs = false;  // those of all parts are one on the grid
        for (const MediumPart& part : world_.media().parts()) {
            if (part.everywhere()) continue;
            const SphereTable& source = source_[number++];
            glm::dvec3 own(medium.scattering);
            if (!part.is_gaussian()) {
                const glm::dvec3 density = part.density(x);
                extinction += density;
                own = part.albedo() * density;
            } else if (blobs) {
                continue;
            } else {
                blobs = true;
            }
            scattering += source.empty() ? own : own * source(to_map);
        }
        if (!(largest(scattering) > 0)) continue;
        for (int c = 0; c < 3; ++c) {
            const double own = extinction[c] * width;
            double left = 1;
            if (attenuates) {
                left = std::exp(-before[c] - uniform_[c] * (t + reach));
                if (own > 1e-6) left *= -std::expm1(-own) / own;
            }
            sum[c] += scattering[c] * width * left * double(medium.arriving[c]);
        }
        before += extinction * width;
    }
    return sum;
}

void FastMap::light_media(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    if (source_.empty() && paths_.empty()) return;
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.bent) continue;
        ++counts[Effect::airlight_environment];
        glm::dvec3& sum = out[i][RadianceLayer::airlight_environment];
        if (!paths_.empty()) {
            const glm::dvec3 to_map = world_.sampler()->to_map(ray.direction);
            sum += ray.meets ? before_surface(to_map, ray.distance)
                             : glm::dvec3(look_up(scattered_, to_map));
        }
        if (!source_.empty()) sum += along(ray, block.origin);
    }
}

}  // namespace airlight
