// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_line_method.h"

#include <cmath>

#include "core/constants.h"
#include "medium/gaussian_density.h"

namespace airlight {
namespace {

template <class Real>
Real polynomial_erf(Real x) {
    if (std::abs(x) > Real(2.629639)) return x > 0 ? Real(1) : Real(-1);
    const Real z = Real(0.289226) * x * x - 1;
    Real sum = Real(0.01215);
    for (const Real coefficient : {Real(-0.0334326), Real(0.05328832), Real(-0.09111705),
                                   Real(0.15528468), Real(-0.24916791), Real(0.53323059)}) {
        sum = sum * z + coefficient;
    }
    return x * sum;
}

template <class Real, class Erf>
Real difference_of_erf(Real a, Real c, Real rho_perp, Real m_proj, Real dist, const Erf& erf) {
    // For what is outside the domain and for its corners.
    if (!(a > 0 && c > 0 && dist > 0 && std::isfinite(a) && std::isfinite(c) && rho_perp >= 0 &&
          std::isfinite(rho_perp) && std::isfinite(m_proj))) {
        return gaussian_line(a, c, rho_perp, m_proj, dist);
    }
    const Real x = a * rho_perp;
    const Real difference = erf(a * (dist - m_proj)) - erf(-a * m_proj);
    if (!(difference > 0)) return 0;
    const Real peak = c * std::exp(-x * x);
    if (peak == 0) return 0;
    return peak / a * (Real(0.5 * 1.7724538509055160273) * difference);
}

template <class Real>
Real line_by(GaussianLineMethod method, Real a, Real c, Real rho_perp, Real m_proj, Real dist) {
    switch (method) {
        case GaussianLineMethod::fast_erf:
            return difference_of_erf(a, c, rho_perp, m_proj, dist,
                                     [](Real x) { return fast_erf(x); });
        case GaussianLineMethod::erf:
            return difference_of_erf(a, c, rho_perp, m_proj, dist,
                                     [](Real x) { return std::erf(x); });
        case GaussianLineMethod::exact:
            break;
    }
    return gaussian_line(a, c, rho_perp, m_proj, dist);
}

}  // namespace

double gaussian_line(GaussianLineMethod method, double a, double c, double rho_perp, double m_proj,
                     double dist) {
    return line_by(method, a, c, rho_perp, m_proj, dist);
}

float gaussian_line(GaussianLineMethod method, float a, float c, float rho_perp, float m_proj,
                    float dist) {
    return line_by(method, a, c, rho_perp, m_proj, dist);
}

double fast_erf(double x) {
    return polynomial_erf(x);
}

float fast_erf(float x) {
    return polynomial_erf(x);
}

}  // namespace airlight
