// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight_rungs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>

#include "medium/airlight.h"
#include "medium/quadrature.h"
#include "medium/ray_triangle.h"

namespace airlight {
namespace {

constexpr double kEulerGamma = 0.57721566490153286061;

// What lies beyond this excess path is under the rounding of the rest.
constexpr double kLongestPath = 40;

template <class Real>
Real sinh_gl_integral(const detail::RayTriangle<Real>& r, const detail::QuadratureRule& rule) {
    const Real smallest = std::numeric_limits<Real>::epsilon() / 1024;
    if (r.ends_near && r.x_end < smallest && r.y * r.x_end < smallest) return 1;
    // Past 1/epsilon^2 even 1/x^2 has no weight left.
    const Real x = std::min({r.x_end, Real(kLongestPath) / r.y, Real(1e18)});
    if (x == 0) return 0;
    const Real c = r.cos_theta;
    const Real half =
        std::asinh(x * (x + 2 * c) / (x + c + c * std::sqrt(x * (x + 2 * c) + 1))) / 2;
    Real sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        for (const Real sign : {Real(1), Real(-1)}) {
            const Real t = half * (1 + sign * static_cast<Real>(rule.nodes[i].x));
            const Real sinh_half = std::sinh(t / 2);
            const Real cosh_half = std::sqrt(1 + sinh_half * sinh_half);
            const Real sinh_t = 2 * sinh_half * cosh_half;
            const Real cosh_less_1 = 2 * sinh_half * sinh_half;
            sum += static_cast<Real>(rule.nodes[i].w) *
                   std::exp(-r.y * (sinh_t + c * cosh_less_1)) / (1 + cosh_less_1 + c * sinh_t);
        }
    }
    return r.ends_near ? sum * half / r.x_end : sum * half;
}

// e^z E1(z) for Re z >= 0, z != 0.
std::complex<double> scaled_e1(std::complex<double> z) {
    if (std::abs(z) < 2.5) {
        std::complex<double> sum = 0, power = 1;
        for (int n = 1; n <= 60; ++n) {
            power *= -z / double(n);
            sum += power / double(n);
            if (std::norm(power) < 1e-36) break;
        }
        return std::exp(z) * (-kEulerGamma - std::log(z) - sum);
    }
    // G(z) = 1 / (z + 1 - 1 / (z + 3 - 4 / (z + 5 - ...))), [DLMF 6.9.1] contracted.
    std::complex<double> b = z + 1.0, f = b, c = b, d = 0;
    for (int n = 1; n <= 1000; ++n) {
        const double a = -double(n) * n;
        b += 2.0;
        d = 1.0 / (b + a * d);
        c = b + a / c;
        const std::complex<double> delta = c * d;
        f *= delta;
        if (std::norm(delta - 1.0) < 1e-32) break;
    }
    return 1.0 / f;
}

}  // namespace

double airlight_sinh_gl(double gamma, double t_sv, double t_vp, int nodes) {
    const detail::QuadratureRule rule = detail::gauss_legendre(nodes);
    assert(rule.count > 0);
    return detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv),
                               [&](const auto& r) { return sinh_gl_integral<double>(r, rule); });
}

float airlight_sinh_gl(float gamma, float t_sv, float t_vp, int nodes) {
    const detail::QuadratureRule rule = detail::gauss_legendre(nodes);
    assert(rule.count > 0);
    return detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5f * t_sv),
                               [&](const auto& r) { return sinh_gl_integral<float>(r, rule); });
}

double airlight_e1(double gamma, double t_sv, double t_vp) {
    bool loses_digits = false;
    const auto closed_form = [&](const detail::RayTriangle<double>& r) {
        const double kappa = r.y * r.cos_theta, omega = r.y * r.sin_theta;
        const std::complex<double> first = scaled_e1({kappa, omega});
        double difference = -first.imag();
        const double path = r.y * r.x_end;
        if (path < kLongestPath) {
            difference += std::exp(-path) * scaled_e1({path + kappa, omega}).imag();
        }
        // Negated, so that a NaN from the ends of the range counts as a loss too.
        loses_digits = !(difference > 5e-2 * std::abs(first) && std::isfinite(difference));
        const double h = difference / r.sin_theta;
        return r.ends_near ? h / r.x_end : h;
    };
    const double value = detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), closed_form);
    return loses_digits ? airlight(gamma, t_sv, t_vp) : value;
}

double airlight_march(double gamma, double t_sv, double t_vp, int steps) {
    assert(steps >= 1);
    const bool inside =
        gamma > 0 && gamma <= kPi && t_sv > 0 && std::isfinite(t_sv) && t_vp > 0;
    if (!inside) return airlight(gamma, t_sv, t_vp);
    const double sine = std::sin(0.5 * gamma);
    const double kappa = 2 * t_sv * sine * sine;
    const double longest = kLongestPath * (kLongestPath + 2 * t_sv) / (2 * (kLongestPath + kappa));
    const double step = std::min(t_vp, longest) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * step;
        const double beyond = t - t_sv;
        const double squared = beyond * beyond + 2 * kappa * t;
        sum += std::exp(-(beyond + std::sqrt(squared))) / squared;
    }
    const double value = sum * step * std::exp(-t_sv) / (4 * kPi);
    // A step can land on the light, and squares leave the range where lengths do not.
    return std::isfinite(value) ? value : airlight(gamma, t_sv, t_vp);
}

}  // namespace airlight
