// SPDX-License-Identifier: Apache-2.0
// Cheaper ways to the optical depth of an exponential atmosphere, and what they cost in accuracy.
#pragma once

#include "core/method_names.h"
#include "medium/spherical_density.h"

namespace airlight {

/// The optical depth by the code of [Golubev], OptDepthSpherExpMedium, in single precision: a
/// difference of two Chapman functions by eq. 46-48, the periapsis on the side of the start.
/// Right to 1e-4 where most of the atmosphere is crossed. On segments of a metre at r = 6371 km the
/// median error is .7 and the largest 4.8, zeros among the values; an underground tangent of more
/// than 88 scale heights gives inf or NaN. distance in [0, inf]. 38 ns.
float spherical_depth_article(float radius, float scale_height, float center_distance,
                              float cos_zenith, float distance);

/// Its inverse by the code of [Golubev], SampleSpherExpMedium, for one constituent: at most four
/// Halley steps on the function above. max_distance finite. Depths under 1e-4 get the first guess,
/// max_distance depth / (depth of the whole), off by up to 43 times.
float spherical_distance_article(float radius, float scale_height, float center_distance,
                                 float cos_zenith, float max_distance, float depth);

/// The optical depth as if the sphere were flat, by exponential_height_depth from the start's
/// altitude on. Its relative error is about distance^2 sin^2 / (2 r H) for short segments.
double spherical_depth_flat(const SphericalProfile& profile, const SphericalRay& ray,
                            double distance);

/// `exact` is spherical_depth, in single precision its float overload; then the two above. Median
/// and largest relative error on segments up to 1 m, 100 m, 700 km and on rays through the
/// periapsis (atmosphere of the Earth, bench/density_bench.cpp):
///
///     method         ns          1 m          100 m        700 km       periapsis
///     exact          200 - 330   under 1e-15
///     exact, float   63 - 91     5e-7 1.1e-6  5e-7 1.1e-6  2e-7 9e-7    3e-7 9e-7
///     article        38          1 5.2        .05  4.7     8e-5 .018    1e-4 .04
///     flat           60          4e-14 2e-11  4e-10 2e-7   5e-4 3e7     .5   9e6
enum class SphericalMethod { exact, article, flat };

inline constexpr NamedMethod<SphericalMethod> kSphericalMethods[] = {
    {SphericalMethod::exact, "exact"},
    {SphericalMethod::article, "article"},
    {SphericalMethod::flat, "flat"},
};

}  // namespace airlight
