// SPDX-License-Identifier: Apache-2.0
#include "medium/ray_integral.h"

#include <cmath>

#include "medium/quadrature.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPiLow = 1.2246467991473532e-16;  // pi - kPi
constexpr double kEulerGamma = 0.57721566490153286061;

// E1(z) = -gamma_E - ln z - sum (-z)^n / (n n!). The imaginary part is divided by sin(theta) term
// by term, sin(n theta) / sin(theta) = U_{n-1}(cos theta), so that theta -> 0 loses nothing.
double series(double y, const RayAngle& a) {
    const double two_c = 2 * a.cos_theta;
    double t0 = 1, t1 = a.cos_theta;
    double u0 = 0, u1 = 1;
    double power = 1;
    double re = 0, im = 0;
    for (int n = 1; n <= 40; ++n) {
        power *= -y / n;
        const double term = power / n;
        re += term * t1;
        im += term * u1;
        if (std::abs(term) < 1e-19) break;
        const double t2 = two_c * t1 - t0;
        const double u2 = two_c * u1 - u0;
        t0 = t1, t1 = t2;
        u0 = u1, u1 = u2;
    }
    const double ratio = a.sin_theta > 0 ? a.theta / a.sin_theta : 1;
    if (y == 0) return ratio;
    const double phase = y * a.sin_theta;
    const double sine = a.sin_theta > 0 ? std::sin(phase) / a.sin_theta : y;
    return std::exp(y * a.cos_theta) *
           (std::cos(phase) * (ratio + im) + sine * (kEulerGamma + std::log(y) + re));
}

double laguerre(const QuadratureRule& rule, double y, double cos_theta) {
    const double two_c = 2 * cos_theta;
    const double scale = 1 / y;
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        const double x = rule.nodes[i].x * scale;
        sum += rule.nodes[i].w / (1 + x * (x + two_c));
    }
    return sum * scale;
}

}  // namespace

RayAngle ray_angle(double gamma) {
    return {0.5 * ((kPi - gamma) + kPiLow), std::sin(0.5 * gamma), std::cos(0.5 * gamma)};
}

double infinite_ray_integral(double y, const RayAngle& angle) {
    if (y < 2) return series(y, angle);
    return laguerre(y < 8 ? gauss_laguerre_80() : gauss_laguerre_24(), y, angle.cos_theta);
}

}  // namespace detail
}  // namespace airlight
