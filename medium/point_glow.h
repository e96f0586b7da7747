// SPDX-License-Identifier: Apache-2.0
// The glow of a point light in endless fog with all scattering, exactly: what single scattering is
// measured against.
#pragma once

namespace airlight {

/// An isotropic point light in an infinite uniform medium that scatters isotropically. Lengths are
/// optical thicknesses. For a light of unit power (intensity 1 / (4 pi)) the light that arrives
/// from all directions at the thickness T is, c being the albedo,
///
///     phi(T) = 1 / (2 pi^2 T) int_0^inf k sin(k T) A / (1 - c A) dk,   A = atan(k) / k
///            = 1 / (4 pi T) [P e^{-kappa T} + int_0^1 e^{-T/nu} g(nu) / nu^2 d nu],
///     g = 1 / ((1 - c nu atanh nu)^2 + (pi c nu / 2)^2),   atanh(kappa) / kappa = 1 / c,
///     P = 2 kappa^2 (1 - kappa^2) / (c (kappa^2 - 1 + c)),
///
/// the second line from the first by moving the path of integration to the pole at i kappa and the
/// cut above i [Case53]. At c = 1 kappa is 0 and P is 3.
class PointGlow {
  public:
    /// albedo in [0, 1]; others are NaN.
    explicit PointGlow(double albedo);

    /// phi of light scattered at least once [1], for T in (0, inf]: 4 pi T^2 phi (1 - c) integrates
    /// to c. Relative 1e-12 for c of 0.3 to 1, T of 1e-3 to 100; 11 us.
    double collided_fluence(double t) const;

    /// Radiance of all scattered light along a ray over sigma_t^2 I, c int_0^T_vp e^{-t} phi(d) dt
    /// (medium/airlight.h has the angle and thicknesses); gamma in (0, pi), t_sv in (0, inf), t_vp
    /// in [0, inf]. Of single scattering it is airlight() times the albedo. Relative 1e-8; 2 ms.
    double radiance(double gamma, double t_sv, double t_vp) const;

  private:
    double albedo_, kappa_ = 0, pole_ = 3;
};

}  // namespace airlight
