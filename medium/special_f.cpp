// SPDX-License-Identifier: Apache-2.0
#include "medium/special_f.h"

#include <cmath>
#include <limits>

#include "medium/ray_integral.h"

namespace airlight {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;
constexpr double kHalfPiLow = 6.123233995736766e-17;  // pi/2 - kHalfPi
constexpr double kHalfPiOfFloat = 1.5707963705062866;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool in_domain(double u, double v) {
    return u >= 0 && v >= 0 && v <= kHalfPiOfFloat;
}

}  // namespace

// With tan(x) = tan(v_lo) + x' / cos(v_lo) the integral is H of the ray integrals at
// theta = pi/2 - v_lo.
double special_f_difference(double u, double v_lo, double v_hi) {
    if (!in_domain(u, v_lo) || !in_domain(u, v_hi)) return kNan;
    if (v_hi < v_lo) return -special_f_difference(u, v_hi, v_lo);
    const double lo = std::fmin(v_lo, kHalfPi), hi = std::fmin(v_hi, kHalfPi);
    if (u == 0 || lo == hi) return hi - lo;
    const double cosine = std::cos(lo);
    const detail::RayAngle angle = {(kHalfPi - lo) + kHalfPiLow, std::sin(lo), cosine};
    const double transmittance = lo > 0 ? std::exp(-u * std::tan(lo)) : 1;
    if (transmittance == 0) return 0;
    const double x_end = std::sin(hi - lo) / std::cos(hi);
    const double value =
        transmittance * cosine * detail::finite_ray_integral(u / cosine, angle, x_end);
    return std::fmin(value, hi - lo);
}

double special_f(double u, double v) {
    return special_f_difference(u, 0.0, v);
}

float special_f_difference(float u, float v_lo, float v_hi) {
    return static_cast<float>(special_f_difference(double{u}, double{v_lo}, double{v_hi}));
}

float special_f(float u, float v) {
    return special_f_difference(u, 0.0f, v);
}

}  // namespace airlight
