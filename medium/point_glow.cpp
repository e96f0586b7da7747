// SPDX-License-Identifier: Apache-2.0
#include "medium/point_glow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/quadrature.h"

namespace airlight {
namespace {

template <class F>
double integrate(const F& f, double begin, double end, int panels) {
    const detail::QuadratureRule rule = detail::gauss_legendre(16);
    const double half = 0.5 * (end - begin) / panels;
    double sum = 0;
    for (int p = 0; p < panels; ++p) {
        const double middle = begin + (2 * p + 1) * half;
        for (int i = 0; i < rule.count; ++i) {
            const detail::QuadratureNode& node = rule.nodes[i];
            sum += node.w * (f(middle - half * node.x) + f(middle + half * node.x));
        }
    }
    return half * sum;
}

}  // namespace

PointGlow::PointGlow(double albedo) : albedo_(albedo) {
    if (!(albedo >= 0 && albedo <= 1)) {
        albedo_ = std::numeric_limits<double>::quiet_NaN();
        return;
    }
    if (albedo == 1) return;
    // kappa = tanh(s) with s = kappa / c.
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) {
        kappa_ = 0.5 * (low + high);
        (std::tanh(kappa_ / albedo) > kappa_ ? low : high) = kappa_;
    }
    const double off = (1 - kappa_) * (1 + kappa_);
    const double square = kappa_ * kappa_;
    pole_ = albedo > 0 ? 2 * square * off / (albedo * (albedo - off)) : 0;
}

// nu = tanh(s): the cut's integrand without its singular end.
double PointGlow::collided_fluence(double t) const {
    if (!(t > 0) || std::isnan(albedo_)) return std::numeric_limits<double>::quiet_NaN();
    if (t == std::numeric_limits<double>::infinity() || albedo_ == 0) return 0;
    const double c = albedo_;
    const auto integrand = [&](double s) {
        const double nu = std::tanh(s), sech = 1 / std::cosh(s);
        const double below = 1 - c * s * nu, beside = 0.5 * kPi * c;
        // (g - 1) / nu^2 without cancellation; the 1 is the light that was not scattered.
        const double more = c * (s / nu) * (1 + below) - beside * beside;
        return std::exp(-t / nu) * sech * sech * more / (below * below + beside * beside * nu * nu);
    };
    // Where the cut stands for T near 0 it begins at T.
    const double start = std::min(t, 0.5);
    const double cut = integrate(integrand, 0, start, 4) + integrate(integrand, start, 1, 8) +
                       integrate(integrand, 1, 20, 16);
    return (pole_ * std::exp(-kappa_ * t) + cut) / (4 * kPi * t);
}

double PointGlow::radiance(double gamma, double t_sv, double t_vp) const {
    const double once = albedo_ * airlight(gamma, t_sv, t_vp);
    if (!(t_vp > 0 && t_sv > 0) || !std::isfinite(once)) return once;
    const double height = t_sv * std::sin(gamma), foot = t_sv * std::cos(gamma);
    // Beyond, e^{-t} leaves nothing.
    const double end = std::min(t_vp, t_sv + 45);
    // d phi(d) is smooth, and d(t) = d dv with t - foot = height sinh(v).
    const auto integrand = [&](double v) {
        const double d = height * std::cosh(v);
        return std::exp(-foot - height * std::sinh(v)) * d * collided_fluence(d);
    };
    return once + albedo_ * integrate(integrand, std::asinh(-foot / height),
                                      std::asinh((end - foot) / height), 12);
}

}  // namespace airlight
