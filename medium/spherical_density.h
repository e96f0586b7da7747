// SPDX-License-Identifier: Apache-2.0
// An exponential atmosphere around a sphere: optical depth along a ray, and the way back.
#pragma once

#include <cstddef>

namespace airlight {

/// The atmosphere's density is e^{-(|x - center| - R) / H}, 1 at the surface of the sphere.
struct SphericalProfile {
    double radius = 6371000;     ///< R, in [0, inf)
    double scale_height = 8000;  ///< H, in (0, inf]; inf is a uniform medium
};

/// A ray, by where it starts and how steeply it rises there.
struct SphericalRay {
    double center_distance = 0;  ///< r, in [0, inf)
    double cos_zenith = 1;       ///< of its direction, in [-1, 1]; without meaning at r = 0
};

/// Optical depth per extinction at the surface, [Golubev] eq. 40:
///     tau = int_0^dist e^{-(|x + s v| - R) / H} ds,  |x + s v|^2 = r^2 + 2 r s cos + s^2,
/// in the unit of the lengths; dist in [0, inf].
///
/// Any ray: through the periapsis, grazing, straight through the center, far underground, where
/// exponents are put together before any exponential is taken: +inf only when the value is, and
/// r / H up to 1e300. Arguments outside the domain, NaN included, give NaN.
///
/// Accuracy: relative 1e-15 in double against 50 digits, one-metre segments at 6371 km and tangents
/// 100 scale heights underground included; the altitudes are kept with twice a double's digits, so
/// nothing of r / H is lost. 270 ns; rays through the periapsis 330 ns.
///
/// Deviates: the article subtracts two Chapman functions, which for short segments are equal in
/// all their digits. This integrates the segment itself, from its densest end
/// (medium/curved_column.h).
double spherical_depth(const SphericalProfile& profile, const SphericalRay& ray, double distance);

/// The same for a ray given by its altitude above the sphere, r = R + altitude >= 0, which keeps
/// the digits that r has no room for.
double spherical_depth_at_altitude(const SphericalProfile& profile, double altitude,
                                   double cos_zenith, double distance);

/// Single precision: relative 3e-6 at the floats that are given, for z = r / H >= 20 by a rule of
/// 12 nodes in float, otherwise by the double function. See bench/density_bench.cpp for its cost
/// beside that of the article's code. With the altitude, the atmosphere of the Earth is resolved to
/// millimetres; r itself has a spacing of half a metre there.
float spherical_depth(float radius, float scale_height, float center_distance, float cos_zenith,
                      float distance);
float spherical_depth_at_altitude(float radius, float scale_height, float altitude,
                                  float cos_zenith, float distance);

/// One constituent of an atmosphere (air, haze ...): `extinction` at the surface [1/m], in
/// [0, inf), and its scale height.
struct SphericalComponent {
    double extinction = 0;
    double scale_height = 8000;
};

/// Optical depth of `count` constituents around the same sphere.
double spherical_depth(const SphericalComponent* components, std::size_t count, double radius,
                       const SphericalRay& ray, double distance);

/// The distance at which spherical_depth reaches `depth`, in [0, max_distance]; 0 for depth 0, +inf
/// if the ray gathers less within max_distance. A depth that exceeds that of the whole ray by
/// rounding alone, 1e-14, gives max_distance, which may be inf.
///
/// By Halley's method within a bracket, until the depth agrees to 2e-15 or neighbouring doubles
/// enclose it: 2 to 5 evaluations of spherical_depth; 1.2 us.
///
/// Deviates: [Golubev], SampleSpherExpMedium, stops when the absolute or the relative difference is
/// below 1e-4, which leaves depths under 1e-4 at the first guess.
double spherical_distance(const SphericalProfile& profile, const SphericalRay& ray,
                          double max_distance, double depth);
double spherical_distance(const SphericalComponent* components, std::size_t count, double radius,
                          const SphericalRay& ray, double max_distance, double depth);
float spherical_distance(float radius, float scale_height, float center_distance, float cos_zenith,
                         float max_distance, float depth);

}  // namespace airlight
