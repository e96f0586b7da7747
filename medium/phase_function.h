// SPDX-License-Identifier: Apache-2.0
// Phase functions: how much light a particle sends into each angle, per steradian.
//
// The scattering angle lies between the directions in which light travels before and after: 0 goes
// straight on, pi turns back. With directions that both point away from the particle, as a renderer
// may hold them, that is pi less the angle between them. Every phase function here integrates to 1
// over the sphere.
#pragma once

#include <memory>
#include <vector>

#include "medium/phase_table.h"

namespace airlight {

/// [Chandra60] sec. I.3, 3 / (16 pi) (1 + cos^2) [1/sr]. `cosine` is that of the scattering angle,
/// in [-1, 1]; one that rounding put beyond, up to the float next to 1, counts as 1. Anything else
/// gives NaN. Relative error 2e-16 in double, one rounding in float.
double phase_rayleigh(double cosine);
float phase_rayleigh(float cosine);

/// [HG41] eq. 2, (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^{3/2}) [1/sr], for g in (-1, 1), which is
/// the mean cosine: g > 0 scatters forward. Domain of `cosine` as above; any other g gives NaN.
/// Relative error 1e-15 for every g in double, at the doubles given: beside the peak of a g next to
/// 1 the cosine itself no longer tells angles apart (its spacing there is an angle of 1e-8), so
/// take the angle instead.
///
/// Deviates: 1 + g^2 - 2 g cos cancels at the peak. With a = |g| it is (1-a)^2 + 2a (1 -+ cos).
double phase_hg(double cosine, double g);
float phase_hg(float cosine, float g);

/// The same at a scattering angle in [0, pi]; the denominator is
/// (1-g)^2 cos^2(angle/2) + (1+g)^2 sin^2(angle/2). Relative error 1e-15 down to denormal angles.
double phase_hg_at_angle(double angle, double g);
float phase_hg_at_angle(float angle, float g);

/// The scattering angle in [0, pi] below which Henyey-Greenstein scatters the part xi in [0, 1] of
/// the light: with xi uniform and the azimuth uniform, directions of density phase_hg. Relative
/// error 1e-15; tan(angle/2) = (1-g)/(1+g) sqrt(xi (1+g(1-xi)) / ((1-xi) (1-g xi))).
double sample_hg(double xi, double g);

enum class PhaseKind { isotropic, rayleigh, henyey_greenstein, tabulated };

/// A phase function by value; copies share a table. Default: isotropic.
class PhaseFunction {
  public:
    PhaseFunction() = default;

    static PhaseFunction isotropic() { return {}; }
    static PhaseFunction rayleigh();
    /// Throws Error(usage) unless -1 < g < 1.
    static PhaseFunction henyey_greenstein(double g);
    static PhaseFunction tabulated(PhaseTable table);

    PhaseKind kind() const { return kind_; }
    double g() const { return g_; }                           ///< of Henyey-Greenstein, else 0
    const PhaseTable* table() const { return table_.get(); }  ///< null but for a tabulated one

    /// Density [1/sr] at a scattering angle in [0, pi], or at its cosine; NaN outside.
    double at_angle(double angle) const;
    double at_cosine(double cosine) const;

    /// The scattering angle below which the part xi in [0, 1] of the light goes: draws angles of
    /// density at_angle, with the azimuth uniform. NaN outside.
    double sample_angle(double xi) const;

    /// The mean of the cosine of the scattering angle: g of Henyey-Greenstein, 0 of a symmetric
    /// one.
    double mean_cosine() const;

  private:
    PhaseKind kind_ = PhaseKind::isotropic;
    double g_ = 0;
    std::shared_ptr<const PhaseTable> table_;
};

}  // namespace airlight
