// SPDX-License-Identifier: Apache-2.0
// Spherical-harmonic coefficients of the point spread functions of medium/phase_airlight.h.
#pragma once

#include <vector>

#include "medium/phase_function.h"

namespace airlight {

/// Eigenvalues lambda_l / (T e^-T), l = 0 ... order-1, of PSF_{T,p} at the optical thickness
/// T >= 0: psf_eigenvalues_scaled of sh/npsf.h for any phase function (and that function for the
/// isotropic one). lambda_0 is the energy that medium/phase_airlight.h states.
///
/// The integral over the angle, on panels that double in length away from both poles: PSF
/// sin(gamma) is bounded, and smooth in the logarithm of either distance; a table's knots are ends
/// of panels. Accuracy 1e-12 lambda_0 for every l and T up to 1e100, measured where exact values
/// are known: isotropic up to l = 299 and T = 1e100, lambda_0 of Rayleigh.
///
/// Cost, one thread: 10 ms for order 512; a table more, by its knots.
/// Throws Error (data) if T is negative or not finite.
std::vector<double> psf_eigenvalues_scaled(double optical_thickness, const PhaseFunction& phase,
                                           int order);

/// What fog of the optical thickness T and the given single-scattering albedo multiplies degree l
/// of a map's light by: e^-T, the direct part, plus albedo T e^-T times psf_eigenvalues_scaled.
/// The foggy map of envmap/fog.h has these coefficients. All are positive; T = 0 gives ones, and
/// from T = 745 on they are 0 by underflow. Throws as above, and where the albedo is not in [0, 1].
std::vector<double> fog_eigenvalues(double optical_thickness, double albedo,
                                    const PhaseFunction& phase, int order);

}  // namespace airlight
