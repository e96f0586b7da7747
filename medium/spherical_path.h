// SPDX-License-Identifier: Apache-2.0
// A ray beside a center, with twice a double's digits where optical depths need them.
#pragma once

#include <cstddef>

#include "medium/exact_sum.h"
#include "medium/spherical_density.h"

namespace airlight {
namespace detail {

struct SphericalPath {
    TwoDoubles r;          ///< distance of the start from the center
    TwoDoubles altitude;   ///< r less the radius of the sphere
    TwoDoubles along;      ///< from the point of the line next to the center to the start
    TwoDoubles periapsis;  ///< distance of the center from the line
};

/// The path of a start at r whose direction has the cosine c to the radius there.
SphericalPath spherical_path(TwoDoubles r, TwoDoubles altitude, double c);

/// spherical_depth along a path; every argument in its domain. Nothing over- or underflows.
Scaled spherical_column(const SphericalPath& path, double radius, double scale_height,
                        double distance);

/// e^{-altitude / H}.
Scaled spherical_density(TwoDoubles altitude, double scale_height);

/// spherical_distance along a path.
double spherical_distance(const SphericalPath& path, const SphericalComponent* components,
                          std::size_t count, double radius, double max_distance, double depth);

}  // namespace detail
}  // namespace airlight
