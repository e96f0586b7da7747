// SPDX-License-Identifier: Apache-2.0
#include "viewer/slabs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"
#include "medium/refracted_path.h"
#include "medium/refraction.h"
#include "viewer/scene_media.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool within_face(const SceneBox& box, int axis, const glm::dvec3& x) {
    for (int other = 0; other < 3; ++other) {
        if (other != axis && !(x[other] >= box.min[other] && x[other] <= box.max[other])) {
            return false;
        }
    }
    return true;
}

bool contains(const SceneBox& box, const glm::dvec3& x) {
    return within_face(box, 3, x);
}

// Of index 1: the surface is not there.
SlabArrivals straight(const Slab& slab, const glm::dvec3& x, const glm::dvec3& to_light,
                      double distance, double irradiance) {
    SlabArrivals result;
    SlabArrival& way = result.ways[0];
    way.to_light = to_light;
    way.inside = std::min(exit_of(slab.box, x, to_light).distance, distance);
    way.entry = x + way.inside * to_light;
    way.irradiance = irradiance;
    result.count = 1;
    return result;
}

}  // namespace

std::optional<FaceCrossing> entry_of(const SceneBox& box, const glm::dvec3& origin,
                                     const glm::dvec3& direction) {
    const auto span = clip_to_box(box, origin, direction, kInfinite);
    if (!span) return {};
    FaceCrossing found;
    found.distance = -kInfinite;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const double side = direction[axis] > 0 ? -1 : 1;
        const double plane = side > 0 ? box.max[axis] : box.min[axis];
        const double t = (plane - origin[axis]) / direction[axis];
        if (t > found.distance) found = {t, axis, side};
    }
    if (!(found.distance >= 0)) return {};
    return found;
}

FaceCrossing exit_of(const SceneBox& box, const glm::dvec3& origin, const glm::dvec3& direction) {
    FaceCrossing found;
    found.distance = kInfinite;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const double side = direction[axis] > 0 ? 1 : -1;
        const double plane = side > 0 ? box.max[axis] : box.min[axis];
        const double t = std::max(0.0, (plane - origin[axis]) / direction[axis]);
        if (t < found.distance) found = {t, axis, side};
    }
    return found;
}

SlabArrivals arrivals_of_point(const Slab& slab, const glm::dvec3& x, const glm::dvec3& light) {
    SlabArrivals result;
    const glm::dvec3 way = light - x;
    const double r = glm::length(way);
    if (!(r > 0)) return result;
    if (slab.ior == 1 || contains(slab.box, light)) {
        return straight(slab, x, way / r, r, 1 / (r * r));
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double side = light[axis] > slab.box.max[axis]   ? 1
                            : light[axis] < slab.box.min[axis] ? -1
                                                               : 0;
        if (side == 0) continue;
        const double plane = side > 0 ? slab.box.max[axis] : slab.box.min[axis];
        glm::dvec3 along = way;
        along[axis] = 0;
        const double across = glm::length(along);
        const double depth = std::max(0.0, side * (plane - x[axis]));
        const RefractedPath path =
            refracted_path(side * (light[axis] - plane), depth, across, 1, slab.ior);
        if (!path.exists) continue;
        const double sine = std::sqrt((1 - path.cosine_below) * (1 + path.cosine_below));
        SlabArrival arrival;
        arrival.to_light = across > 0 ? along * (sine / across) : glm::dvec3(0);
        arrival.to_light[axis] = side * path.cosine_below;
        arrival.inside = path.below;
        arrival.entry = x + path.below * arrival.to_light;
        arrival.entry[axis] = plane;
        if (!within_face(slab.box, axis, arrival.entry)) continue;
        arrival.irradiance = path.irradiance;
        result.ways[static_cast<std::size_t>(result.count++)] = arrival;
    }
    return result;
}

SlabArrivals arrivals_of_direction(const Slab& slab, const glm::dvec3& x,
                                   const glm::dvec3& to_light) {
    if (slab.ior == 1) return straight(slab, x, to_light, kInfinite, 1);
    SlabArrivals result;
    for (int axis = 0; axis < 3; ++axis) {
        if (to_light[axis] == 0) continue;
        const double side = to_light[axis] > 0 ? 1 : -1;
        const double plane = side > 0 ? slab.box.max[axis] : slab.box.min[axis];
        const SurfaceCrossing in =
            surface_crossing(std::min(1.0, side * to_light[axis]), 1, slab.ior);
        SlabArrival arrival;
        arrival.to_light = to_light / slab.ior;
        arrival.to_light[axis] = side * in.cosine;
        arrival.inside = std::max(0.0, side * (plane - x[axis])) / in.cosine;
        arrival.entry = x + arrival.inside * arrival.to_light;
        arrival.entry[axis] = plane;
        if (!within_face(slab.box, axis, arrival.entry)) continue;
        arrival.irradiance = in.beam;
        result.ways[static_cast<std::size_t>(result.count++)] = arrival;
    }
    return result;
}

SceneSlabs::SceneSlabs(const std::vector<SceneMedium>& media, const std::string& path) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < media.size(); ++i) {
        const auto* const found = std::get_if<SceneSlab>(&media[i].kind);
        if (!found) continue;
        for (std::size_t k = 0; k < slabs_.size(); ++k) {
            const SceneBox& other = slabs_[k].box;
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis) {
                apart = apart || found->box.max[axis] <= other.min[axis] ||
                        found->box.min[axis] >= other.max[axis];
            }
            if (!apart) {
                throw Error(ErrorCode::data,
                            fmt::format("media[{}] and media[{}] are slabs that overlap; a ray can "
                                        "be in one at a time",
                                        places[k], i),
                            path);
            }
        }
        places.push_back(i);
        slabs_.push_back({found->box, found->ior, found->scattering,
                          found->scattering + found->absorption, phase_of(media[i].phase)});
    }
}

const Slab* SceneSlabs::at(const glm::dvec3& x) const {
    for (const Slab& slab : slabs_) {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            inside = inside && x[axis] > slab.box.min[axis] && x[axis] < slab.box.max[axis];
        }
        if (inside) return &slab;
    }
    return nullptr;
}

glm::dvec3 SceneSlabs::depth(const glm::dvec3& origin, const glm::dvec3& direction,
                             double distance) const {
    glm::dvec3 sum(0);
    for (const Slab& slab : slabs_) {
        if (const auto span = clip_to_box(slab.box, origin, direction, distance)) {
            sum += slab.extinction * (span->far - span->near);
        }
    }
    return sum;
}

}  // namespace airlight
