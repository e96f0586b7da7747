// SPDX-License-Identifier: Apache-2.0
// Spherical-harmonic coefficients of a tabulated BRDF, one set per outgoing angle.
#pragma once

#include <memory>

#include "sh/brdf.h"

namespace airlight {

/// The largest order of BrdfBands.
inline constexpr int kLargestBrdfOrder = 512;

/// What a surface sends towards one viewer, as a function of the incident direction i over the
/// sphere: rho(i) = f(i, o) max(0, cos theta_i), in the frame of the surface with o in its x-z
/// plane, x > 0. Its coefficients are
///     rho_lm(theta_o) = int rho(i) Y_lm(i) d omega          ([Sun05] eq. 23)
/// in the basis of sh/basis.h, (x, y, z) = (x, y, z), so light with the coefficients L_lm in that
/// frame makes the radiance sum L_lm rho_lm, and sqrt(4 pi) rho_00 is the reflectance.
///
/// Deviates: eq. 23 expands the BRDF alone. The convolution of eq. 24 then spreads light over
/// incident directions, each with a cosine of its own and none below the horizon, and a cosine that
/// a renderer applies later is that of the source. Only with the cosine within is the convolution
/// the reflected airlight, as in appendix B, where it stands beside k_d.
class BrdfBands {
  public:
    /// Throws Error(usage) unless 1 <= order <= kLargestBrdfOrder. Samples 2 order rows of Gauss's
    /// rule over the upper hemisphere and 4 order columns, so that the edge at the horizon is no
    /// obstacle.
    explicit BrdfBands(int order);
    ~BrdfBands();

    /// rho_lm(theta_out) of R, G and B into out[3][order^2]. theta_out in [0, pi/2) [rad].
    ///
    /// Accuracy: the rule is exact for rho of degree 3 order - 1 in each half; what BRDFs have
    /// beyond that folds back. Lambertian: 1e-14. Norm of the error over the norm for a metal of
    /// roughness 0.2 at the usual size, and cost on one thread (bench/brdf_bench.cpp):
    ///     order 16  0.027, 0.5 ms;  64  7e-5, 8 ms;  128  7e-5, 31 ms
    /// where the kinks of the table at its cells hold the last two up.
    /// Same bits for any number of threads.
    void coefficients(const BrdfTable& table, double theta_out, double* out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace airlight
