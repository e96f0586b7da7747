// SPDX-License-Identifier: Apache-2.0
// The light that particles in shafts send along a ray.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/quadrature.h"
#include "medium/shafts.h"
#include "viewer/cell_walk.h"
#include "viewer/reference.h"

namespace airlight {
namespace {

constexpr double kLongest = 1e4, kLeastDistance = 1e-3;  // [m]

double least(const glm::dvec3& v) {
    return std::min({v.x, v.y, v.z});
}

}  // namespace

// The particle of a cell stands for all of the ray in it, moved by its offset ([Shafts] eq. 4), so
// that within a cell the light changes smoothly between the borders of shadows.
glm::dvec3 ReferenceRenderer::particles_along(const RayPiece& piece,
                                              ReferenceCounts& counts) const {
    const SceneMedia& media = world_.media();
    const ParticleIrradianceTable* const irradiance = world_.particle_irradiance();
    if (!irradiance || media.empty() || piece.slab) return glm::dvec3(0);
    ParticleOptions particles;
    particles.distribution = world_.scene().shafts->particles;
    const double deepest = -std::log(0.1 * options_.quadrature);
    double end = std::min(piece.distance, kLongest);
    const auto beyond = [&](double t) {
        return least(media.depth(piece.origin, piece.direction, t)) > deepest;
    };
    if (beyond(end)) {
        double near = 0;
        for (int i = 0; i < 30; ++i) {
            const double middle = 0.5 * (near + end);
            (beyond(middle) ? end : near) = middle;
        }
    }
    const detail::QuadratureRule rule = detail::gauss_legendre(6);
    CellWalk walk(piece.origin, piece.direction, particles.cell_size);
    glm::dvec3 sum(0);
    for (double begin = 0; begin < end; walk.advance()) {
        const double last = std::min(walk.end(), end);
        if (!(begin < last)) continue;
        const double length = last - begin;
        const glm::dvec3 start = piece.origin + begin * piece.direction;
        const double first = begin;
        begin = last;
        const Particle particle =
            particle_in_cell(walk.cell[0], walk.cell[1], walk.cell[2], particles);
        if (!(particle.weight > 0)) continue;
        const glm::dvec3 moved = start + particle.direction * particle.offset;
        for (const PointLight& light : world_.scene().lights) {
            std::vector<RayInterval> lit = {{0, length}};
            if (options_.shadows_in_media && world_.shadows()) {
                world_.shadows()->lit(light.position, moved, piece.direction, length, lit);
            }
            const double foot = glm::dot(light.position - moved, piece.direction);
            const double height = std::max(
                glm::length(light.position - moved - foot * piece.direction), kLeastDistance);
            const auto at_angle = [&](double u) {
                ++counts.line_points;
                const double tangent = std::tan(u);
                const double t = foot + height * tangent;
                const glm::dvec3 x = start + t * piece.direction;
                const double distance = std::max(
                    glm::length(moved + t * piece.direction - light.position), kLeastDistance);
                const glm::dvec3 sent =
                    scattered(x, glm::normalize(x - light.position), -piece.direction);
                return sent * media.transmittance(piece.origin, piece.direction, first + t) *
                       ((*irradiance)(particle.extinction, distance) * height *
                        (1 + tangent * tangent));
            };
            for (const RayInterval& part : lit) {
                const double a = std::atan((part.begin - foot) / height);
                const double b = std::atan((part.end - foot) / height);
                const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
                glm::dvec3 integral(0);
                for (int i = 0; i < rule.count; ++i) {
                    const double offset = half * rule.nodes[i].x;
                    integral +=
                        rule.nodes[i].w * (at_angle(middle - offset) + at_angle(middle + offset));
                }
                sum += particle.weight * half * light.intensity * integral;
            }
        }
    }
    return sum;
}

glm::dvec3 ReferenceRenderer::light_of_particles(const glm::dvec3& origin,
                                                 const glm::dvec3& direction, double distance,
                                                 ReferenceCounts& counts) const {
    return particles_along({origin, direction, distance, nullptr, glm::dvec3(1)}, counts);
}

}  // namespace airlight
