// SPDX-License-Identifier: Apache-2.0
// What a tabulated BRDF reflects, and whether it is one: energy and reciprocity.
#pragma once

#include <glm/vec3.hpp>

#include "sh/brdf.h"

namespace airlight {

/// The share of a white sky that the surface sends towards a viewer at theta_out [rad] in
/// [0, pi/2): int f(i, o) cos theta_i d omega_i over the hemisphere. Where f is reciprocal it is
/// also the share of the light from there that is reflected at all, and at most 1.
///
/// Summed over the half vector, on `samples` midpoints of sqrt(theta_h) and twice as many azimuths:
/// what the table resolves is resolved, however narrow. Error at 128 samples: Lambertian 2e-4 up to
/// 80 degrees; metals of roughness 0.05 and 0.2 against 1024 samples, up to 75 degrees, 8e-6 and
/// 7e-5 (kinks of the table). Cost 5 ms on one thread (bench/brdf_bench.cpp). Throws Error(usage),
/// as those below, unless there is a sample.
glm::dvec3 directional_reflectance(const BrdfTable& table, double theta_out, int samples = 128);

/// 2 int directional_reflectance(theta) cos theta sin theta d theta: the share of a white sky that
/// the surface reflects, over all viewers, on 24 Gauss-Legendre angles.
glm::dvec3 white_sky_reflectance(const BrdfTable& table, int samples = 128);

/// max |f(i, o) - f(o, i)| / (f(i, o) + f(o, i)) over `pairs` pairs of directions above the
/// horizon, the same in every call, and all channels: 0 for every table that is not directed.
double reciprocity_error(const BrdfTable& table, int pairs = 10000);

}  // namespace airlight
