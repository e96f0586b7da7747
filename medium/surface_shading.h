// SPDX-License-Identifier: Apache-2.0
// Lambert and Phong surfaces that a point light reaches directly and by way of the fog.
#pragma once

#include <glm/vec3.hpp>

#include "medium/surface_radiance_method.h"

namespace airlight {

/// A uniform fog by its coefficients [1/m], 0 <= scattering <= extinction < inf. The phase function
/// is 1 / (4 pi), and light is scattered once.
struct SurfaceFog {
    double extinction = 0;  ///< sigma_t
    double scattering = 0;  ///< sigma_s
};

struct SurfaceLight {
    glm::dvec3 position{0};  ///< [m]
    double intensity = 1;    ///< radiant intensity I_0 [W/sr], >= 0
};

/// A point of a surface; the normal is a unit vector on the side that is lit.
struct SurfacePoint {
    glm::dvec3 position{0};  ///< [m]
    glm::dvec3 normal{0, 1, 0};
};

/// Radiance that leaves the surface [W/(m^2 sr)]. Both parts still have to cross the fog to the
/// viewer: e^{-T_vp} times their sum, plus the airlight in between, is what is seen ([Sun05] eq.
/// 19).
struct SurfaceRadiance {
    double direct = 0;
    double scattered = 0;

    double total() const { return direct + scattered; }
};

/// [Sun05] eq. 17 or 18 for any lobe, D the distance to the light, T = sigma_t D, theta the angle
/// between the axis of the lobe and the light, n = g.options().exponent:
///     direct = k I_0 e^-T / D^2 max(0, cos theta)^n,
///     scattered = k I_0 sigma_s / (2 pi D) G_n(T, theta).
/// distance in (0, inf], theta in [0, pi], reflectance k in [0, inf) [1/sr]. Outside of that,
/// NaN included, both parts are NaN. Accuracy: relative 3e-13 with the exact rung; near
/// theta = pi/2 cos theta, and with it the direct part, is as exact as theta.
///
/// Deviates: the paper's beta^2 / (2 pi T) is sigma_s sigma_t / (2 pi sigma_t D), and here the
/// extinction is divided out: absorption dims, only scattering lights, and clear air divides by
/// nothing. Its code for the direct part lets cos theta < 0 through (fig. 13).
SurfaceRadiance surface_lobe(double distance, double theta, double reflectance,
                             const SurfaceFog& fog, double intensity, const SurfaceEvaluator& g);

/// Lambertian surface with the constant BRDF `reflectance` (albedo / pi), g for n = 1. A light
/// behind the surface, theta > pi/2, still lights it by way of the fog in front: G_1 goes on there,
/// as if the surface were small. A large one would shade that fog, which is for the caller to know.
///
/// Directions: |normal|^2 within 1e-5 of 1 is accepted and normalised, anything else gives NaN, and
/// so do a light at the point itself and positions that are not finite.
SurfaceRadiance lambert_surface(const SurfacePoint& point, const SurfaceLight& light,
                                const SurfaceFog& fog, double reflectance,
                                const SurfaceEvaluator& g = SurfaceEvaluator());

/// Phong lobe about the mirrored direction of view, k cos^n theta'_s [1/sr]: the foreshortening is
/// in it. `to_viewer` is the unit vector from the point to the viewer, treated as the normal is;
/// the axis is 2 (n . v) n - v, and theta'_s its angle to the light. n is g.options().exponent.
///
/// Deviates: eq. 18 lights the lobe directly wherever theta'_s < pi/2; a light on the dark side of
/// the plane gives no direct part here. The hemisphere of the scattered part is that of the lobe,
/// as in the paper.
SurfaceRadiance phong_surface(const SurfacePoint& point, const glm::dvec3& to_viewer,
                              const SurfaceLight& light, const SurfaceFog& fog, double reflectance,
                              const SurfaceEvaluator& g);

}  // namespace airlight
