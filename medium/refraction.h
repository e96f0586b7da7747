// SPDX-License-Identifier: Apache-2.0
// Light across a smooth boundary between two transparent media.
#pragma once

namespace airlight {

/// What happens to unpolarised light that meets the boundary at the cosine `cosine` to its normal,
/// from the medium of refractive index ior_from into that of ior_to.
struct SurfaceCrossing {
    double cosine;         ///< beyond the boundary, by Snell's law; 0 if `total`
    double reflectance;    ///< R of Fresnel, the mean of both polarisations, in [0, 1]
    double transmittance;  ///< T = 1 - R, without cancellation where R is nearly 1
    double radiance;       ///< T (ior_to / ior_from)^2: radiance beyond over radiance before
    double beam;           ///< T cosine_before / cosine: the same for the irradiance of a beam,
                           ///< measured across the beam
    bool total;            ///< total internal reflection
};

/// cosine in [0, 1] (a rounded one up to 1 + 1e-6 stands for 1), indices in (0, inf). Anything
/// else, NaN included, gives NaN in every field.
///
/// With s = sqrt(1 - c_1^2), D = (n_2 - n_1)(n_2 + n_1):
///     r_s = -D / (n_1 c_1 + n_2 c_2)^2,
///     r_p = D (n_2 c_1 - n_1 s)(n_2 c_1 + n_1 s) / (n_2 (n_2 c_1 + n_1 c_2))^2,
/// forms in which neither equal indices nor Brewster's angle cancel: indices that agree to the last
/// digit but one give R of 1e-32, to full accuracy. Equal indices give R = 0, T = 1 at every angle,
/// grazing included; else T = 0 at grazing.
///
/// Relative accuracy 1e-15 of R, T and the cosine, but where the problem itself loses digits: next
/// to the critical angle and of R next to Brewster's. 44 ns.
SurfaceCrossing surface_crossing(double cosine, double ior_from, double ior_to);

/// SurfaceCrossing::beam from both cosines, for those who have them by geometry; they and the
/// indices are taken to obey Snell's law.
double beam_transmittance(double cosine_before, double cosine_after, double ior_from,
                          double ior_to);

}  // namespace airlight
