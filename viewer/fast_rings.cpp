// SPDX-License-Identifier: Apache-2.0
// Light of lamps that media of any shape send onto diffuse surfaces, fast.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/constants.h"
#include "medium/quadrature.h"
#include "viewer/axes.h"
#include "viewer/fast_arrival.h"
#include "viewer/fast_lamps.h"
#include "viewer/medium_depths.h"
#include "viewer/ray_nodes.h"

namespace airlight {
namespace {

constexpr int kAzimuths = 6, kAngles = 6, kNodes = 8;
constexpr double kLeastDistance = 1e-12;

}  // namespace

// Directions by their angle to the lamp, of which the solid angle takes away what the airlight is
// 1 / sin of, on each half plane about it as far as the normal sees: there the sum of normal and
// direction is R cos(angle - middle).
void FastLamps::add_rings(std::size_t lamp, FastBlock& block, const std::vector<Arrival>& arrivals,
                          const RaySums& out, FastCounts& counts) const {
    const PointLight& light = world_.scene().lights[lamp];
    const SceneMedia& media = world_.media();
    const detail::QuadratureRule rule = detail::gauss_legendre(kAngles);
    const double infinite = std::numeric_limits<double>::infinity();
    MediumDepths depths(media);
    std::vector<RayNode> nodes;
    std::vector<glm::dvec3> origins, directions, points, to_lamp, depth, lamp_depth;
    std::vector<double> places, distances, weights;
    for (const Arrival& arrival : arrivals) {
        const FastRay& ray = block.rays[arrival.ray];
        const glm::dvec3& diffuse = materials_[ray.hit.object].diffuse;
        if (!(largest(diffuse) > 0)) continue;
        ++counts[Effect::surface_point];
        const glm::dvec3 &normal = ray.hit.normal, &axis = arrival.to_light;
        glm::dvec3 x, y;
        make_axes(axis, x, y);
        for (std::vector<glm::dvec3>* const column : {&origins, &directions, &points, &to_lamp}) {
            column->clear();
        }
        for (std::vector<double>* const column : {&places, &distances, &weights}) column->clear();
        const auto look = [&](const glm::dvec3& direction, double weight) {
            if (!(glm::dot(direction, ray.hit.face) > 0)) return;
            auto span =
                span_of_media(media, MediumExtent::any, ray.hit.position, direction, infinite);
            if (!span) return;
            bool dims = false;
            if (!std::isfinite(span->far)) {
                dims = end_of_light(depths, light.position, ray.hit.position, direction, *span);
            }
            RaySpan dense =
                span_of_media(media, MediumExtent::limited, ray.hit.position, direction, span->far)
                    .value_or(*span);
            dense.near = std::max(dense.near, span->near);
            if (!(dense.near < dense.far)) dense = *span;
            ray_nodes(media, light.position, ray.hit.position, direction, *span, dense, dims,
                      kNodes, nodes);
            for (const RayNode& node : nodes) {
                const glm::dvec3 point = ray.hit.position + node.t * direction;
                const glm::dvec3 way = light.position - point;
                const double length = std::max(glm::length(way), kLeastDistance);
                origins.push_back(ray.hit.position);
                directions.push_back(direction);
                places.push_back(node.t);
                points.push_back(point);
                distances.push_back(length);
                to_lamp.push_back(way / length);
                weights.push_back(weight * node.weight / (length * length));
            }
        };
        for (int k = 0; k < kAzimuths; ++k) {
            const double azimuth = 2 * kPi * (k + 0.5) / kAzimuths;
            const glm::dvec3 across = std::cos(azimuth) * x + std::sin(azimuth) * y;
            const double middle = std::atan2(glm::dot(across, normal), glm::dot(axis, normal));
            for (const double turn : {0.0, 2 * kPi}) {
                const double low = std::max(0.0, middle + turn - 0.5 * kPi);
                const double high = std::min(kPi, middle + turn + 0.5 * kPi);
                for (int i = 0; low < high && i < 2 * rule.count; ++i) {
                    const detail::QuadratureNode& node = rule.nodes[i / 2];
                    const double part = 0.5 + (i % 2 == 0 ? -0.5 : 0.5) * node.x;
                    const double angle = low + part * (high - low);
                    const glm::dvec3 direction = std::sin(angle) * across + std::cos(angle) * axis;
                    look(direction, 0.5 * node.w * (high - low) * (2 * kPi / kAzimuths) *
                                        std::sin(angle) * glm::dot(direction, normal));
                }
            }
        }
        const std::size_t count = points.size();
        depth.assign(count, glm::dvec3(0));
        lamp_depth.assign(count, glm::dvec3(0));
        if (plan_.runs(Effect::attenuation)) {
            depths(count, origins.data(), directions.data(), places.data(), depth.data());
            depths(count, points.data(), to_lamp.data(), distances.data(), lamp_depth.data());
        }
        glm::dvec3 sum(0);
        for (std::size_t k = 0; k < count; ++k) {
            const glm::dvec3 arriving = transmittance_of(depth[k] + lamp_depth[k]) * weights[k];
            if (!(largest(arriving) > 0)) continue;
            const double cosine = std::clamp(glm::dot(to_lamp[k], directions[k]), -1.0, 1.0);
            for (const MediumPart& medium : media.parts()) {
                sum += medium.albedo() * medium.density(points[k]) *
                       medium.phase().at_cosine(cosine) * arriving;
            }
        }
        out[arrival.ray][RadianceLayer::surface_point] +=
            ray.transmittance * light.intensity * diffuse / kPi * sum;
    }
}

}  // namespace airlight
