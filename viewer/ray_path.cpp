// SPDX-License-Identifier: Apache-2.0
#include "viewer/ray_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/refraction.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double face_of(const SceneBox& box, const FaceCrossing& face) {
    return face.side > 0 ? box.max[face.axis] : box.min[face.axis];
}

// The direction behind a face that is met at `direction`, and radiance before over that behind.
struct Bend {
    glm::dvec3 direction;
    double radiance;
    bool total;
};

Bend bend(const glm::dvec3& direction, int axis, double ior_before, double ior_behind) {
    const double along = direction[axis];
    const SurfaceCrossing crossing =
        surface_crossing(std::min(1.0, std::abs(along)), ior_before, ior_behind);
    Bend result{direction, 1, crossing.total};
    if (crossing.total) {
        result.direction[axis] = -along;
        return result;
    }
    const double ratio = ior_before / ior_behind;
    result.radiance = crossing.transmittance * ratio * ratio;
    if (ratio == 1) return result;
    result.direction = direction * ratio;
    result.direction[axis] = std::copysign(crossing.cosine, along);
    result.direction = glm::normalize(result.direction);
    return result;
}

}  // namespace

RayPath follow_ray(const World& world, const glm::dvec3& origin, const glm::dvec3& direction,
                   bool attenuate) {
    const SceneSlabs& slabs = world.slabs();
    const auto& environment = world.scene().environment;
    RayPath path;
    RayPiece piece;
    piece.origin = origin;
    piece.direction = direction;
    piece.slab = slabs.at(origin);
    double left = environment ? environment->distance : kInfinite;
    while (path.pieces.size() < kMostPieces) {
        ++path.rays;
        path.hit = world.trace(piece.origin, piece.direction, kInfinite);
        const Slab* next = nullptr;
        FaceCrossing face;
        if (piece.slab) {
            face = exit_of(piece.slab->box, piece.origin, piece.direction);
        } else {
            face.distance = kInfinite;
            for (const Slab& slab : slabs.all()) {
                const auto found = entry_of(slab.box, piece.origin, piece.direction);
                if (!found || !(found->distance < face.distance)) continue;
                face = *found;
                next = &slab;
            }
        }
        const bool crosses = (piece.slab || next) && face.distance < left &&
                             !(path.hit && path.hit->distance <= face.distance);
        piece.distance = crosses ? face.distance : path.hit ? path.hit->distance : left;
        path.pieces.push_back(piece);
        glm::dvec3 throughput = piece.throughput;
        if (attenuate) {
            glm::dvec3 depth = world.media().depth(piece.origin, piece.direction, piece.distance);
            if (piece.slab) depth += piece.slab->extinction * piece.distance;
            throughput *= transmittance_of(depth);
        }
        path.throughput = throughput;
        if (!crosses) return path;
        if (!(std::max({throughput.x, throughput.y, throughput.z}) > 1e-9)) break;
        left -= face.distance;
        const double inside = piece.slab ? piece.slab->ior : next->ior;
        const Bend bent = piece.slab ? bend(piece.direction, face.axis, inside, 1)
                                     : bend(piece.direction, face.axis, 1, inside);
        piece.origin += face.distance * piece.direction;
        piece.origin[face.axis] = face_of(piece.slab ? piece.slab->box : next->box, face);
        piece.direction = bent.direction;
        piece.throughput = throughput * bent.radiance;
        if (!bent.total) piece.slab = next;
    }
    path.hit.reset();
    path.throughput = glm::dvec3(0);
    return path;
}

}  // namespace airlight
