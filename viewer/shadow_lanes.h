// SPDX-License-Identifier: Apache-2.0
// The two steps of viewer/ray_shadows.h that are taken for eight boxes or triangles at once.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace airlight::detail {

inline constexpr int kShadowLanes = 8;

/// slope . x + offset.
struct Linear {
    glm::dvec3 slope{0};
    double offset = 0;

    double operator()(const glm::dvec3& x) const { return glm::dot(slope, x) + offset; }
};

/// What shades an interval of a ray lies between two planes through the light.
struct ShadowWedge {
    Linear after, before;  ///< positive inside
};

/// A ray and a light and the plane of both: x along the ray from the point next to the light, at
/// the distance `foot`; y towards the light, which is at y = height; z off the plane.
struct ShadowQuery {
    double foot = 0, height = 0, distance = 0;
    glm::dvec3 low{0}, high{0};  ///< of the light and the ray
    Linear x, y, z;
    ShadowWedge all;      ///< of the whole ray
    ShadowWedge covered;  ///< of a part that is known to be shaded
    bool any_covered = false;
};

/// Boxes by their middles and half extents; half extents are below 0 where there is none.
struct ShadowBoxes {
    float middle[3][kShadowLanes], half[3][kShadowLanes];
    std::uint32_t child[kShadowLanes];
};

/// corner[i][axis]; lanes without a triangle have one of no extent.
struct ShadowTriangles {
    double corner[3][3][kShadowLanes];
};

/// A bit for each box that may hold something between ray and light that shades more of the ray
/// than is known to be shaded.
unsigned boxes_in_question(const ShadowBoxes& boxes, const ShadowQuery& query);

/// A bit for each triangle that shades a part of the ray, and that part. The same to the bit on
/// every machine, and for the shared edge of two triangles.
unsigned shadows_of(const ShadowTriangles& triangles, const ShadowQuery& query,
                    double (&begin)[kShadowLanes], double (&end)[kShadowLanes]);

}  // namespace airlight::detail
