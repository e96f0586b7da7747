// SPDX-License-Identifier: Apache-2.0
// The point spread function of fog, split into a part for neighbouring pixels and a smooth rest.
#pragma once

#include <optional>
#include <vector>

#include "envmap/remainder_table.h"
#include "medium/phase_function.h"

namespace airlight {

/// PSF_T e^T / T as the sum of a near part that ends at `radius` and a far part of finitely many
/// bands.
///
/// With s = 2 sin(gamma/2), x = T (1 - cos gamma) and Ein the entire exponential integral, the
/// closed form of the single-scattering integral reads
///     PSF_T e^T / T = e^x / (2 pi sin gamma) [ (pi/2) cos(T sin gamma) + sin(T sin gamma) ln s ]
///                     + a function that is smooth at gamma = 0.
/// As in Ewald's sums [Ewald21] the two singular terms keep their short range only,
///     near = e^x / (2 pi sin gamma) [ (pi/2) cos(T sin gamma) erfc(alpha s)
///                                     - 1/2 sin(T sin gamma) E1(alpha^2 s^2) ],
/// so far = PSF - near is smooth at every angle and its bands fall like exp(-(l / 2 alpha)^2). Both
/// tails meet a tolerance e once radius * lmax is about 2 ln(1/e). The last sixteenth of the bands
/// is tapered, which keeps the truncation from piling up at the antipode.
///
/// Other phase functions have the same two singular terms with their own even and odd factors
/// (envmap/phase_singularity.h), cut in the same way. What else Henyey-Greenstein's peak adds falls
/// like |g|^l, so that no split is found for a g whose power |g|^lmax is above the tolerance.
///
/// Deviates: [Sun05] sec. 6.4 convolves with all of PSF in bands, which rings around a sun.
struct SplitKernel {
    double optical_thickness = 0;     ///< T of the shape
    double radius = 0;                ///< of the near part, chord length
    std::vector<double> eigenvalues;  ///< lambda_l of the far part, l = 0 … lmax
    RemainderTable near;              ///< energy of the near part beyond an angle
    /// Largest relative error of near + far against the exact kernel, measured, and what the
    /// arithmetic of pixels adds.
    double error = 0;

    int lmax() const { return static_cast<int>(eigenvalues.size()) - 1; }
};

/// Near part at squared chord t in (0, 4).
double near_kernel(double optical_thickness, double alpha, double t);

/// Builds the split with bands 0 … lmax whose measured error is at most `tolerance`; the radius is
/// what that takes, or nothing if that would be 1 or more, T too large or the phase function too
/// sharp for so few bands, or tabulated.
std::optional<SplitKernel> make_split_kernel(double optical_thickness, int lmax, double tolerance,
                                             const PhaseFunction& phase = {});

/// The near part's radius that a tolerance takes with lmax bands, before measuring.
double split_radius(int lmax, double tolerance);

/// The whole kernel PSF_T e^T / T as a remainder table, for the exact method.
RemainderTable whole_kernel(double optical_thickness);

/// The same for a phase function.
RemainderTable whole_kernel(double optical_thickness, const PhaseFunction& phase);

/// Bound on the relative error of a map's scattered light by that table: 1e-6 for the arithmetic of
/// pixels as for an isotropic medium, more where a backward peak is narrow, 1.5e-7 / (1 + g), where
/// the knots of a tabulated phase function show (measured on thin shells), and where the antipode
/// of a forward peak drowns in the rounding of the peak, for pixels of that solid angle.
double whole_kernel_error(double optical_thickness, const PhaseFunction& phase,
                          const RemainderTable& table, double pixel);

}  // namespace airlight
