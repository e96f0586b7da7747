// SPDX-License-Identifier: Apache-2.0
// A phase function given by values at angles.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// Between the values.
enum class PhaseInterpolation {
    linear,    ///< straight in the angle
    monotone,  ///< cubic in the angle, no steeper than the values: never overshoots, never negative
};

/// A density over the sphere from values at scattering angles (see medium/phase_function.h). Values
/// are relative: construction scales them to integrate to 1. Where the angles leave out an end of
/// [0, pi], its nearest value holds up to there. The monotone form is flat at 0 and pi, as an even
/// function is, and elsewhere has the slopes of [FC80] in Brodlie's form, the weighted harmonic
/// mean of its neighbours'.
class PhaseTable {
  public:
    /// `angles` [rad] strictly increase within [0, pi] (up to the float next above pi), `values`
    /// are finite, not negative, and not all zero; at least two of each. Throws Error(data)
    /// otherwise, with the entry's number, from 0.
    PhaseTable(const std::vector<double>& angles, const std::vector<double>& values,
               PhaseInterpolation interpolation = PhaseInterpolation::monotone);

    /// Density [1/sr] at an angle in [0, pi].
    double density(double angle) const { return density(angle, interval(angle)); }

    /// The angle below which the part xi in [0, 1] of the light goes. The part below it is xi to
    /// 1e-15, judged where the density does not vanish.
    double quantile(double xi) const;

    double mean_cosine() const { return mean_cosine_; }

    /// Knots, the first at 0 and the last at pi, and the density of a point in interval k, between
    /// knots k and k + 1.
    const std::vector<double>& knots() const { return knots_; }
    std::size_t interval(double angle) const;
    double density(double angle, std::size_t k) const {
        const Cubic& c = cubics_[k];
        const double x = (angle - knots_[k]) / (knots_[k + 1] - knots_[k]);
        const double value = c.a + x * (c.b + x * (c.c + x * c.d));
        return value > 0 ? value : 0;
    }

  private:
    // In the fraction of its interval.
    struct Cubic {
        double a, b, c, d;
    };

    // The part of the light that goes into [knot k, angle] of interval k.
    double part(std::size_t k, double angle) const;

    std::vector<double> knots_;
    std::vector<Cubic> cubics_;
    std::vector<double> below_;  // the part of the light below each knot
    double mean_cosine_ = 0;
};

}  // namespace airlight
