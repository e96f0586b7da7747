// SPDX-License-Identifier: Apache-2.0
// The way of light through a plane between two transparent media, from point to point.
#pragma once

namespace airlight {

/// From a point `height` above the plane to one `depth` below it, `across` apart along the plane;
/// all in [0, inf).
struct RefractedPath {
    bool exists = false;  ///< not where depth or height is 0 and the way would be reflected
    double cosine_above = 0, cosine_below = 0;
    double above = 0, below = 0;  ///< lengths [m]
    /// Irradiance across the beam at the lower point, of radiant intensity 1 at the upper one
    /// [1/m^2]: T c_1 / c_2 / ((u + r k) (u + r k c_1^2 / c_2^2)), r = ior_above / ior_below, u and
    /// k the lengths, T that of Fresnel.
    double irradiance = 0;
};

/// By Newton's method on Snell's law, which ends at rounding; 0.2 us.
RefractedPath refracted_path(double height, double depth, double across, double ior_above,
                             double ior_below);

}  // namespace airlight
