// SPDX-License-Identifier: Apache-2.0
#include "medium/ray_integral.h"

#include <cmath>

#include "medium/quadrature.h"

namespace airlight {
namespace detail {
namespace {

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
        t0 = t1;
        t1 = t2;
        u0 = u1;
        u1 = u2;
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

// The nearest singularities lie on |x| = 1, half a turn to a quarter turn from the positive axis,
// so on [0, 1] twelve nodes leave 1e-16 (Bernstein ellipse of radius 4.6) and six do on [0, 0.15].
double short_mean(double y, double cos_theta, double x_end) {
    const QuadratureRule rule = gauss_legendre(x_end * (1 + 1.5 * y) < 0.15 ? 6 : 12);
    const double half = 0.5 * x_end;
    const double two_c = 2 * cos_theta;
    const double middle = std::exp(-y * half);
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        const double offset = half * rule.nodes[i].x;
        const double factor = std::exp(-y * offset);
        const double far = half + offset, near = half - offset;
        sum += rule.nodes[i].w *
               (factor / (1 + far * (far + two_c)) + 1 / (factor * (1 + near * (near + two_c))));
    }
    return 0.5 * middle * sum;
}

// The rays from x_end on are infinite rays of the triangle seen from there.
double tail(double y, const RayAngle& a, double x_end) {
    const double transmittance = std::exp(-y * x_end);
    if (transmittance < 1e-18) return 0;
    const double along = x_end + a.cos_theta;
    const double distance = std::hypot(along, a.sin_theta);
    const RayAngle from_end = {std::atan2(a.sin_theta, along), along / distance,
                               a.sin_theta / distance};
    return transmittance / distance * infinite_ray_integral(y * distance, from_end);
}

// Past this x the tail is under 1e-18 of the whole for any y.
constexpr double kInfiniteX = 1e19;

}  // namespace

RayAngle ray_angle(double gamma) {
    return {0.5 * ((kPi - gamma) + kPiLow), std::sin(0.5 * gamma), std::cos(0.5 * gamma)};
}

double infinite_ray_integral(double y, const RayAngle& angle) {
    // The series cancels most where the rule converges best, at theta = 0.
    if (y < 2 - 0.5 * angle.cos_theta) return series(y, angle);
    return laguerre(y < 8 ? gauss_laguerre_80() : gauss_laguerre_24(), y, angle.cos_theta);
}

double mean_ray_integral(double y, const RayAngle& angle, double x_end) {
    // The bound is near the median of the integrand, so that a tail never takes most of the whole.
    if (x_end == 0 || x_end * (1 + 1.5 * y) <= 1) return short_mean(y, angle.cos_theta, x_end);
    return finite_ray_integral(y, angle, x_end) / x_end;
}

double finite_ray_integral(double y, const RayAngle& angle, double x_end) {
    if (x_end == 0) return 0;
    if (x_end * (1 + 1.5 * y) <= 1) return x_end * short_mean(y, angle.cos_theta, x_end);
    const double whole = infinite_ray_integral(y, angle);
    return x_end < kInfiniteX ? whole - tail(y, angle, x_end) : whole;
}

}  // namespace detail
}  // namespace airlight
