// SPDX-License-Identifier: Apache-2.0
// What is singular at gamma = 0 in the point spread function of a phase function.
#pragma once

#include <optional>
#include <vector>

#include "medium/phase_function.h"

namespace airlight {

/// With h = T sin(gamma), x = T (1 - cos gamma) and s = 2 sin(gamma/2),
///
///     PSF_{T,p} e^T / T = e^x / sin(gamma) [E(h) + S(h) ln s] + what is smooth at gamma = 0.
///
/// For the integral of medium/phase_airlight.h from gamma to pi is that from 0, A(h), less a part
/// from 0 to gamma, which is odd in gamma and smooth. In u = tan(alpha/2),
///     A(h) = int_0^inf G(u) e^{-h u} du,   G(u) = 2 p / (1 + u^2) = sum_{j>=0} b_j u^{-2j-2},
/// the tail of G makes the logarithm, S(h) = sum b_j h^{2j+1} / (2j+1)!, and E is what else is
/// even: E(h) = sum M_j h^{2j} / (2j)!, with M_j the finite part of int_0^inf G u^{2j} du. For an
/// isotropic medium E = cos(h) / 4 and S = sin(h) / (2 pi), as in envmap/fog_kernel.h.
class PhaseSingularity {
  public:
    /// Of Rayleigh or Henyey-Greenstein; nothing for what is isotropic or tabulated.
    static std::optional<PhaseSingularity> of(const PhaseFunction& phase);

    /// E(h) and S(h), for |h| <= limit().
    double even(double h) const;
    double odd(double h) const;

    /// Where rounding has grown to about 1e-8 of A(0); the terms go like cos(h (1-g)/(1+g)).
    double limit() const { return limit_; }

  private:
    std::vector<double> even_, odd_;  // M_j / (2j)! and b_j / (2j+1)!
    double limit_ = 0;
};

}  // namespace airlight
